#include "motion/shown_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
using Five = std::array<double, kDifferenced>;

/// Times in steps of 0.2 to 1.8 intervals, newest first, as a track gives them.
Five unevenTimes(std::mt19937& generator, double interval) {
  std::uniform_real_distribution<double> part(0.2, 1.8);
  Five times{};
  for (std::size_t i = 1; i < times.size(); ++i)
    times[i] = times[i - 1] - interval * part(generator);
  return times;
}

TEST(NoiseDifference, LeavesNothingOfCubics) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const double interval : {0.001, 0.1})
    for (int run = 0; run < 1000; ++run) {
      const Five times = unevenTimes(generator, interval);
      const double a = part(generator), b = part(generator);
      const double c = part(generator), d = part(generator);
      Five positions{};
      double most = 0;
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double t = times[i] / interval;
        positions[i] = a + t * (b + t * (c + t * d));
        most = std::max(most, std::abs(positions[i]));
      }
      // Weights of squares that sum to one: roundings of the positions, and of the weights.
      EXPECT_LE(std::abs(noiseDifference(times, positions)), 50 * kEps * most);
    }
}

// The divided difference of fourth order of c t^4 is c at any times. At even ones the weights are
// 1, -4, 6, -4, 1 over 24 h^4, whose squares sum to 70.
TEST(NoiseDifference, OfAQuarticAtEvenTimesIsKnown) {
  for (const double h : {0.001, 0.1}) {
    Five times{};
    Five positions{};
    for (std::size_t i = 0; i < times.size(); ++i) {
      times[i] = -h * static_cast<double>(i);
      positions[i] = 0.7 * std::pow(times[i] / h, 4);
    }
    const double expected = 0.7 * 24 / std::sqrt(70);
    EXPECT_NEAR(noiseDifference(times, positions), expected, 1e-12 * expected) << h;
  }
}

// The estimate of a variance from n values scatters by sqrt(2 / n), here 1 %. Five times as much is
// left in one of two million runs.
TEST(NoiseDifference, OfWhiteNoiseHasItsVariance) {
  constexpr int kRuns = 20000;
  constexpr double kNoise = 3e-4;
  const double tolerance = 5 * std::sqrt(2.0 / kRuns);
  for (const bool uneven : {false, true}) {
    std::mt19937 generator(2);
    std::normal_distribution<double> normal(0, kNoise);
    double squares = 0;
    for (int run = 0; run < kRuns; ++run) {
      Five times = unevenTimes(generator, 0.004);
      if (!uneven) times = {0, -0.004, -0.008, -0.012, -0.016};
      Five positions{};
      for (double& q : positions) q = normal(generator);
      const double difference = noiseDifference(times, positions);
      squares += difference * difference;
    }
    EXPECT_NEAR(squares / kRuns / (kNoise * kNoise), 1, tolerance) << uneven;
  }
}

/// Shows positions, at these times, to a ShownNoise.
ShownNoise shown(const std::vector<double>& times, const std::vector<double>& positions) {
  ShownNoise noise;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i > 1) noise.takeStep(positions[i - 2], positions[i - 1], positions[i]);
    if (i + 1 < kDifferenced) continue;
    Five t{};
    Five q{};
    for (std::size_t k = 0; k < kDifferenced; ++k) {
      t[k] = times[i - k] - times[i];
      q[k] = positions[i - k] - positions[i];
    }
    noise.takeDifference(t, q);
  }
  return noise;
}

std::vector<double> evenTimes(int samples, double interval) {
  std::vector<double> times;
  for (int i = 0; i < samples; ++i) times.push_back(interval * i);
  return times;
}

std::vector<double> at(const std::vector<double>& times, const std::function<double(double)>& law) {
  std::vector<double> positions;
  for (const double t : times) positions.push_back(law(t));
  return positions;
}

TEST(ShownNoise, FindsWhiteNoiseOnAMotion) {
  // Differences share samples: from 5000 the deviation scatters by some 2 %. Four times as much.
  constexpr double kTolerance = 0.08;
  for (const double noise : {1e-5, 1e-3}) {
    std::mt19937 generator(3);
    std::normal_distribution<double> normal(0, noise);
    const std::vector<double> times = evenTimes(5000, 0.001);
    const ShownNoise found =
        shown(times, at(times, [&](double t) { return std::sin(3 * t) + normal(generator); }));
    EXPECT_NEAR(found.deviation() / noise, 1, kTolerance) << noise;
  }
}

TEST(ShownNoise, IsTheStepWhereAJointIsSlow) {
  const std::vector<double> times = evenTimes(200, 0.001);
  const ShownNoise found =
      shown(times, at(times, [](double t) { return 1e-3 * std::round(100 * t); }));
  EXPECT_NEAR(found.least(), 1e-3 / std::sqrt(12), 1e-9);
}

TEST(ShownNoise, IsNoneOfExactSmoothMotions) {
  const std::vector<double> times = evenTimes(200, 0.001);
  const auto cubic = [](double t) { return t * (1 + t * (2 - 5 * t)); };
  EXPECT_LE(shown(times, at(times, cubic)).deviation(), 10 * kEps);
  // The least noise, before a step is found, is finer than any encoder.
  EXPECT_LE(shown(times, at(times, cubic)).least(), 1e-9);
}

// Of a sine with phases of p per sample, a difference of fourth order has the amplitude
// (2 sin(p/2))^4.
TEST(ShownNoise, OfSamplesFarApartIsWhatTheMotionDoesBetweenThem) {
  constexpr double kPhase = 0.3;
  const std::vector<double> times = evenTimes(2000, 0.1);
  const ShownNoise found =
      shown(times, at(times, [&](double t) { return std::sin(kPhase / 0.1 * t); }));
  const double expected = std::pow(2 * std::sin(kPhase / 2), 4) / std::sqrt(2);
  EXPECT_NEAR(found.deviation() / expected, 1, 0.01);  // a part of a period is left over
}

TEST(ShownNoise, NeedsSixDifferencesAndForgetsThemWithAStretch) {
  std::mt19937 generator(4);
  std::normal_distribution<double> normal(0, 1e-3);
  const std::vector<double> times = evenTimes(200, 0.001);
  std::vector<double> positions =
      at(times, [&](double) { return 1e-4 * std::round(1e4 * normal(generator)); });
  const auto first = [&](std::ptrdiff_t count) {
    return shown(std::vector<double>(times.begin(), times.begin() + count),
                 std::vector<double>(positions.begin(), positions.begin() + count));
  };
  EXPECT_EQ(first(9).deviation(), 0);  // five differences
  EXPECT_GT(first(10).deviation(), 0);
  ShownNoise noise = first(200);
  const double least = noise.least();
  EXPECT_NEAR(least, 1e-4 / std::sqrt(12), 1e-9);
  noise.restart();
  EXPECT_EQ(noise.deviation(), 0);
  EXPECT_EQ(noise.least(), least);
}

}  // namespace
}  // namespace virtual_work_dynamics
