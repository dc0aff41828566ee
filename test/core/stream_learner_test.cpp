#include "motion/stream_learner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kGap = 250000000;  // ns
constexpr double kInterval = 0.004;
constexpr double kLeast = 1e-12;  // rad
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kTwoPi = 6.283185307179586;

/// Records samples of a law; identifications run as they are due. @returns how many finished.
int record(
    StreamLearner& learner, int samples, const std::function<double(double)>& q,
    const std::function<double(double)>& qd = [](double) { return kNone; }) {
  int found = 0;
  for (int i = 1; i <= samples; ++i) {
    found += learner.identify(kLeast, kInterval) ? 1 : 0;
    const double t = kInterval * i;
    learner.record(std::llround(t * 1e9), q(t), qd(t), i, kInterval);
  }
  return found;
}

std::function<double(double)> noisySine(double noise, unsigned seed) {
  return [noise, generator = std::mt19937(seed), normal = std::normal_distribution<double>(0, 1)](
             double t) mutable { return std::sin(3 * t) + noise * normal(generator); };
}

TEST(StreamLearner, AssumesWhatTheSettingsGive) {
  NoiseSettings settings;
  settings.position_noise = 2e-3;
  settings.stamp_noise = 3e-4;
  settings.bandwidth = 5;
  StreamLearner learner(settings, kGap, true);
  learner.assume(ShownNoise(), kInterval);
  EXPECT_FALSE(learner.learnt());
  EXPECT_NEAR(std::sqrt(learner.model().position_variance), 2e-3, 1e-15);
  EXPECT_NEAR(std::sqrt(learner.model().stamp_variance), 3e-4, 1e-15);
  EXPECT_NEAR(timeConstant(learner.model(), StreamLearner::kOrder, kInterval), 1 / (kTwoPi * 5),
              1e-12);
  EXPECT_FALSE(learner.model().usesVelocities());
}

TEST(StreamLearner, LeavesWhatTheSettingsGive) {
  NoiseSettings settings;
  settings.position_noise = 2e-3;
  settings.bandwidth = 5;
  StreamLearner learner(settings, kGap, true);
  learner.assume(ShownNoise(), kInterval);
  const StreamModel before = learner.model();
  EXPECT_FALSE(learner.worsen(9));
  EXPECT_FALSE(learner.quicken(kInterval));
  EXPECT_EQ(learner.model().position_variance, before.position_variance);
  EXPECT_EQ(learner.model().density, before.density);
}

TEST(StreamLearner, WorsensNoiseAndMotionAlike) {
  StreamLearner learner(NoiseSettings(), kGap, true);
  learner.assume(ShownNoise(), kInterval);
  const StreamModel before = learner.model();
  EXPECT_TRUE(learner.worsen(9));
  EXPECT_EQ(learner.model().position_variance, 9 * before.position_variance);
  EXPECT_EQ(learner.model().density, 9 * before.density);
}

// Of a steady motion any time constant is as likely as a longer one.
TEST(StreamLearner, FindsNoTimeConstantWhoseSwingItHasNotSeen) {
  StreamLearner learner(NoiseSettings(), kGap, true);
  learner.assume(ShownNoise(), kInterval);
  std::mt19937 generator(4);
  std::normal_distribution<double> noise(0, 1e-3);
  int found = 0;
  for (int i = 1; i <= 1000; ++i) {
    const double t = kInterval * i;
    if (learner.identify(kLeast, kInterval)) {
      ++found;
      const double time = timeConstant(learner.model(), StreamLearner::kOrder, kInterval);
      constexpr double kRounding = 1e-12;
      EXPECT_LE(time, std::max(t / 6, 8 * kInterval) + kRounding) << t;
      EXPECT_GE(time, t / 60) << t;
    }
    learner.record(std::llround(t * 1e9), t + noise(generator), kNone, i, kInterval);
  }
  EXPECT_GT(found, 3);
}

TEST(StreamLearner, QuickensUpToTheShortestTime) {
  StreamLearner learner(NoiseSettings(), kGap, true);
  learner.assume(ShownNoise(), kInterval);
  learner.raise(1e-3);
  double before = learner.model().density;
  EXPECT_TRUE(learner.quicken(kInterval));
  EXPECT_EQ(learner.model().density, 10 * before);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(learner.quicken(kInterval));
  EXPECT_NEAR(timeConstant(learner.model(), StreamLearner::kOrder, kInterval), 0.004, 1e-12);
}

TEST(StreamLearner, LearnsNoiseAndVelocities) {
  // From some 700 samples a deviation is known to 3 %; four times as much.
  constexpr double kTolerance = 0.12;
  StreamLearner learner(NoiseSettings(), kGap, true);
  learner.assume(ShownNoise(), kInterval);
  std::mt19937 generator(5);
  std::normal_distribution<double> normal(0, 1e-2);
  const auto velocity = [&](double t) { return 3 * std::cos(3 * t) + normal(generator); };
  EXPECT_GT(record(learner, 3000, noisySine(1e-4, 6), velocity), 2);
  EXPECT_TRUE(learner.learnt());
  EXPECT_NEAR(std::sqrt(learner.model().position_variance) / 1e-4, 1, kTolerance);
  EXPECT_NEAR(std::sqrt(learner.model().velocity_variance) / 1e-2, 1, kTolerance);
  EXPECT_EQ(learner.velocityRatio(), 1);
}

TEST(StreamLearner, DoesNotUseVelocitiesInDegrees) {
  StreamLearner learner(NoiseSettings(), kGap, true);
  learner.assume(ShownNoise(), kInterval);
  const double degrees = 360 / kTwoPi;
  record(learner, 3000, noisySine(1e-4, 7),
         [&](double t) { return degrees * 3 * std::cos(3 * t); });
  EXPECT_FALSE(learner.model().usesVelocities());
  EXPECT_NEAR(learner.velocityRatio() / degrees, 1, 0.01);
}

TEST(StreamLearner, LearnsNothingFromPositionsThatAreAllEqual) {
  StreamLearner learner(NoiseSettings(), kGap, true);
  learner.assume(ShownNoise(), kInterval);
  EXPECT_EQ(record(learner, 3000, [](double) { return 0.1; }), 0);
  EXPECT_FALSE(learner.learnt());
}

TEST(StreamLearner, UnlearnsButKeepsTheModelUntilAnotherIsAssumed) {
  StreamLearner learner(NoiseSettings(), kGap, true);
  learner.assume(ShownNoise(), kInterval);
  record(learner, 1000, noisySine(1e-4, 8));
  ASSERT_TRUE(learner.learnt());
  const double variance = learner.model().position_variance;
  learner.unlearn();
  EXPECT_FALSE(learner.learnt());
  EXPECT_EQ(learner.model().position_variance, variance);
  learner.assume(ShownNoise(), kInterval);
  EXPECT_LT(learner.model().position_variance, variance);
}

}  // namespace
}  // namespace virtual_work_dynamics
