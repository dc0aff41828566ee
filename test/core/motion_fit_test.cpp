// Measured motions that are moved to where loops and wheels allow them, by as little as can be.
#include "virtual_work_dynamics/motion_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "four_bar.h"
#include "loop_examples.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

const Eigen::VectorXd kNoNoise;
constexpr const char* kLoops[] = {"four_bar",       "slider_crank",          "planar_3rrr",
                                  "stewart_gough",  "spatial_parallelogram", "andrews_squeezer",
                                  "planetary_gear", "coupled_wrist"};

// Deviations of position, velocity and acceleration, different for each coordinate.
MotionCovariance unevenCovariance(Eigen::Index coordinates, const Eigen::Vector3d& deviations) {
  MotionCovariance covariance;
  for (Eigen::Index i = 0; i < coordinates; ++i) {
    const double factor = std::pow(3.0, static_cast<double>((5 * i) % 4) - 2);
    const Eigen::Vector3d own = factor * deviations;
    covariance.coordinates.emplace_back(own.cwiseAbs2().asDiagonal());
  }
  return covariance;
}

Motion withNoise(Motion motion, const MotionCovariance& covariance, std::mt19937& random) {
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < covariance.coordinates.size(); ++i) {
    const Eigen::Vector3d own = covariance.coordinates[i].diagonal().cwiseSqrt();
    const auto k = static_cast<Eigen::Index>(i);
    motion.q[k] += own[0] * normal(random);
    motion.qd[k] += own[1] * normal(random);
    motion.qdd[k] += own[2] * normal(random);
  }
  return motion;
}

double violationBy(const Dynamics& dynamics, const Motion& motion) {
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  double most = 0;
  for (const ClosureResidual& residual : workspace.results().loops.relative_residuals) {
    most = std::max({most, residual.position, residual.velocity, residual.acceleration});
  }
  return most;
}

// An example, away from its assembly, in a motion that closes its loops.
struct Moving : LoopExample {
  explicit Moving(const std::string& name)
      : LoopExample(name), dynamics(mechanism, scene), motion(dynamics.coordinates()) {
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    motion.q = dynamics.assembly();
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      const auto k = static_cast<double>(i);
      motion.q[i] += 0.02 * std::sin(2 + k);
      motion.qd[i] = std::sin(1 + 2 * k);
      motion.qdd[i] = 3 * std::sin(3 + k);
    }
    EXPECT_TRUE(dynamics.complete(motion, workspace)) << name;
  }
  // The ways that the loops leave open, found by completing motions beside this one.
  std::vector<Eigen::VectorXd> waysAt(const Eigen::VectorXd& q) const {
    std::vector<Eigen::VectorXd> ways;
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    for (std::size_t i = 0; i < dynamics.actuated().size(); ++i) {
      if (!dynamics.actuated()[i]) continue;
      Motion at(q.size());
      at.q = q;
      at.qd[static_cast<Eigen::Index>(i)] = 1;
      EXPECT_TRUE(dynamics.complete(at, workspace));
      ways.push_back(at.qd);
    }
    return ways;
  }

  Dynamics dynamics;
  Motion motion;
};

// The sum of moves, each over its variance, along a way, against the sums of magnitudes.
double slopeAlong(const Eigen::VectorXd& way, const Eigen::VectorXd& moves,
                  const MotionCovariance& covariance, int level) {
  double sum = 0, magnitudes = 0;
  for (std::size_t i = 0; i < covariance.coordinates.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double term = way[k] * moves[k] / covariance.coordinates[i](level, level);
    sum += term;
    magnitudes += std::abs(term);
  }
  return magnitudes == 0 ? 0 : std::abs(sum) / magnitudes;
}

