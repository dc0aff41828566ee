#include "virtual_work_dynamics/deviations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "deviation_sources.h"
#include "four_bar.h"
#include "random_motions.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using deviation_sources::everything;
using deviation_sources::expectSpread;
using deviation_sources::kDraws;

// Differences over shifts of 1e-6 to 1e-3: half of the largest shift times the ratio of second to
// first derivative, which the tests keep below 4.
constexpr double kDifferences = 2e-3;
// With shifts of 1e-6.
constexpr double kSmallDifferences = 1e-5;

// A point mass on a massless rod about the axis y, which hangs down at q = 0.
struct Pendulum {
  static constexpr double m = 1.7, l = 0.6, g = 9.81, damping = 0.4;
  Mechanism mechanism = make();
  Scene scene;
  Motion motion{1};

  Pendulum() {
    JointTerms terms;
    terms.joint = "joint_1";
    terms.damping = damping;
    scene.joints = {terms};
    motion.q << 0.7;
    motion.qd << -1.3;
    motion.qdd << 2.9;
  }
  static Mechanism make() {
    RobotBuilder builder(1);
    const int rod = builder.add(JointType::kRevolute, 0, Vector3l::UnitY(), Matrix3l::Identity(),
                                Vector3l::Zero());
    builder.removeInertia(0);
    builder.removeInertia(rod);
    builder.link(rod).mass = m;
    builder.link(rod).p_KoCm_K = {0, 0, -l};
    return builder.build();
  }
  // Of the effort m l^2 qdd + damping qd + m g l sin q.
  Eigen::RowVector3d slope() const {
    return {m * g * l * std::cos(motion.q[0]), damping, m * l * l};
  }
  double deviation(const Eigen::Matrix3d& C) const {
    return std::sqrt((slope() * C * slope().transpose())(0));
  }
  double computed(const Eigen::Matrix3d& C) const {
    const Deviations deviations(mechanism, scene, Request());
    Deviations::Workspace workspace = deviations.makeWorkspace();
    deviations.computeMotion(motion, {{C}}, workspace);
    return workspace.motion().effort[0];
  }
};

Eigen::Matrix3d correlated() {
  return randomCovariance(3, 1, 1e-6).coordinates.front();
}

TEST(Deviations, PendulumMatchesClosedForm) {
  const Pendulum pendulum;
  const Eigen::Matrix3d C = correlated();
  const double expected = pendulum.deviation(C);
  EXPECT_NEAR(pendulum.computed(C), expected, kSmallDifferences * expected);
  for (int level = 0; level < 3; ++level) {
    Eigen::Matrix3d one = Eigen::Matrix3d::Zero();
    one(level, level) = 1e-10;
    const double alone = std::abs(pendulum.slope()[level]) * 1e-5;
    EXPECT_NEAR(pendulum.computed(one), alone, kSmallDifferences * 10 * alone) << level;
  }
}

TEST(Deviations, NeitherTinyNorLargeCovariancesLoseDigits) {
  const Pendulum pendulum;
  for (const double scale : {1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const Eigen::Matrix3d C = scale * scale * correlated();
    const double expected = pendulum.deviation(C);
    const double tolerance = scale < 1e2 ? kSmallDifferences : kDifferences;
    EXPECT_NEAR(pendulum.computed(C), expected, tolerance * expected) << scale;
  }
}

TEST(Deviations, CovariancesMayBeSemidefiniteOrZero) {
  const Pendulum pendulum;
  EXPECT_EQ(pendulum.computed(Eigen::Matrix3d::Zero()), 0);
  const Eigen::Vector3d along(2e-6, 5e-6, -3e-5);
  const double expected = std::abs(pendulum.slope() * along);
  EXPECT_NEAR(pendulum.computed(along * along.transpose()), expected, 1e-4 * expected);
  // What changes no effort cancels, up to the square root of the differences' error.
  const Eigen::RowVector3d slope = pendulum.slope();
  const Eigen::Vector3d across(1e-6 * slope[2], 0, -1e-6 * slope[0]);
  const double size = std::abs(slope[0] * across[0]);
  EXPECT_LE(pendulum.computed(across * across.transpose()), std::sqrt(kSmallDifferences) * size);
}

TEST(Deviations, WhatIsNotKnownHasNone) {
  const Pendulum pendulum;
  for (const double unknown :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e-6}) {
    for (int level = 0; level < 3; ++level) {
      Eigen::Matrix3d C = correlated();
      C(level, level) = unknown;
      EXPECT_TRUE(std::isnan(pendulum.computed(C))) << unknown << " " << level;
    }
  }
}

// At rest, friction may have any value between its bounds: no shift makes more of it.
TEST(Deviations, DryFrictionCountsAsFarAsTheNoiseReaches) {
  Pendulum pendulum;
  pendulum.scene.joints[0].coulomb = 5;
  pendulum.scene.joints[0].damping = 0;
  pendulum.motion.qd[0] = 0;
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  C(1, 1) = 0.01 * 0.01;
  EXPECT_NEAR(pendulum.computed(C), 5, 1e-9);
  pendulum.motion.qd[0] = 1;
  EXPECT_NEAR(pendulum.computed(C), 0, 1e-9);
}

