#include "motion/turn_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tumbling_roots.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLag = 0.05;

std::int64_t stampAt(double t) {
  return 1600000000000000000 + std::llround(t * 1e9);
}

Eigen::Vector3d drawn(std::mt19937& generator, double size) {
  std::normal_distribution<double> normal;
  const double x = size * normal(generator), y = size * normal(generator);
  return {x, y, size * normal(generator)};
}

// The orientation of a tumbling body, with noise in rad, signs as they fall, and rates unless the
// noise of these is negative.
TurnSample sampleAt(double t, double noise, double rate_noise, std::mt19937& generator) {
  const RootMotion truth = TumblingRoot{{0.4, 0.2, -0.3}, 0.6}.at(t);
  const Eigen::Vector3d turn = drawn(generator, noise);
  TurnSample sample;
  sample.stamp_ns = stampAt(t);
  sample.orientation = truth.orientation * Eigen::AngleAxisd(turn.norm(), turn.stableNormalized());
  if (turn.isZero()) sample.orientation = truth.orientation;
  if (generator() % 2 == 0) sample.orientation.coeffs() *= -1;
  if (rate_noise >= 0)
    sample.angular_velocity = truth.angular_velocity + drawn(generator, rate_noise);
  return sample;
}

Eigen::Matrix<double, 9, 1> errorAt(double t, const FreeTurn& found) {
  const RootMotion truth = TumblingRoot{{0.4, 0.2, -0.3}, 0.6}.at(t);
  const Eigen::Quaterniond back = truth.orientation.conjugate();
  Eigen::Quaterniond turn = back * found.orientation;
  if (turn.w() < 0) turn.coeffs() *= -1;
  Eigen::Matrix<double, 9, 1> error;
  error << 2 * turn.vec(), found.angular_velocity - back * truth.angular_velocity,
      found.angular_acceleration - back * truth.angular_acceleration;
  return error;
}

TEST(TurnEstimator, ExactOrientationsGiveTheTurnInTheAxesOfTheChild) {
  for (const double rate_noise : {-1.0, 0.0}) {
    TurnEstimator estimator((EstimatorSettings()));
    std::mt19937 generator(3);
    Eigen::Matrix<double, 9, 1> worst = Eigen::Matrix<double, 9, 1>::Zero();
    for (int i = 0; i < 1600; ++i) {
      const double t = i / 200.0;
      estimator.push(sampleAt(t, 0, rate_noise, generator));
      FreeTurn turn;
      if (t < 2) continue;
      ASSERT_TRUE(estimator.read(stampAt(t - kLag), turn, nullptr));
      worst = worst.cwiseMax(errorAt(t - kLag, turn).cwiseAbs());
    }
    EXPECT_LT(worst.head<3>().maxCoeff(), 1e-7);
    EXPECT_LT(worst.segment<3>(3).maxCoeff(), 1e-5);
    EXPECT_LT(worst.tail<3>().maxCoeff(), 2e-3);
  }
}

TEST(TurnEstimator, RestartsWhereTimeWentBackHoweverLittle) {
  TurnEstimator estimator((EstimatorSettings()));
  std::mt19937 generator(4);
  for (int i = 0; i < 400; ++i) estimator.push(sampleAt(i / 200.0, 0, -1, generator));
  FreeTurn turn;
  EXPECT_TRUE(estimator.read(stampAt(1.9), turn, nullptr));
  estimator.restart();
  EXPECT_TRUE(estimator.empty());
  EXPECT_FALSE(estimator.read(stampAt(1.9), turn, nullptr));
  EXPECT_EQ(estimator.push(sampleAt(1.9, 0, -1, generator)), TurnEstimator::Verdict::kAccepted);
  EXPECT_EQ(estimator.last(), stampAt(1.9));
}