TEST(MotionFit, NoisyLoopsCloseByTheLeastMoves) {
  for (const char* name : kLoops) {
    SCOPED_TRACE(name);
    const Moving example(name);
    MotionFit fit(example.mechanism, example.dynamics);
    ASSERT_TRUE(fit.any());
    const Eigen::Index n = example.motion.q.size();
    const MotionCovariance covariance = unevenCovariance(n, {1e-4, 1e-2, 0.3});
    std::mt19937 random(7);
    for (int draw = 0; draw < 20; ++draw) {
      const Motion measured = withNoise(example.motion, covariance, random);
      Motion fitted = measured;
      ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained)
          << fit.outcome().farthest.deviations;
      EXPECT_GT(violationBy(example.dynamics, measured), 1e-6);
      EXPECT_LT(violationBy(example.dynamics, fitted), 1e-12);
      // Where the least move ends, none of the ways that are open leads closer.
      for (const Eigen::VectorXd& way : example.waysAt(fitted.q)) {
        EXPECT_LT(slopeAlong(way, fitted.q - measured.q, covariance, 0), 1e-5);
        EXPECT_LT(slopeAlong(way, fitted.qd - measured.qd, covariance, 1), 1e-9);
        EXPECT_LT(slopeAlong(way, fitted.qdd - measured.qdd, covariance, 2), 1e-9);
      }
    }
  }
}

TEST(MotionFit, MotionsThatCloseTheLoopsStay) {
  for (const char* name : kLoops) {
    const Moving example(name);
    MotionFit fit(example.mechanism, example.dynamics);
    Motion motion = example.motion;
    const MotionCovariance covariance = unevenCovariance(motion.q.size(), {1e-4, 1e-2, 0.3});
    ASSERT_TRUE(fit.fit(motion, &covariance, kNoNoise).explained) << name;
    EXPECT_LT((motion.q - example.motion.q).norm(), 1e-12) << name;
    EXPECT_LT((motion.qd - example.motion.qd).norm(), 1e-10) << name;
    EXPECT_LT((motion.qdd - example.motion.qdd).norm(), 1e-9) << name;
    EXPECT_LT(fit.outcome().farthest.deviations, 1e-6) << name;
  }
}

// The sum of squares that the fit takes away is as large as noise makes it: one for each condition
// that counts.
TEST(MotionFit, MovesAreAsLargeAsTheNoiseMakesThem) {
  const Moving example("planar_3rrr");
  MotionFit fit(example.mechanism, example.dynamics);
  const Eigen::Index n = example.motion.q.size();
  const MotionCovariance covariance = unevenCovariance(n, {1e-5, 1e-3, 0.03});
  std::mt19937 random(3);
  double squares[3] = {0, 0, 0}, rms = 0;
  constexpr int kDraws = 400;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Motion measured = withNoise(example.motion, covariance, random);
    Motion fitted = measured;
    ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained);
    rms += std::pow(fit.outcome().velocity_rms, 2);
    const Eigen::VectorXd moves[3] = {fitted.q - measured.q, fitted.qd - measured.qd,
                                      fitted.qdd - measured.qdd};
    for (int level = 0; level < 3; ++level) {
      for (Eigen::Index i = 0; i < n; ++i) {
        const double variance = covariance.coordinates[static_cast<std::size_t>(i)](level, level);
        squares[level] += moves[level][i] * moves[level][i] / variance;
      }
    }
  }
  const double conditions = static_cast<double>(n) - 3;  // three motors move it
  // Four standard deviations of the mean. Velocities contain those of positions, too, times how
  // the conditions turn, which is little at these deviations.
  const double most = 4 * std::sqrt(2 * conditions / kDraws);
  for (const double sum : squares) EXPECT_NEAR(sum / kDraws, conditions, most);
  EXPECT_NEAR(rms / kDraws, squares[1] / kDraws / conditions, 1e-9);
}