TEST(Deviations, VelocitiesAndAccelerationsOfStaticScenesDoNotCount) {
  Pendulum pendulum;
  pendulum.scene.static_motion = true;
  const Eigen::Matrix3d C = correlated();
  const double expected = std::abs(pendulum.slope()[0]) * std::sqrt(C(0, 0));
  EXPECT_NEAR(pendulum.computed(C), expected, kSmallDifferences * expected);
}

TEST(Deviations, PartsOfEffortsNameTheirCause) {
  const RobotBuilder builder = chainOf(3);
  const Mechanism mechanism = builder.build();
  const Deviations deviations(mechanism, Scene(), Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const Motion motion = RobotBuilder(builder).motion();
  for (int coordinate = 0; coordinate < 3; ++coordinate) {
    for (int level = 0; level < kMotionLevels; ++level) {
      MotionCovariance covariance{std::vector<Eigen::Matrix3d>(3, Eigen::Matrix3d::Zero())};
      covariance.coordinates[static_cast<std::size_t>(coordinate)](level, level) = 1e-8;
      deviations.computeMotion(motion, covariance, workspace);
      const Eigen::MatrixXd& parts = workspace.effortParts();
      const auto own = parts.col(kMotionLevels * coordinate + level);
      EXPECT_GT(own.minCoeff(), 0);
      EXPECT_NEAR(parts.sum(), own.sum(), 1e-12 * own.sum());
      EXPECT_NEAR(own[1], std::pow(workspace.motion().effort[1], 2), 1e-12 * own[1]);
    }
  }
}

// Every deviation against the spread of results of drawn motions.
void expectDrawn(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                 const MotionCovariance& covariance) {
  const Request request = everything(mechanism, scene);
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace computed = deviations.makeWorkspace();
  deviations.computeMotion(motion, covariance, computed);
  const Dynamics dynamics(mechanism, scene, request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  RandomMotions motions(7, motion, covariance);
  Spread spread;
  for (int i = 0; i < kDraws; ++i) {
    Motion drawn = motions.draw();
    ASSERT_TRUE(dynamics.complete(drawn, workspace));
    dynamics.compute(drawn, workspace);
    spread.add(numbersOf(workspace.results()));
  }
  expectSpread(numbersOf(computed.motion()), spread);
}

TEST(Deviations, OpenChainsMatchDrawnMotions) {
  for (const unsigned seed : {2u, 5u, 11u}) {
    RandomRobot robot(seed, 10);
    const Mechanism mechanism = readUrdf(robot.urdf());
    const Motion motion = robot.motion(mechanism);
    SCOPED_TRACE(seed);
    expectDrawn(mechanism, Scene(), motion, randomCovariance(seed, motion.q.size(), 1e-4));
  }
}

class EachCutDeviations : public ::testing::TestWithParam<char> {};
class EachCutOfPassiveJoints : public ::testing::TestWithParam<char> {};

TEST_P(EachCutOfPassiveJoints, ClosedLoopsMatchDrawnMotions) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut(GetParam());
  const Motion motion = cut.motion(four_bar.turnings(1.1, 3.1, -4.2));
  expectDrawn(cut.mechanism, cut.scene, motion, randomCovariance(9, 3, 1e-4));
}

// The effort as the free bodies have it, a function of the crank's turning.
TEST_P(EachCutDeviations, EffortMatchesTheFreeBodies) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut(GetParam());
  const Deviations deviations(cut.mechanism, cut.scene, everything(cut.mechanism, cut.scene));
  Deviations::Workspace workspace = deviations.makeWorkspace();
  MotionCovariance covariance = randomCovariance(9, 3, 1e-6);
  const double crank[3] = {1.1, 3.1, -4.2};
  // A coordinate's noise in terms of the crank: that of the crank itself where it is a coordinate.
  const auto& independent = deviations.independent();
  ASSERT_EQ(std::count(independent.begin(), independent.end(), true), 1);
  const auto place = static_cast<std::size_t>(
      std::find(independent.begin(), independent.end(), true) - independent.begin());
  EXPECT_TRUE(GetParam() == 'A' || cut.joints[place].pivot == 'A');
  const auto row = static_cast<Eigen::Index>(place);
  const auto motionOf = [&](const double* turn) {
    const Motion motion = cut.motion(four_bar.turnings(turn[0], turn[1], turn[2]));
    return Eigen::Vector3d(motion.q[row], motion.qd[row], motion.qdd[row]);
  };
  const auto torque = [&](const double* turn) {
    return static_cast<double>(
        four_bar.freeBodies(four_bar.turnings(turn[0], turn[1], turn[2])).torque);
  };
  Eigen::Matrix3d coordinate_by_crank;
  Eigen::RowVector3d torque_by_crank;
  for (int level = 0; level < 3; ++level) {
    constexpr double kStep = 1e-5;  // central differences: 1e-10 of truncation and of rounding
    double before[3], after[3];
    std::copy(crank, crank + 3, before);
    std::copy(crank, crank + 3, after);
    before[level] -= kStep;
    after[level] += kStep;
    coordinate_by_crank.col(level) = (motionOf(after) - motionOf(before)) / (2 * kStep);
    torque_by_crank[level] = (torque(after) - torque(before)) / (2 * kStep);
  }
  const Eigen::RowVector3d slope = torque_by_crank * coordinate_by_crank.inverse();
  const double expected = std::sqrt((slope * covariance.coordinates[place] * slope.transpose())(0));
  const Motion motion = cut.motion(four_bar.turnings(crank[0], crank[1], crank[2]));
  deviations.computeMotion(motion, covariance, workspace);
  const Eigen::VectorXd& effort = workspace.motion().effort;
  EXPECT_NEAR(effort.sum(), expected, 10 * kSmallDifferences * expected);
}

