#include "ros/sample_times.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kSecond = 1000000000;

TEST(SampleTimes, AreEvenlySpacedAndIncludeTheEnd) {
  const SampleTimes samples(6, 1000);
  ASSERT_EQ(samples.last(), 6000);
  EXPECT_EQ(samples.durationNs(), 6 * kSecond);
  EXPECT_EQ(samples.stepNs(), kSecond / 1000);
  for (std::int64_t k = 0; k <= samples.last(); ++k) EXPECT_EQ(samples.offset(k), k * 1000000);
  EXPECT_EQ(samples.time(0), 0);
  EXPECT_EQ(samples.time(100), 0.1);
  EXPECT_EQ(samples.time(6000), 6);
}

TEST(SampleTimes, AreRoundedToTheNearestNanosecond) {
  const SampleTimes samples(2, 7);
  ASSERT_EQ(samples.last(), 14);
  // In integers: round(k 1e9 / 7).
  for (std::int64_t k = 0; k <= 14; ++k) {
    EXPECT_EQ(samples.offset(k), (2 * k * kSecond + 7) / 14);
    EXPECT_EQ(samples.time(k), static_cast<double>((2 * k * kSecond + 7) / 14) / 1e9);
  }
  // A spacing rounded first would be off by 8 ns here.
  EXPECT_EQ(SampleTimes(100, 60).offset(5999), 99983333333);
}

TEST(SampleTimes, StayExactInLongMotions) {
  // A week at 1 kHz.
  const SampleTimes samples(604800, 1000);
  ASSERT_EQ(samples.last(), 604800000);
  EXPECT_EQ(samples.offset(604799999), 604799999000000);
}

TEST(SampleTimes, LastStepTakesUpTheRemainder) {
  // 2.4 and 2.6 spacings: two steps and a longer one, or three with a shorter one.
  const SampleTimes longer(0.24, 10);
  ASSERT_EQ(longer.last(), 2);
  EXPECT_EQ(longer.offset(1), kSecond / 10);
  EXPECT_EQ(longer.offset(2), 240000000);
  const SampleTimes shorter(0.26, 10);
  ASSERT_EQ(shorter.last(), 3);
  EXPECT_EQ(shorter.offset(2), kSecond / 5);
  EXPECT_EQ(shorter.offset(3), 260000000);
}

TEST(SampleTimes, NeverPassTheEndOfTheMotion) {
  // Rounded up to the next nanosecond, the end would lie outside.
  const double duration = 2.0 / 3;
  const SampleTimes samples(duration, 3);
  ASSERT_EQ(samples.last(), 2);
  EXPECT_EQ(samples.offset(2), 666666667);
  EXPECT_EQ(samples.time(2), duration);
}

TEST(SampleTimes, ShortMotionsHaveTwoSamplesAndInstantsOne) {
  EXPECT_EQ(SampleTimes(0.001, 10).last(), 1);
  EXPECT_EQ(SampleTimes(0.001, 10).offset(1), 1000000);
  EXPECT_EQ(SampleTimes(0, 10).last(), 0);
  EXPECT_EQ(SampleTimes(0, 10).offset(0), 0);
}

TEST(SampleTimes, IncreaseAtTheHighestRate) {
  for (const double duration : {1e-6, 1.4e-6, 1.6e-6, 12.3456789e-6}) {
    const SampleTimes samples(duration, 1e6);
    for (std::int64_t k = 1; k <= samples.last(); ++k) {
      EXPECT_GT(samples.offset(k), samples.offset(k - 1)) << duration;
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
