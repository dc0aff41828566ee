#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "motion/sample_blocks.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Step after each sample of a law of the sample's number.
std::vector<double> stepsOf(int samples, const std::function<double(int)>& law) {
  StepFinder finder;
  std::vector<double> steps;
  for (int i = 0; i < samples; ++i) {
    if (i > 1) finder.take(law(i - 2), law(i - 1), law(i));
    steps.push_back(finder.step());
  }
  return steps;
}

/// The number of the sample with which a step was found first; -1: there was none.
int foundAt(const std::vector<double>& steps) {
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (std::isfinite(steps[i])) return static_cast<int>(i);
  return -1;
}

std::vector<double> noisy(int samples, unsigned seed, const std::function<double(double)>& law,
                          double noise, double uneven) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> part(-uneven, uneven);
  std::vector<double> positions;
  for (int i = 0; i < samples; ++i)
    positions.push_back(law(i + part(generator)) + noise * normal(generator));
  return positions;
}

// At 1e4 rad a double resolves 1.8e-12 rad, and a difference of three positions 1e-6 of a step of
// 1e-5 rad. The tolerance is ten times as much.
constexpr double kTolerance = 1e-5;

TEST(StepFinder, FindsTheQuantumOfASteadyMotion) {
  for (const double quantum : {1e-5, 1e-3})
    for (const double offset : {0.0, 0.3 * quantum, 1.2345, 1e4 + 0.2})
      for (const double speed : {0.013, 0.1, 0.5, 0.9, 3.7, 9.99, 10.01, 41.3}) {
        SCOPED_TRACE(std::to_string(quantum) + " at " + std::to_string(offset) + ", quanta " +
                     std::to_string(speed));
        const auto law = [&](int i) { return offset + quantum * std::round(speed * i); };
        const std::vector<double> steps = stepsOf(400, law);
        const int found = foundAt(steps);
        ASSERT_GE(found, 0);
        for (auto i = static_cast<std::size_t>(found); i < steps.size(); ++i)
          EXPECT_NEAR(steps[i] / quantum, 1, kTolerance) << i;
      }
}

// An encoder that goes on by ten quanta with each sample shows neither its quantum nor another one.
TEST(StepFinder, FindsNothingInAWholeNumberOfQuantaPerSample) {
  for (const double quantum : {1e-5, 1e-3})
    for (const double offset : {0.0, 0.3 * quantum, 1.2345, 1e4 + 0.2})
      for (const double speed : {1, 10, 137})
        EXPECT_EQ(foundAt(stepsOf(400, [&](int i) { return offset + quantum * speed * i; })), -1)
            << quantum << " " << offset << " " << speed;
}

TEST(StepFinder, FindsTheQuantumOfASlowJointWithItsFirstStep) {
  // At a tenth of a quantum per sample the first step comes with sample 5, and is seen to end with
  // the sample after it.
  for (const double quantum : {1e-5, 1e-3})
    for (const double offset : {0.0, 1e4 + 0.2}) {
      const auto law = [&](int i) { return offset + quantum * std::round(0.1 * i); };
      EXPECT_EQ(foundAt(stepsOf(100, law)), 6) << quantum << " " << offset;
    }
}

TEST(StepFinder, FindsTheQuantumOfASine) {
  for (const double quantum : {1e-5, 1e-3})
    for (const double offset : {0.0, 1e4 + 0.2}) {
      const auto law = [&](int i) {
        return quantum * std::round((offset + std::sin(0.003 * i)) / quantum);
      };
      EXPECT_NEAR(stepsOf(400, law).back() / quantum, 1, kTolerance) << quantum << " " << offset;
    }
}

TEST(StepFinder, FindsTheQuantumBelowWhiteNoise) {
  for (const double quantum : {1e-5, 1e-3}) {
    std::vector<double> positions = noisy(
        200, 1, [](double i) { return std::sin(0.003 * i); }, 3 * quantum, 0);
    for (double& q : positions) q = quantum * std::round(q / quantum);
    const auto law = [&](int i) { return positions[static_cast<std::size_t>(i)]; };
    EXPECT_NEAR(stepsOf(200, law).back() / quantum, 1, kTolerance) << quantum;
  }
}