TEST_P(EachCutDeviations, CovariancesOfCoordinatesThatFollowAreNotUsed) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut(GetParam());
  const Deviations deviations(cut.mechanism, cut.scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const Motion motion = cut.motion(four_bar.turnings(1.1, 3.1, -4.2));
  MotionCovariance covariance = randomCovariance(9, 3, 1e-5);
  deviations.computeMotion(motion, covariance, workspace);
  const Eigen::VectorXd before = workspace.motion().effort;
  for (std::size_t i = 0; i < 3; ++i) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    if (!deviations.independent()[i]) covariance.coordinates[i].setConstant(unknown);
  }
  deviations.computeMotion(motion, covariance, workspace);
  EXPECT_EQ(workspace.motion().effort, before);
  EXPECT_GT(before.sum(), 0);
}

TEST_P(EachCutDeviations, PositionsThatDoNotCloseHaveNone) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut(GetParam());
  const Deviations deviations(cut.mechanism, cut.scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  Motion motion(3);
  motion.q.setConstant(std::numeric_limits<double>::quiet_NaN());
  deviations.computeMotion(motion, randomCovariance(9, 3, 1e-5), workspace);
  EXPECT_TRUE(workspace.motion().effort.array().isNaN().all());
}

TEST_P(EachCutDeviations, WhatIsNotDeterminedHasNone) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut(GetParam());
  const Request request = everything(cut.mechanism, cut.scene);
  Scene scene = cut.scene;
  scene.tolerances = {0.1, 0.1};
  const Deviations deviations(cut.mechanism, scene, request);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const Motion motion = cut.motion(four_bar.turnings(1.1, 3.1, -4.2));
  deviations.computeMotion(motion, randomCovariance(9, 3, 1e-5), workspace);
  deviations.computeDescription(motion, workspace);
  for (const StandardDeviations* found : {&workspace.motion(), &workspace.description()}) {
    for (const Wrench& wrench : found->child_axes) {
      EXPECT_TRUE(std::isfinite(wrench.force.x()) && std::isfinite(wrench.force.y()));
      EXPECT_TRUE(std::isfinite(wrench.torque.z()));
      EXPECT_TRUE(std::isnan(wrench.force.z()));
      EXPECT_TRUE(std::isnan(wrench.torque.x()) && std::isnan(wrench.torque.y()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FourBar, EachCutOfPassiveJoints, ::testing::Values('B', 'C', 'D'));
INSTANTIATE_TEST_SUITE_P(FourBar, EachCutDeviations, ::testing::Values('A', 'B', 'C', 'D'));

TEST(Deviations, WhatViolatesClosuresIsNotTakenForNoise) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('D');
  const Deviations deviations(cut.mechanism, cut.scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const MotionCovariance covariance = randomCovariance(9, 3, 1e-7);
  Motion motion = cut.motion(four_bar.turnings(1.1, 3.1, -4.2));
  deviations.computeMotion(motion, covariance, workspace);
  const double exact = workspace.motion().effort.sum();
  motion.q[1] += 1e-5;  // a hundred deviations, of a passive joint
  motion.qd[2] += 1e-4;
  deviations.computeMotion(motion, covariance, workspace);
  EXPECT_NEAR(workspace.motion().effort.sum(), exact, 1e-4 * exact);
}

TEST(Deviations, WrongLengthsAndWorkspacesThrow) {
  const Pendulum pendulum;
  const Deviations deviations(pendulum.mechanism, pendulum.scene, Request());
  const Deviations other(pendulum.mechanism, pendulum.scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  Deviations::Workspace others = other.makeWorkspace();
  const MotionCovariance covariance{{correlated()}};
  EXPECT_THROW(deviations.computeMotion(Motion(2), covariance, workspace), MotionError);
  EXPECT_THROW(deviations.computeMotion(pendulum.motion, {}, workspace), MotionError);
  EXPECT_THROW(deviations.computeMotion(pendulum.motion, covariance, others), MotionError);
  EXPECT_THROW(deviations.computeDescription(Motion(2), workspace), MotionError);
  EXPECT_THROW(deviations.computeDescription(pendulum.motion, others), MotionError);
}

}  // namespace
}  // namespace virtual_work_dynamics
