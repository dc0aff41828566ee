// Deviations by what is uncertain besides coordinates: the root's motion, free turns, wrenches.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "compound_cases.h"
#include "dynamics/effort_doubts.h"
#include "dynamics/live_wrenches.h"
#include "dynamics/root_by_link.h"
#include "four_bar.h"
#include "moving_roots.h"
#include "random_motions.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kDraws = 4000;
// Five of the standard deviations that an estimate of a standard deviation from that many draws
// has, 1 / sqrt(2 kDraws).
constexpr double kStatistical = 5 / 89.4;

Request everything(const Mechanism& mechanism, const Scene& scene) {
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  return request;
}

// A covariance with correlations between all numbers, of these standard deviations.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> randomMatrix(std::mt19937& generator,
                                                 const Eigen::Matrix<double, kSize, 1>& sizes) {
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, kSize, kSize> factor;
  for (int i = 0; i < factor.size(); ++i) factor.data()[i] = normal(generator);
  Eigen::Matrix<double, kSize, kSize> C = factor * factor.transpose();
  const Eigen::Matrix<double, kSize, 1> scale =
      sizes.cwiseQuotient(C.diagonal().cwiseSqrt()).eval();
  return scale.asDiagonal() * C * scale.asDiagonal();
}

template <int kSize>
Eigen::Matrix<double, kSize, 1> draw(std::mt19937& generator,
                                     const Eigen::Matrix<double, kSize, kSize>& C) {
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, kSize, 1> numbers;
  for (int i = 0; i < kSize; ++i) numbers[i] = normal(generator);
  return C.llt().matrixL() * numbers;
}

Eigen::Quaterniond turnedBy(const Eigen::Quaterniond& orientation, const Eigen::Vector3d& turn) {
  return orientation * Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()));
}

// All sources together, so that also their places are tested; each may be switched off.
struct Sources {
  explicit Sources(unsigned seed) : generator(seed) {}

  void ofRoot() {
    Eigen::Matrix<double, 12, 1> sizes;
    sizes << Eigen::Vector3d(1e-4, 2e-4, 3e-4), Eigen::Vector3d(1e-3, 2e-3, 1e-3),
        Eigen::Vector3d(2e-2, 1e-2, 3e-2), Eigen::Vector3d(1e-2, 3e-2, 2e-2);
    covariance.root = randomMatrix(generator, sizes);
    root = true;
  }
  void ofTurns(std::size_t count) {
    Eigen::Matrix<double, 9, 1> sizes;
    sizes << Eigen::Vector3d(2e-4, 1e-4, 2e-4), Eigen::Vector3d(2e-3, 1e-3, 3e-3),
        Eigen::Vector3d(2e-2, 3e-2, 1e-2);
    for (std::size_t i = 0; i < count; ++i)
      covariance.turns.push_back(randomMatrix(generator, sizes));
  }
  void ofWrenches(std::size_t count) {
    Eigen::Matrix<double, 6, 1> sizes;
    sizes << 0.3, 0.2, 0.4, 0.05, 0.1, 0.02;
    for (std::size_t i = 0; i < count; ++i)
      covariance.wrenches.push_back(randomMatrix(generator, sizes));
  }
  void ofCoordinates(Eigen::Index count, double size) {
    covariance.coordinates = randomCovariance(3, count, 1e-4).coordinates;
    for (Eigen::Matrix3d& C : covariance.coordinates) C *= size * size;
  }

