#include "offline/effort_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace virtual_work_dynamics {
namespace {

// A motion with several frequencies, as a lag and viscous friction are one and the same on one.
constexpr double kRates[] = {1.3, 3.1, 7.7, 12.4};
constexpr double kSizes[] = {0.5, 0.3, 0.08, 0.03};

double velocityAt(double t) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += kSizes[i] * kRates[i] * std::cos(kRates[i] * t + i);
  return sum;
}

double effortAt(double t) {
  double position = 0, acceleration = 0;
  for (int i = 0; i < 4; ++i) {
    position += kSizes[i] * std::sin(kRates[i] * t + i);
    acceleration -= kSizes[i] * kRates[i] * kRates[i] * std::sin(kRates[i] * t + i);
  }
  return 9.81 * std::sin(position) + 0.53 * acceleration;
}

// Rows at about a kilohertz whose stamps jitter, with what was measured at them.
ComparedEfforts recorded(double seconds, const std::function<double(double)>& measuredAt,
                         unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-4e-4, 4e-4);
  ComparedEfforts efforts;
  efforts.joint = "elbow";
  efforts.unit = "N m";
  for (int i = 0; i < seconds * 1000; ++i) {
    const double t = i * 1e-3 + jitter(random);
    efforts.times.push_back(t);
    efforts.computed.push_back(effortAt(t));
    efforts.measured.push_back(measuredAt(t));
    efforts.velocities.push_back(velocityAt(t));
  }
  return efforts;
}

TEST(EffortComparison, FindsTheLagBesideFrictionGainOffsetAndNoise) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.2);  // N m, on some 4 N m rms
  for (const double lag : {-0.031, 0.0, 0.004, 0.0123, 0.06}) {
    const auto measuredAt = [&](double t) {
      const double v = velocityAt(t - lag);
      return 0.93 * effortAt(t - lag) + 0.8 * v + 1.1 * std::tanh(v / 0.02) + 0.4 + noise(random);
    };
    const EffortComparison found = compare(recorded(6, measuredAt, 1));
    ASSERT_TRUE(found.lag.has_value()) << lag;
    EXPECT_NEAR(*found.lag, lag, 4 * found.lag_deviation) << lag;
    EXPECT_LT(found.lag_deviation, 5e-4);
  }
}

TEST(EffortComparison, KnowsHowFarItsLagMayBeOff) {
  // Of what a description does not know, much is slow: noise of some 3 Hz here.
  constexpr double kLag = 0.01;
  constexpr int kRuns = 40;
  int within_two = 0;
  double relative = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::mt19937 random(static_cast<unsigned>(100 + run));
    std::normal_distribution<double> noise(0, 1);
    double slow = 0;
    const auto measuredAt = [&](double t) {
      slow += 0.02 * (-slow + 5 * noise(random));
      return effortAt(t - kLag) + 0.5 * velocityAt(t - kLag) + slow;
    };
    const EffortComparison found = compare(recorded(6, measuredAt, 7));
    ASSERT_TRUE(found.lag.has_value());
    const double error = std::abs(*found.lag - kLag) / found.lag_deviation;
    within_two += error < 2;
    relative += error * error / kRuns;
  }
  // Of 40 errors of which each is within two deviations with 0.95, 34 are with 0.995.
  EXPECT_GE(within_two, 34);
  EXPECT_GT(relative, 0.3);  // nor are the deviations far too large
}

TEST(EffortComparison, SaysNoLagOfAMotionThatShowsNone) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.2);
  ComparedEfforts still = recorded(
      3, [&](double) { return 4.5 + noise(random); }, 2);
  for (double& value : still.computed) value = 4.4;
  for (double& value : still.velocities) value = 0;
  EXPECT_FALSE(compare(still).lag.has_value());
  // One frequency only: viscous friction and an offset make any lag of it.
  ComparedEfforts swing = recorded(
      3, [](double t) { return 2 * std::sin(5 * t - 0.1); }, 2);
  for (std::size_t i = 0; i < swing.times.size(); ++i) {
    swing.computed[i] = 2 * std::sin(5 * swing.times[i]);
    swing.velocities[i] = std::cos(5 * swing.times[i]);
    swing.measured[i] += noise(random);
  }
  EXPECT_FALSE(compare(swing).lag.has_value());
}

TEST(EffortComparison, HasTheSignAndSizesOfItsDefinition) {
  ComparedEfforts efforts;
  efforts.times = {0, 1, 2, 3};
  efforts.measured = {1, 3, 1, 3};          // variance 1
  efforts.computed = {1.5, 3.5, 0.5, 3.5};  // less measured: 0.5 0.5 -0.5 0.5
  efforts.velocities = {0, 0, 0, 0};
  const EffortComparison found = compare(efforts);
  EXPECT_EQ(found.rows, 4U);
  EXPECT_DOUBLE_EQ(found.bias, 0.25);
  EXPECT_DOUBLE_EQ(found.rms, 0.5);
  ASSERT_TRUE(found.vaf.has_value());
  EXPECT_DOUBLE_EQ(*found.vaf, 1 - 0.1875);
}

TEST(EffortComparison, MeasuresNoVarianceOfAConstantNorOfNothing) {
  ComparedEfforts efforts;
  efforts.times = {0, 1, 2};
  efforts.measured = {0.1, 0.1, 0.1};
  efforts.computed = {0.2, 0.1, 0.3};
  efforts.velocities = {0, 0, 0};
  EXPECT_FALSE(compare(efforts).vaf.has_value());
  EXPECT_FALSE(compare(efforts).lag.has_value());
  const EffortComparison nothing = compare(ComparedEfforts());
  EXPECT_EQ(nothing.rows, 0U);
  EXPECT_EQ(nothing.rms, 0);
}

TEST(EffortComparison, TakesRowsWhoseTimesGoBackWithoutALag) {
  ComparedEfforts efforts = recorded(
      2, [](double t) { return effortAt(t - 0.01); }, 4);
  std::swap(efforts.times[500], efforts.times[501]);
  const EffortComparison found = compare(efforts);
  EXPECT_TRUE(found.vaf.has_value());
  EXPECT_FALSE(found.lag.has_value());
}

}  // namespace
}  // namespace virtual_work_dynamics
