// What is said of fits: which moves noise explains, and what is not known.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "fitted_motions.h"

namespace virtual_work_dynamics {
namespace {

using fitted_motions::kNoNoise;
using fitted_motions::Moving;
using fitted_motions::unevenCovariance;
using fitted_motions::violationBy;
using fitted_motions::withNoise;

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

}  // namespace
}  // namespace virtual_work_dynamics