  Motion motion(const Mechanism& mechanism, const Motion& mean) {
    Motion drawn = mean;
    if (drawn.orientations.empty()) drawn.orientations.resize(mechanism.orientations());
    for (std::size_t i = 0; i < covariance.coordinates.size(); ++i) {
      if (covariance.coordinates[i].isZero(0)) continue;
      const Eigen::Vector3d noise = draw<3>(generator, covariance.coordinates[i]);
      const auto place = static_cast<Eigen::Index>(i);
      drawn.q[place] += noise[0];
      drawn.qd[place] += noise[1];
      drawn.qdd[place] += noise[2];
    }
    for (std::size_t i = 0; i < covariance.turns.size(); ++i) {
      const Eigen::Matrix<double, 9, 1> noise = draw<9>(generator, covariance.turns[i]);
      FreeTurn turn = freeTurnOf(mechanism, i, mean);
      turn.orientation = turnedBy(turn.orientation, noise.head<3>());
      turn.angular_velocity += noise.segment<3>(3);
      turn.angular_acceleration += noise.tail<3>();
      setFreeTurn(mechanism, i, turn, drawn);
    }
    if (!root || covariance.root_link != 0) return drawn;
    const Eigen::Matrix<double, 12, 1> noise = draw<12>(generator, covariance.root);
    drawn.root.orientation = turnedBy(drawn.root.orientation, noise.head<3>());
    drawn.root.angular_velocity += noise.segment<3>(3);
    drawn.root.angular_acceleration += noise.segment<3>(6);
    drawn.root.acceleration += noise.tail<3>();
    return drawn;
  }
  // Where a sensor on another link tells how the root moves: the root's motion for the drawn
  // motions of this link and of all joints.
  void placeRoot(const Mechanism& mechanism, const Motion& mean, Motion& drawn) {
    if (covariance.root_link == 0) return;
    RootByLink by_link(mechanism);
    by_link.place(mean, covariance.root_link);
    RootMotion link = by_link.linkOf(mean.root);
    const Eigen::Matrix<double, 12, 1> noise = draw<12>(generator, covariance.root);
    link.orientation = turnedBy(link.orientation, noise.head<3>());
    link.angular_velocity += noise.segment<3>(3);
    link.angular_acceleration += noise.segment<3>(6);
    link.acceleration += noise.tail<3>();
    by_link.place(drawn, covariance.root_link);
    drawn.root = by_link.rootOf(link);
  }
  Load load(const Scene& scene) {
    Load drawn(scene);
    for (std::size_t i = 0; i < covariance.wrenches.size(); ++i) {
      if (!scene.applied_wrenches[i].deviation) continue;
      const Eigen::Matrix<double, 6, 1> noise = draw<6>(generator, covariance.wrenches[i]);
      drawn.wrenches[i].force += noise.head<3>();
      drawn.wrenches[i].torque += noise.tail<3>();
    }
    return drawn;
  }

  std::mt19937 generator;
  MotionCovariance covariance;
  bool root = false;
};

// Every deviation against the spread of results of drawn motions and loads.
void expectDrawn(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                 Sources& sources) {
  const Request request = everything(mechanism, scene);
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace computed = deviations.makeWorkspace();
  deviations.computeMotion(motion, sources.covariance, computed);
  const Dynamics dynamics(mechanism, scene, request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Spread spread;
  for (int i = 0; i < kDraws; ++i) {
    Motion drawn = sources.motion(mechanism, motion);
    ASSERT_TRUE(dynamics.complete(drawn, workspace));
    sources.placeRoot(mechanism, motion, drawn);
    dynamics.compute(drawn, sources.load(scene), workspace);
    spread.add(numbersOf(workspace.results()));
  }
  const std::vector<double> found = numbersOf(computed.motion());
  double largest = 0;
  for (const double value : found) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  ASSERT_GT(largest, 0);
  std::size_t known = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::isnan(found[i])) continue;
    ++known;
    EXPECT_NEAR(found[i], spread.deviation(i), kStatistical * found[i] + 1e-6 * largest) << i;
  }
  EXPECT_GE(known, found.size() / 4);
}

Scene sceneWithWrenches(std::vector<std::string> links) {
  Scene scene;
  for (const std::string& link : links) {
    AppliedWrench wrench;
    wrench.link = link;
    wrench.at << 0.1, -0.2, 0.3;
    wrench.force << 3, -2, 5;
    scene.applied_wrenches.push_back(wrench);
  }
  return scene;
}