TEST(MotionFit, WheelsTellHowTheBaseMoves) {
  const LoopExample example("mobile_manipulator");
  const Dynamics dynamics(example.mechanism, example.scene);
  MotionFit fit(example.mechanism, dynamics);
  ASSERT_TRUE(fit.any());
  const auto place = [&](const char* name) { return example.mechanism.coordinateIndex(name); };
  // Half the track and the radius are those of the description.
  const double angle = 0.6, v = 0.7, w = -0.9, a = 0.4, turn = 1.3, r = 0.08, half = 0.2;
  Motion truth(dynamics.coordinates());
  truth.q[place("base_yaw")] = angle;
  truth.q[place("shoulder")] = 0.3;
  truth.qd[place("base_x")] = v * std::cos(angle);
  truth.qd[place("base_y")] = v * std::sin(angle);
  truth.qd[place("base_yaw")] = w;
  truth.qd[place("left_wheel")] = (v - half * w) / r;
  truth.qd[place("right_wheel")] = (v + half * w) / r;
  truth.qdd[place("base_x")] = a * std::cos(angle) - v * w * std::sin(angle);
  truth.qdd[place("base_y")] = a * std::sin(angle) + v * w * std::cos(angle);
  truth.qdd[place("base_yaw")] = turn;
  truth.qdd[place("left_wheel")] = (a - half * turn) / r;
  truth.qdd[place("right_wheel")] = (a + half * turn) / r;
  truth.qdd[place("shoulder")] = 2;
  ASSERT_LT(violationBy(dynamics, truth), 1e-14);

  MotionCovariance covariance;
  covariance.coordinates.assign(8, Eigen::Vector3d(1e-8, 1e-6, 1e-4).asDiagonal());
  for (const char* name : {"base_x", "base_y", "base_yaw"}) {
    covariance.coordinates[static_cast<std::size_t>(place(name))] =
        Eigen::Vector3d(1e-14, 0.01, 1).asDiagonal();
  }
  std::mt19937 random(11);
  double before = 0, after = 0;
  for (int draw = 0; draw < 100; ++draw) {
    const Motion measured = withNoise(truth, covariance, random);
    Motion fitted = measured;
    ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained);
    EXPECT_LT(violationBy(dynamics, fitted), 1e-13);
    // Nothing says where the base is, or how the arm moves, but measurements.
    EXPECT_EQ(fitted.q, measured.q);
    EXPECT_EQ(fitted.qdd[place("shoulder")], measured.qdd[place("shoulder")]);
    before += std::pow(measured.qdd[place("base_yaw")] - truth.qdd[place("base_yaw")], 2);
    after += std::pow(fitted.qdd[place("base_yaw")] - truth.qdd[place("base_yaw")], 2);
  }
  // Deviations of 1 rad/s^2, and of the difference of two wheels' 0.01 rad/s^2 over the track.
  EXPECT_NEAR(std::sqrt(before / 100), 1, 0.3);
  EXPECT_LT(std::sqrt(after / 100), 1.5 * 0.01 * std::sqrt(2.0) * r / (2 * half));
}

TEST(MotionFit, SlipIsTold) {
  const LoopExample example("mobile_manipulator");
  const Dynamics dynamics(example.mechanism, example.scene);
  MotionFit fit(example.mechanism, dynamics);
  const int wheel = example.mechanism.coordinateIndex("left_wheel");
  Motion slipping(dynamics.coordinates());
  slipping.qd[wheel] = 3;
  MotionCovariance covariance;
  covariance.coordinates.assign(8, Eigen::Vector3d(1e-12, 1e-8, 1e-4).asDiagonal());
  covariance.coordinates[static_cast<std::size_t>(wheel)] *= 1e4;
  const MotionFit::Outcome& outcome = fit.fit(slipping, &covariance, kNoNoise);
  EXPECT_LT(violationBy(dynamics, slipping), 1e-12);
  EXPECT_TRUE(outcome.closed);
  EXPECT_TRUE(outcome.wheels);
  EXPECT_FALSE(outcome.explained);
  EXPECT_GT(outcome.velocity_rms, 100);
  EXPECT_GT(outcome.farthest.deviations, MotionFit::kMost);
  EXPECT_EQ(outcome.farthest.level, 1);
  EXPECT_EQ(outcome.farthest.coordinate, wheel);
  EXPECT_NEAR(outcome.farthest.amount, 3, 0.1);
}

TEST(MotionFit, WhatIsToleratedNeedsNoExplanation) {
  const Moving example("four_bar");
  Motion open = example.motion;
  open.q[1] += 2e-3;
  const MotionCovariance covariance = unevenCovariance(open.q.size(), {1e-6, 1e-4, 1e-2});
  for (const double tolerance : {0.0, 0.003}) {
    MotionFit fit(example.mechanism, example.dynamics, tolerance);
    Motion fitted = open;
    const MotionFit::Outcome& outcome = fit.fit(fitted, &covariance, kNoNoise, false);
    EXPECT_TRUE(outcome.closed);
    EXPECT_EQ(outcome.explained, tolerance > 0);
    EXPECT_EQ(outcome.position_rms > 4, tolerance == 0) << outcome.position_rms;
  }
}

