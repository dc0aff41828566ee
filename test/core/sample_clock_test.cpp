#include "motion/sample_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace virtual_work_dynamics {
namespace {

/// Ticks of an even clock with rows missing, and stamps that err.
struct Clock {
  std::vector<double> truth;
  std::vector<double> stamps;

  Clock(int ticks, double interval, double deviation, double missing, double drift = 0) {
    std::mt19937 generator(4);
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> part(0, 1);
    for (int tick = 0; tick < ticks; ++tick) {
      const double t = 1000 + tick * interval * (1 + drift * tick / ticks);
      const double stamp = t + deviation * normal(generator);
      if (part(generator) < missing && tick > 0) continue;
      truth.push_back(t);
      stamps.push_back(stamps.empty() ? stamp : std::max(stamp, stamps.back() + 1e-7));
    }
  }
};

double rms(const std::vector<double>& times, const std::vector<double>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < times.size(); ++i) sum += std::pow(times[i] - truth[i], 2);
  return std::sqrt(sum / static_cast<double>(times.size()));
}

TEST(SampleClock, RecoversAnEvenClockFromNoisyStamps) {
  for (const double interval : {0.001, 0.008})
    for (const double part : {0.02, 0.1, 0.3})
      for (const double missing : {0.0, 0.02}) {
        // Stamps that err by a third of the interval do not tell which rows are missing.
        if (part > 0.2 && missing > 0) continue;
        SCOPED_TRACE(std::to_string(interval) + " s, deviation " + std::to_string(part) +
                     ", missing " + std::to_string(missing));
        const Clock clock(4000, interval, part * interval, missing);
        const std::vector<double> times = evenTimes(clock.stamps);
        ASSERT_EQ(times.size(), clock.stamps.size());
        // The drift that is allowed for over half a second is learnt from some 60 to 500 stamps.
        EXPECT_LT(rms(times, clock.truth), 0.35 * part * interval);
        // One tick that is miscounted would be a whole interval.
        double worst = 0;
        for (std::size_t i = 0; i < times.size(); ++i)
          worst = std::max(worst, std::abs(times[i] - clock.truth[i]));
        EXPECT_LT(worst, 0.5 * interval);
      }
}

TEST(SampleClock, FollowsAClockThatDrifts) {
  const Clock clock(4000, 0.002, 2e-4, 0.02, 1e-3);
  const std::vector<double> times = evenTimes(clock.stamps);
  ASSERT_EQ(times.size(), clock.stamps.size());
  EXPECT_LT(rms(times, clock.truth), 0.35 * 2e-4);
}

TEST(SampleClock, MeasuresALongGapByItsLength) {
  Clock clock(1000, 0.002, 1e-4, 0);
  for (std::size_t i = 500; i < clock.stamps.size(); ++i) {
    clock.stamps[i] += 0.75;
    clock.truth[i] += 0.75;
  }
  const std::vector<double> times = evenTimes(clock.stamps);
  ASSERT_EQ(times.size(), clock.stamps.size());
  EXPECT_LT(rms(times, clock.truth), 0.4 * 1e-4);
}

TEST(SampleClock, TimesIncrease) {
  for (const double part : {0.1, 0.5, 1.0, 3.0}) {
    const std::vector<double> times = evenTimes(Clock(3000, 0.001, 0.001 * part, 0.05).stamps);
    for (std::size_t i = 1; i < times.size(); ++i) ASSERT_GT(times[i], times[i - 1]) << part;
  }
}

TEST(SampleClock, SaysNothingOfEvenOrFewStamps) {
  EXPECT_TRUE(evenTimes({}).empty());
  EXPECT_TRUE(evenTimes({1}).empty());
  EXPECT_TRUE(evenTimes(Clock(1000, 0.001, 0, 0).stamps).empty());
  EXPECT_TRUE(evenTimes(Clock(1000, 0.001, 0, 0.02).stamps).empty());  // rows missing, but no noise
  EXPECT_TRUE(evenTimes(Clock(63, 0.001, 1e-4, 0).stamps).empty());
  EXPECT_EQ(evenTimes(Clock(64, 0.001, 1e-4, 0).stamps).size(), 64u);
}

TEST(SampleClock, UsualIntervalIsTheMedian) {
  EXPECT_EQ(usualInterval({}), 1);
  EXPECT_EQ(usualInterval({3}), 1);
  EXPECT_EQ(usualInterval({0, 0.25}), 0.25);
  EXPECT_EQ(usualInterval({0, 1, 2, 12, 12.5, 13.5}), 1);
}

}  // namespace
}  // namespace virtual_work_dynamics