TEST(DeviationsOfRoots, OpenChainsMatchDrawnMotions) {
  for (const unsigned seed : {2u, 5u}) {
    SCOPED_TRACE(seed);
    RandomRobot robot(seed, 8);
    const Mechanism mechanism = readUrdf(robot.urdf());
    Motion motion = robot.motion(mechanism);
    Sources sources(seed);
    motion.root = randomRootMotion(sources.generator);
    Scene scene;
    scene.root_moves = true;
    scene.reactions = ReactionSelection::kNamed;
    scene.reaction_names = {kGround, "joint_1"};
    sources.ofRoot();
    sources.ofCoordinates(motion.q.size(), seed == 2 ? 0 : 1);
    expectDrawn(mechanism, scene, motion, sources);
  }
}

TEST(DeviationsOfRoots, ClosedLoopsMatchDrawnMotions) {
  const FourBar four_bar;
  FourBar::Cut cut = four_bar.cut('C');
  Motion motion = cut.motion(four_bar.turnings(1.1, 3.1, -4.2));
  Sources sources(4);
  motion.root = randomRootMotion(sources.generator);
  cut.scene.root_moves = true;
  sources.ofRoot();
  sources.ofCoordinates(motion.q.size(), 0.1);
  expectDrawn(cut.mechanism, cut.scene, motion, sources);
}

// A sensor on a link that joints move: their doubts are the root's, too.
TEST(DeviationsOfRoots, BySensorsOnOtherLinksMatchDrawnMotions) {
  for (const unsigned seed : {2u, 5u}) {
    SCOPED_TRACE(seed);
    RandomRobot robot(seed, 8);
    const Mechanism mechanism = readUrdf(robot.urdf());
    Motion motion = robot.motion(mechanism);
    Sources sources(seed);
    motion.root = randomRootMotion(sources.generator);
    Scene scene;
    scene.root_moves = true;
    scene.reactions = ReactionSelection::kNamed;
    scene.reaction_names = {kGround, "joint_1"};
    sources.ofRoot();
    sources.covariance.root *= 1e-4;  // so that what the joints do to it counts
    sources.ofCoordinates(motion.q.size(), 1);
    sources.covariance.root_link = static_cast<int>(mechanism.links().size()) - 1;
    expectDrawn(mechanism, scene, motion, sources);
  }
  const FourBar four_bar;
  FourBar::Cut cut = four_bar.cut('C');
  Motion motion = cut.motion(four_bar.turnings(1.1, 3.1, -4.2));
  Sources sources(4);
  motion.root = randomRootMotion(sources.generator);
  cut.scene.root_moves = true;
  sources.ofRoot();
  sources.covariance.root *= 1e-6;
  sources.ofCoordinates(motion.q.size(), 0.1);
  sources.covariance.root_link = 1;
  expectDrawn(cut.mechanism, cut.scene, motion, sources);
}

TEST(DeviationsOfRoots, BySensorsOnOtherLinksCoverFreeTurns) {
  unsigned seed = 1;
  while (CompoundCase(seed).mechanism.orientations() == 0) ++seed;
  CompoundCase tree(seed);
  Scene scene = tree.scene;
  scene.applied_wrenches.clear();
  scene.root_moves = true;
  Sources sources(seed);
  tree.motion.root = randomRootMotion(sources.generator);
  sources.ofRoot();
  sources.ofTurns(tree.mechanism.orientations());
  sources.ofCoordinates(tree.motion.q.size(), 0);
  sources.covariance.root_link = tree.mechanism.freeJoint(0).last + 1;
  expectDrawn(tree.mechanism, scene, tree.motion, sources);
}

TEST(DeviationsOfRoots, LinksThatAreNotThereAreRefused) {
  RandomRobot robot(2, 4);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene;
  scene.root_moves = true;
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const Motion motion(deviations.coordinates());
  MotionCovariance covariance;
  covariance.coordinates.assign(static_cast<std::size_t>(deviations.coordinates()),
                                Eigen::Matrix3d::Zero());
  for (const int link : {-1, static_cast<int>(mechanism.links().size())}) {
    covariance.root_link = link;
    EXPECT_THROW(deviations.computeMotion(motion, covariance, workspace), MotionError) << link;
  }
}