// What is so far from closed has another cause, and no fit makes it right. Its rates are fitted.
TEST(MotionFit, PositionsFarFromClosedStay) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  Motion open = example.motion;
  open.q[1] += 0.1;
  Motion fitted = open;
  const MotionCovariance covariance = unevenCovariance(open.q.size(), {1e-4, 1e-2, 0.3});
  const MotionFit::Outcome& outcome = fit.fit(fitted, &covariance, kNoNoise);
  EXPECT_FALSE(outcome.closed);
  EXPECT_EQ(fitted.q, open.q);
  EXPECT_NE(fitted.qd, open.qd);
  Dynamics::Workspace workspace = example.dynamics.makeWorkspace();
  example.dynamics.compute(fitted, workspace);
  for (const ClosureResidual& residual : workspace.results().loops.relative_residuals) {
    EXPECT_GT(residual.position, 1e-2);
    EXPECT_LT(residual.velocity, 1e-12);
    EXPECT_LT(residual.acceleration, 1e-12);
  }
}

// Joints that have not moved have no noise that could be known: their encoders round some of it
// away, and others have to meet them.
TEST(MotionFit, JointsWithoutKnownNoiseAreJudgedMildly) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  MotionCovariance covariance = unevenCovariance(example.motion.q.size(), {1e-5, 1e-3, 0.03});
  covariance.coordinates[0] = Eigen::Vector3d(1e-24, 1e-20, 1e-16).asDiagonal();
  Motion measured = example.motion;
  measured.qd.setZero();
  measured.qdd.setZero();
  measured.q[1] += 4e-4;  // half a step of 4096 in a turn
  Motion fitted = measured;
  EXPECT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained);
  EXPECT_LT(fit.outcome().position_rms, 1);
  EXPECT_LT(violationBy(example.dynamics, fitted), 1e-12);
  // They are not exact, but as little known as the least known beside them.
  EXPECT_NE(fitted.q[0], measured.q[0]);
  EXPECT_LT(std::abs(fitted.q[0] - measured.q[0]), 4e-4);
  // None has moved.
  for (Eigen::Matrix3d& own : covariance.coordinates) own = covariance.coordinates[0];
  fitted = measured;
  EXPECT_TRUE(fit.fit(fitted, &covariance, kNoNoise).closed);
  EXPECT_TRUE(fit.outcome().explained);
  EXPECT_LT(violationBy(example.dynamics, fitted), 1e-12);
}

// Straight ahead the base does not move sideways, and nothing is known of how well that is
// measured. As if it were exact, the noise of the heading would stop the base.
TEST(MotionFit, WhatDoesNotMoveDoesNotDragTheOthers) {
  const LoopExample example("mobile_manipulator");
  const Dynamics dynamics(example.mechanism, example.scene);
  MotionFit fit(example.mechanism, dynamics);
  const auto place = [&](const char* name) { return example.mechanism.coordinateIndex(name); };
  for (const double variance : {1e-24, -1e-9}) {
    Motion motion(dynamics.coordinates());
    motion.q[place("base_yaw")] = 1e-4;
    motion.qd[place("base_x")] = 0.5;
    motion.qd[place("left_wheel")] = motion.qd[place("right_wheel")] = 0.5 / 0.08;
    MotionCovariance covariance;
    covariance.coordinates.assign(8, Eigen::Vector3d(1e-8, 1e-6, 1e-4).asDiagonal());
    covariance.coordinates[static_cast<std::size_t>(place("base_y"))] =
        Eigen::Vector3d(1e-24, variance, 1e-24).asDiagonal();
    EXPECT_TRUE(fit.fit(motion, &covariance, kNoNoise).explained);
    EXPECT_NEAR(motion.qd[place("base_x")], 0.5, 1e-4);
    EXPECT_NEAR(motion.qd[place("left_wheel")], 0.5 / 0.08, 1e-3);
    EXPECT_LT(violationBy(dynamics, motion), 1e-12);
  }
}

// Where an encoder of a closed linkage flickers and the others do not move.
TEST(MotionFit, OneThatMovesAmongThoseThatDoNotCloses) {
  for (const char* name : {"slider_crank", "four_bar", "planar_3rrr"}) {
    const Moving example(name);
    MotionFit fit(example.mechanism, example.dynamics);
    const Eigen::Index n = example.motion.q.size();
    MotionCovariance covariance;
    covariance.coordinates.assign(static_cast<std::size_t>(n), 1e-24 * Eigen::Matrix3d::Identity());
    covariance.coordinates[0] = Eigen::Vector3d(1e-7, 1e-4, 1e-1).asDiagonal();
    Motion fitted = example.motion;
    fitted.q.array() += 3e-4;
    EXPECT_TRUE(fit.fit(fitted, &covariance, kNoNoise).closed) << name;
    EXPECT_TRUE(fit.outcome().explained) << name;
    EXPECT_LT(violationBy(example.dynamics, fitted), 1e-12) << name;
    EXPECT_LT((fitted.q - example.motion.q).norm(), 4e-3) << name;
  }
}