TEST(StepFinder, FindsNothingInSmoothMotionsAndJumps) {
  const std::vector<std::pair<const char*, std::function<double(int)>>> laws = {
      {"rest", [](int) { return 0.1; }},
      {"steady ramp", [](int i) { return 0.0007 * i; }},
      {"parabola", [](int i) { return 0.0007 * i + 1e-6 * i * i; }},
      {"sine", [](int i) { return std::sin(0.003 * i); }},
      {"jump at rest", [](int i) { return i > 100 ? 0.5 : 0; }},
      {"jump in a ramp", [](int i) { return 0.0007 * i + (i > 100 ? 0.5 : 0); }}};
  for (const auto& [name, law] : laws)
    for (const double offset : {0.0, 1.2345, 1e4}) {
      const std::function<double(int)>& relative = law;
      EXPECT_EQ(foundAt(stepsOf(5000, [&](int i) { return offset + relative(i); })), -1)
          << name << " at " << offset;
    }
}

// Numbers that are not rounded have a common divisor near the rounding of their differences. What
// noise it stands for is far below that of the positions, and of any encoder.
TEST(StepFinder, FindsNothingThatMattersInUnroundedNoise) {
  constexpr double kNoise = 1e-4;
  constexpr double kPart = 5e-3;  // of the noise; largest among the first samples at 1e4 rad
  for (const double offset : {0.0, 1.2345, 1e4})
    for (unsigned seed = 0; seed < 20; ++seed) {
      const std::vector<double> positions = noisy(
          1000, seed, [&](double) { return offset; }, kNoise, 0);
      const auto law = [&](int i) { return positions[static_cast<std::size_t>(i)]; };
      for (const double step : stepsOf(1000, law))
        EXPECT_LE(leastNoise(step, offset), kPart * kNoise) << offset;
    }
}

TEST(StepFinder, FindsNothingThatMattersInASineAtUnevenTimes) {
  constexpr double kUnimportant = 2e-9;  // rad; the finest encoders resolve 1e-7 rad
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<double> positions = noisy(
        1000, seed, [](double i) { return std::sin(0.003 * i); }, 0, 0.3);
    const auto law = [&](int i) { return positions[static_cast<std::size_t>(i)]; };
    for (const double step : stepsOf(1000, law)) EXPECT_LE(leastNoise(step, 1), kUnimportant);
  }
}

TEST(LeastNoise, IsThatOfRoundingToTheStep) {
  // Rounding errors are uniform within a step, of variance step^2 / 12.
  EXPECT_NEAR(leastNoise(1e-3, 1), 1e-3 / std::sqrt(12), 1e-18);
  EXPECT_NEAR(leastNoise(1e-3, -1e4), 1e-3 / std::sqrt(12), 1e-18);
}

TEST(LeastNoise, IsPositiveWithoutAStepAndGrowsWithThePosition) {
  EXPECT_GT(leastNoise(kInfinite, 0), 0);
  EXPECT_LT(leastNoise(kInfinite, 0), 1e-9);  // finer than any encoder
  // Doubles near 1e9 are 1.2e-7 apart.
  EXPECT_GT(leastNoise(kInfinite, -1e9), 1e-8);
  EXPECT_LT(leastNoise(kInfinite, -1e9), 1.2e-7);
}

TEST(LeastNoise, OfPositionsIsThatOfTheirStepAndTheLargest) {
  std::vector<double> positions;
  for (int i = 0; i < 100; ++i) positions.push_back(1e-3 * std::round(0.37 * i));
  EXPECT_NEAR(leastNoise(positions), 1e-3 / std::sqrt(12), kTolerance * 1e-3);
  EXPECT_EQ(leastNoise(std::vector<double>{1, -1e9, 2}), leastNoise(kInfinite, 1e9));
  EXPECT_EQ(leastNoise(std::vector<double>()), leastNoise(kInfinite, 0));
}

}  // namespace
}  // namespace virtual_work_dynamics