TEST(TurnEstimator, DeviationsHold) {
  TurnEstimator estimator((EstimatorSettings()));
  std::mt19937 generator(5);
  int inside = 0, all = 0;
  double squares = 0;
  for (int i = 0; i < 4000; ++i) {
    const double t = i / 200.0;
    estimator.push(sampleAt(t, 2e-4, -1, generator));
    if (t < 3 || i % 3 != 0) continue;
    FreeTurn turn;
    TurnCovariance covariance;
    ASSERT_TRUE(estimator.read(stampAt(t - kLag), turn, &covariance));
    const Eigen::Matrix<double, 9, 1> error = errorAt(t - kLag, turn);
    for (int j = 0; j < 9; ++j, ++all) {
      const double ratio = error[j] / std::sqrt(covariance(j, j));
      squares += ratio * ratio;
      if (std::abs(ratio) <= 2) ++inside;
    }
  }
  EXPECT_GT(inside, 0.9 * all);
  EXPECT_GT(std::sqrt(squares / all), 0.7);
  EXPECT_LT(std::sqrt(squares / all), 1.3);
  EXPECT_NEAR(estimator.quality().position_noise, 2e-4, 0.4e-4);
}

TEST(TurnEstimator, WhatIsNotKnownIsNotMadeUp) {
  EstimatorSettings settings;
  settings.hold_after = 0.1;
  TurnEstimator estimator(settings);
  std::mt19937 generator(5);
  FreeTurn turn;
  EXPECT_TRUE(estimator.empty());
  for (int i = 0; i < 3; ++i) {
    estimator.push(sampleAt(0.01 * i, 0, -1, generator));
    EXPECT_FALSE(estimator.read(stampAt(0.01), turn, nullptr));
  }
  for (int i = 3; i < 20; ++i) estimator.push(sampleAt(0.01 * i, 0, -1, generator));
  EXPECT_TRUE(estimator.read(stampAt(0.29), turn, nullptr));
  EXPECT_FALSE(estimator.read(stampAt(0.2901), turn, nullptr));
  EXPECT_FALSE(estimator.read(stampAt(-0.01), turn, nullptr));
  const FreeTurn held = estimator.heldAt(stampAt(0.5));
  EXPECT_LT(errorAt(0.19, held).head<3>().norm(), 1e-9);
  EXPECT_EQ(held.angular_velocity.norm() + held.angular_acceleration.norm(), 0);
}

// As other joints do: what comes after a gap says nothing of the gap.
TEST(TurnEstimator, HoldsInAGapWhatCameBeforeIt) {
  EstimatorSettings settings;
  settings.hold_after = 0.1;
  TurnEstimator estimator(settings);
  std::mt19937 generator(5);
  for (int i = 0; i <= 20; ++i) estimator.push(sampleAt(0.01 * i, 0, -1, generator));
  for (int i = 0; i < 10; ++i) estimator.push(sampleAt(1 + 0.01 * i, 0, -1, generator));
  ASSERT_GT(errorAt(1.09, estimator.heldAt(stampAt(0.2))).head<3>().norm(), 0.1);
  for (const double t : {0.2, 0.5, 0.9999}) {
    FreeTurn turn;
    if (t > 0.3) {
      EXPECT_FALSE(estimator.read(stampAt(t), turn, nullptr)) << t;
    }
    EXPECT_LT(errorAt(0.2, estimator.heldAt(stampAt(t))).head<3>().norm(), 1e-9) << t;
  }
  EXPECT_LT(errorAt(1.09, estimator.heldAt(stampAt(2))).head<3>().norm(), 1e-9);
}

TEST(TurnEstimator, OrientationsAsTheyComeWhereNothingIsEstimated) {
  EstimatorSettings settings;
  settings.estimate = false;
  TurnEstimator estimator(settings);
  std::mt19937 generator(5);
  FreeTurn turn;
  EXPECT_FALSE(estimator.read(stampAt(0), turn, nullptr));
  estimator.push(sampleAt(0.3, 0, 0, generator));
  TurnCovariance covariance;
  ASSERT_TRUE(estimator.read(stampAt(0.3), turn, &covariance));
  EXPECT_LT(errorAt(0.3, turn).head<6>().norm(), 1e-9);
  EXPECT_EQ(turn.angular_acceleration.norm(), 0);
  EXPECT_TRUE(covariance.isZero(0));
}

}  // namespace
}  // namespace virtual_work_dynamics