// What is tolerated of one does not hide what is not of another.
TEST(MotionFit, EveryMoveIsJudgedByItself) {
  const LoopExample example("mobile_manipulator");
  const Dynamics dynamics(example.mechanism, example.scene);
  MotionFit fit(example.mechanism, dynamics, 0.02);
  const int left = example.mechanism.coordinateIndex("left_wheel");
  const int right = example.mechanism.coordinateIndex("right_wheel");
  MotionCovariance covariance;
  covariance.coordinates.assign(8, Eigen::Vector3d(1e-12, 1e-12, 1e-8).asDiagonal());
  covariance.coordinates[static_cast<std::size_t>(left)](1, 1) = 1e-8;
  Motion motion(dynamics.coordinates());
  motion.qd[left] = 1;
  motion.qd[right] = 1e-3;
  EXPECT_FALSE(fit.fit(motion, &covariance, kNoNoise).explained);
  EXPECT_EQ(fit.outcome().farthest.coordinate, left);
}

TEST(MotionFit, LoopsThatNothingCanCloseAreOpen) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  MotionCovariance covariance;
  covariance.coordinates.assign(static_cast<std::size_t>(example.motion.q.size()),
                                Eigen::Matrix3d::Zero());
  Motion fitted = example.motion;
  fitted.q[1] += 1e-3;
  const Motion measured = fitted;
  EXPECT_FALSE(fit.fit(fitted, &covariance, kNoNoise).closed);
  EXPECT_EQ(fitted.q, measured.q);
}

// The conditions out of an oblique plane have roundings for entries.
TEST(MotionFit, RoundingsAreNoConditions) {
  const FourBar four_bar;
  std::mt19937 random(5);
  for (const char pivot : {'A', 'B', 'C', 'D'}) {
    const FourBar::Cut cut = four_bar.cut(pivot);
    const Dynamics dynamics(cut.mechanism, cut.scene);
    MotionFit fit(cut.mechanism, dynamics);
    const MotionCovariance covariance =
        unevenCovariance(dynamics.coordinates(), {1e-5, 1e-3, 0.03});
    for (int i = 0; i < 20; ++i) {
      const Motion exact = cut.motion(four_bar.turnings(0.3L * i, 1, 2));
      Motion fitted = withNoise(exact, covariance, random);
      EXPECT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained) << pivot << i;
      EXPECT_LT(violationBy(dynamics, fitted), 1e-12) << pivot << i;
      EXPECT_LT((fitted.q - exact.q).norm(), 1e-3) << pivot << i;
      EXPECT_LT((fitted.qd - exact.qd).norm(), 0.1) << pivot << i;
    }
  }
}

TEST(MotionFit, SinglePositionsAreTheLeastNoise) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  const MotionCovariance covariance = unevenCovariance(example.motion.q.size(), {1e-6, 1e-4, 1e-2});
  Motion measured = example.motion;
  measured.q[1] += 1e-3;
  Motion fitted = measured;
  EXPECT_FALSE(fit.fit(fitted, &covariance, kNoNoise, false).explained);
  fitted = measured;
  const Eigen::VectorXd noise = Eigen::VectorXd::Constant(measured.q.size(), 1e-3);
  EXPECT_TRUE(fit.fit(fitted, &covariance, noise, false).explained);
  EXPECT_LT(fit.outcome().position_rms, 1);
}

// Before noise is known all joints move alike, and nothing is said of that.
TEST(MotionFit, WithoutCovariancesLoopsCloseAllTheSame) {
  const Moving example("stewart_gough");
  MotionFit fit(example.mechanism, example.dynamics);
  std::mt19937 random(4);
  Motion fitted =
      withNoise(example.motion, unevenCovariance(example.motion.q.size(), {1e-4, 1e-2, 1}), random);
  EXPECT_TRUE(fit.fit(fitted, nullptr, kNoNoise).explained);
  EXPECT_EQ(fit.outcome().position_rms, 0);
  EXPECT_EQ(fit.outcome().velocity_rms, 0);
  EXPECT_EQ(fit.outcome().farthest.coordinate, -1);
  EXPECT_LT(violationBy(example.dynamics, fitted), 1e-12);
}