// A massless base that carries a point mass m at r: its weight, and what it takes to accelerate it.
TEST(DeviationsOfRoots, PointMassMatchesClosedForm) {
  const double m = 1.7;
  const Mechanism mechanism = readUrdf(
      "<robot name='r'><link name='base'><inertial><origin xyz='0 0 0'/><mass value='1.7'/>"
      "<inertia ixx='0' iyy='0' izz='0' ixy='0' ixz='0' iyz='0'/></inertial></link>"
      "<link name='flag'/><joint name='j' type='continuous'><parent link='base'/>"
      "<child link='flag'/></joint></robot>");
  Scene scene;
  scene.root_moves = true;
  Request request;
  request.root_axes = {kGround};
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  MotionCovariance covariance{{Eigen::Matrix3d::Zero()}};
  covariance.root.diagonal() << 1e-8, 4e-8, 9e-8, 1, 1, 1, 1, 1, 1, 4e-4, 1e-4, 9e-4;
  deviations.computeMotion(Motion(1), covariance, workspace);
  const Eigen::Vector3d found = workspace.motion().root_axes[0].force;
  // At rest the force is m g upwards; a turn about x leans it along y, one about y along x.
  const double weight = 9.81;
  EXPECT_NEAR(found.x(), m * std::hypot(2e-2, weight * 2e-4), 1e-6);
  EXPECT_NEAR(found.y(), m * std::hypot(1e-2, weight * 1e-4), 1e-6);
  EXPECT_NEAR(found.z(), m * 3e-2, 1e-6);
}

TEST(DeviationsOfTurns, TreesOfManyFreedomsMatchDrawnMotions) {
  int turning = 0;
  for (unsigned seed = 1; turning < 3 && seed < 60; ++seed) {
    CompoundCase tree(seed);
    if (tree.mechanism.orientations() == 0) continue;
    SCOPED_TRACE(seed);
    ++turning;
    Scene scene = tree.scene;
    scene.applied_wrenches.clear();
    Sources sources(seed);
    sources.ofTurns(tree.mechanism.orientations());
    sources.ofCoordinates(tree.motion.q.size(), 0);
    expectDrawn(tree.mechanism, scene, tree.motion, sources);
  }
  EXPECT_EQ(turning, 3);
}

// Angles behind the orientations turn on: the covariances are those of the whole turn.
TEST(DeviationsOfTurns, AnglesDoNotMatter) {
  unsigned seed = 1;
  while (CompoundCase(seed).mechanism.orientations() == 0) ++seed;
  CompoundCase tree(seed);
  Sources sources(seed);
  sources.ofTurns(tree.mechanism.orientations());
  sources.ofCoordinates(tree.motion.q.size(), 0);
  Request request;
  request.child_axes = requestedReactions(tree.mechanism, tree.scene);
  request.efforts = false;
  const Deviations deviations(tree.mechanism, tree.scene, request);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  deviations.computeMotion(tree.motion, sources.covariance, workspace);
  const std::vector<double> expected = numbersOf(workspace.motion());
  ASSERT_GT(*std::max_element(expected.begin(), expected.end()), 1e-3);
  Motion turned = tree.motion;
  const int first = tree.mechanism.anglesOf(0);
  // The same attitude by an angle about x, at which angles' rates are those of the turn.
  FreeTurn turn = freeTurnOf(tree.mechanism, 0, tree.motion);
  const Eigen::Quaterniond half(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  turned.orientations[0] = turn.orientation * half.conjugate();
  turned.q[first] = 0.5;
  const FreeTurn found = freeTurnOf(tree.mechanism, 0, turned);
  ASSERT_LT((found.angular_velocity - turn.angular_velocity).norm(), 1e-12);
  deviations.computeMotion(turned, sources.covariance, workspace);
  const std::vector<double> other = numbersOf(workspace.motion());
  for (std::size_t i = 0; i < other.size(); ++i)
    EXPECT_NEAR(other[i], expected[i], 1e-6 * (1 + expected[i])) << i;
}

TEST(DeviationsOfWrenches, OpenAndClosedMatchDrawnLoads) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('B');
  RandomRobot robot(5, 8);
  const Mechanism tree = readUrdf(robot.urdf());
  for (const bool closed : {false, true}) {
    SCOPED_TRACE(closed);
    const Mechanism& mechanism = closed ? cut.mechanism : tree;
    Scene scene = closed ? cut.scene : Scene();
    const std::size_t last = mechanism.links().size() - 1;
    scene.applied_wrenches =
        sceneWithWrenches({mechanism.link(static_cast<int>(last)).name, mechanism.link(1).name,
                           mechanism.link(static_cast<int>(last) - 1).name})
            .applied_wrenches;
    scene.applied_wrenches[0].deviation = WrenchDeviation{1, 1};
    scene.applied_wrenches[1].axes = Axes::kRoot;
    scene.applied_wrenches[2].axes = Axes::kRoot;
    scene.applied_wrenches[2].deviation = WrenchDeviation{1, 1};
    const Motion motion =
        closed ? cut.motion(four_bar.turnings(1.1, 3.1, -4.2)) : robot.motion(tree);
    Sources sources(8);
    sources.ofWrenches(3);
    sources.ofCoordinates(motion.q.size(), 0.01);
    expectDrawn(mechanism, scene, motion, sources);
  }
}

TEST(DeviationsOfWrenches, TheScenesCountUnlessOthersAreGiven) {
  RandomRobot robot(5, 8);
  const Mechanism mechanism = readUrdf(robot.urdf());
  const Motion motion = robot.motion(mechanism);
  Scene scene = sceneWithWrenches({mechanism.link(7).name});
  scene.applied_wrenches[0].deviation = WrenchDeviation{2, 0.3};
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  MotionCovariance covariance;
  covariance.coordinates.assign(mechanism.coordinates().size(), Eigen::Matrix3d::Zero());
  deviations.computeMotion(motion, covariance, workspace);
  const Eigen::VectorXd own = workspace.motion().effort;
  EXPECT_GT(own.maxCoeff(), 0);
  covariance.wrenches = wrenchCovariances(scene);
  deviations.computeMotion(motion, covariance, workspace);
  EXPECT_EQ(workspace.motion().effort, own);
  covariance.wrenches[0] *= 4;
  deviations.computeMotion(motion, covariance, workspace);
  EXPECT_LT((workspace.motion().effort - 2 * own).norm(), 1e-9 * own.norm());
  covariance.wrenches.resize(2, WrenchCovariance::Zero());
  EXPECT_THROW(deviations.computeMotion(motion, covariance, workspace), MotionError);
  covariance.wrenches.clear();
  covariance.turns.resize(1, TurnCovariance::Zero());
  EXPECT_THROW(deviations.computeMotion(motion, covariance, workspace), MotionError);
  scene.applied_wrenches[0].deviation = WrenchDeviation{-1, 0};
  EXPECT_THROW(Deviations(mechanism, scene, Request()), SceneError);
}