TEST(MotionFit, ExactCoordinatesStay) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  MotionCovariance covariance = unevenCovariance(example.motion.q.size(), {1e-4, 1e-2, 0.3});
  std::mt19937 random(2);
  const Motion measured = withNoise(example.motion, covariance, random);
  covariance.coordinates[0].setZero();
  Motion fitted = measured;
  ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise).explained);
  EXPECT_EQ(fitted.q[0], measured.q[0]);
  EXPECT_EQ(fitted.qd[0], measured.qd[0]);
  EXPECT_EQ(fitted.qdd[0], measured.qdd[0]);
  EXPECT_LT(violationBy(example.dynamics, fitted), 1e-12);
}

TEST(MotionFit, RatesStayWhereTheyAreNotAskedFor) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  const MotionCovariance covariance = unevenCovariance(example.motion.q.size(), {1e-4, 1e-2, 0.3});
  std::mt19937 random(2);
  const Motion measured = withNoise(example.motion, covariance, random);
  Motion fitted = measured;
  ASSERT_TRUE(fit.fit(fitted, &covariance, kNoNoise, false).closed);
  EXPECT_NE(fitted.q, measured.q);
  EXPECT_EQ(fitted.qd, measured.qd);
  EXPECT_EQ(fitted.qdd, measured.qdd);
}

// Shafts that turn together by as many couplings.
TEST(MotionFit, GroupsOfManyConditionsStay) {
  for (const int couplings : {60, 110}) {
    RobotBuilder builder(1);
    Scene scene;
    for (int i = 0; i <= couplings; ++i) {
      builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), Matrix3l::Identity(),
                  Vector3l::Zero());
      if (i == 0) continue;
      Coupling coupling;
      coupling.name = "coupling_" + std::to_string(i);
      coupling.terms = {{"joint_" + std::to_string(i), 1.0},
                        {"joint_" + std::to_string(i + 1), -1.0}};
      scene.couplings.push_back(coupling);
    }
    scene.actuated = {"joint_1"};
    const Mechanism mechanism = builder.build();
    const Dynamics dynamics(mechanism, scene);
    MotionFit fit(mechanism, dynamics);
    std::mt19937 random(1);
    const MotionCovariance covariance =
        unevenCovariance(dynamics.coordinates(), {1e-5, 1e-3, 1e-2});
    const Motion measured = withNoise(Motion(dynamics.coordinates()), covariance, random);
    Motion fitted = measured;
    EXPECT_TRUE(fit.fit(fitted, &covariance, kNoNoise).closed);
    EXPECT_EQ(violationBy(dynamics, fitted) < 1e-12, couplings < 100);
    EXPECT_EQ(fitted.q == measured.q, couplings > 100);
  }
}

TEST(MotionFit, OpenChainsAreNotFitted) {
  const LoopExample example("six_axis_arm");
  const Dynamics dynamics(example.mechanism, example.scene);
  MotionFit fit(example.mechanism, dynamics);
  EXPECT_FALSE(fit.any());
  Motion motion(dynamics.coordinates());
  EXPECT_TRUE(fit.fit(motion, nullptr, kNoNoise).explained);
  EXPECT_EQ(fit.outcome().farthest.coordinate, -1);
}

TEST(MotionFit, RefusesAnotherNumberOfCoordinates) {
  const Moving example("four_bar");
  MotionFit fit(example.mechanism, example.dynamics);
  Motion motion = example.motion;
  const MotionCovariance covariance = unevenCovariance(2, {1, 1, 1});
  EXPECT_THROW(fit.fit(motion, &covariance, kNoNoise), MotionError);
  EXPECT_THROW(fit.fit(motion, nullptr, Eigen::VectorXd::Zero(2)), MotionError);
  Motion short_motion(2);
  EXPECT_THROW(fit.fit(short_motion, &covariance, kNoNoise), MotionError);
}

}  // namespace
}  // namespace virtual_work_dynamics