// Of a sensor whose frame is another link's, between two measurements and behind the last one.
TEST(DeviationsOfWrenches, LiveOnesAreThoseOfDrawnMeasurements) {
  const Mechanism mechanism = readUrdf(
      "<robot name='r'><link name='base'/><link name='arm'/><link name='sensor'/>"
      "<joint name='a' type='continuous'><parent link='base'/><child link='arm'/><axis xyz='1 0 "
      "0'/>"
      "</joint><joint name='b' type='continuous'><parent link='arm'/><child link='sensor'/>"
      "<origin xyz='0.3 -0.5 0.2' rpy='0.3 0.4 0.5'/><axis xyz='0 1 0'/></joint></robot>");
  Scene scene;
  AppliedWrench live;
  live.link = "arm";
  live.name = "push";
  live.live = true;
  live.invert = true;
  live.deviation = WrenchDeviation{0.4, 0.03};
  scene.applied_wrenches = {AppliedWrench(), live};
  scene.applied_wrenches[0].link = "base";
  Motion motion(2);
  motion.q << 0.4, -0.9;
  std::mt19937 generator(6);
  std::normal_distribution<double> normal;
  for (const std::int64_t at : {1003000000LL, 1010000000LL, 1020000000LL}) {
    std::vector<WrenchCovariance> covariances(2, WrenchCovariance::Constant(7));
    WrenchCovariance sum = WrenchCovariance::Zero();
    for (int i = 0; i < kDraws; ++i) {
      LiveWrenches wrenches(mechanism, scene, 0.1);
      for (const std::int64_t stamp : {1000000000LL, 1010000000LL}) {
        MeasuredWrench measured{stamp, 2, {}};
        for (int c = 0; c < 3; ++c) {
          measured.value.force[c] = 0.4 * normal(generator);
          measured.value.torque[c] = 0.03 * normal(generator);
        }
        wrenches.push(0, measured);
      }
      ASSERT_FALSE(wrenches.read(at));
      Load load(scene);
      wrenches.getLoad(motion, load);
      wrenches.getCovariances(covariances);
      Eigen::Matrix<double, 6, 1> value;
      value << load.wrenches[1].force, load.wrenches[1].torque;
      sum += value * value.transpose() / kDraws;
    }
    EXPECT_EQ(covariances[0], WrenchCovariance::Constant(7));
    const WrenchCovariance& found = covariances[1];
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const double scale = std::sqrt(found(i, i) * found(j, j));
        EXPECT_NEAR(sum(i, j), found(i, j), 6 / std::sqrt(double(kDraws)) * scale) << i << j;
      }
    }
  }
}

TEST(DeviationsOfSources, DoubtsNameTheCause) {
  RandomRobot robot(5, 8);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene = sceneWithWrenches({mechanism.link(7).name, mechanism.link(6).name});
  scene.root_moves = true;
  scene.applied_wrenches[0].deviation = WrenchDeviation{1e-3, 1e-3};
  scene.applied_wrenches[1].deviation = WrenchDeviation{1e-3, 1e-3};
  scene.applied_wrenches[1].name = "push";
  Motion motion = robot.motion(mechanism);
  std::mt19937 generator(3);
  motion.root = randomRootMotion(generator);
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const std::vector<std::string> causes = otherCauses(scene);
  const std::vector<std::string> expected = {
      "the noise of the root's orientation",
      "the noise of the root's angular velocity",
      "the noise of the root's angular acceleration",
      "the noise of the root's acceleration",
      "the noise of the applied wrench on '" + mechanism.link(7).name + "'",
      "the noise of the wrench 'push'"};
  ASSERT_EQ(causes, expected);
  for (std::size_t cause = 0; cause < causes.size(); ++cause) {
    MotionCovariance covariance;
    covariance.coordinates.assign(mechanism.coordinates().size(), Eigen::Matrix3d::Zero());
    covariance.wrenches.assign(2, WrenchCovariance::Zero());
    if (cause < 4) {
      covariance.root.diagonal().segment<3>(3 * static_cast<Eigen::Index>(cause)).setConstant(1e-6);
    } else {
      covariance.wrenches[cause - 4].setIdentity();
    }
    deviations.computeMotion(motion, covariance, workspace);
    EffortDoubts doubts(deviations.effortNames(), deviations.residuals(),
                        mechanism.coordinateNames(), causes);
    doubts.add(Eigen::VectorXd::Ones(deviations.coordinates()), workspace, true, false);
    const std::vector<EffortDoubt> found = doubts.above(1e-9);
    ASSERT_FALSE(found.empty()) << cause;
    for (const EffortDoubt& doubt : found) EXPECT_EQ(doubt.cause, causes[cause]);
  }
  AppliedWrench bare;
  bare.name = "bare";
  bare.live = true;
  scene.applied_wrenches.push_back(bare);
  EXPECT_EQ(exactWrenches(scene), std::vector<std::string>{"bare"});
}

}  // namespace
}  // namespace virtual_work_dynamics
