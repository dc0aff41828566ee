#include "motion/far_positions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace virtual_work_dynamics {
namespace {

constexpr double kInterval = 0.008;  // s

FarFinding judged(const std::vector<double>& positions, int first) {
  std::vector<double> times;
  for (std::size_t i = 0; i < positions.size(); ++i)
    times.push_back(kInterval * static_cast<double>(i));
  return judgeFar(times.data(), positions.data(), first, static_cast<int>(positions.size()),
                  kInterval);
}

TEST(FarPositions, StepsThatAJointMakesAreNotFar) {
  // 20 rad/s at 125 Hz with the acceleration of that within one step, and a slow gripper.
  EXPECT_FALSE(isFar(0.0128, 0.008, 0.008, 1e-12, 0));
  EXPECT_FALSE(isFar(0.04, 1, 1, 1e-12, 0));
  // The time counts that is usual, or that it took if that is longer.
  EXPECT_FALSE(isFar(0.0128, 1e-6, 0.008, 1e-12, 0));
  EXPECT_FALSE(isFar(0.5, 0.05, 0.001, 1e-12, 0));
  EXPECT_TRUE(isFar(-0.7, 0.008, 0.008, 1e-12, 0));
  EXPECT_TRUE(isFar(0.02, 0.001, 0.001, 1e-12, 0));
  // Nor are those of a coarse encoder, or of noise.
  EXPECT_FALSE(isFar(0.02, 0.001, 0.001, 0.0015, 0));
  EXPECT_FALSE(isFar(0.02, 0.001, 0.001, 1e-12, 0.0011));
}

TEST(FarPositions, AJumpIsOneWhereTheJointStaysAfterIt) {
  const std::vector<double> begin{0, 0, 0, 0};
  std::vector<double> positions = begin;
  positions.push_back(0.7);
  EXPECT_EQ(judged(positions, 4).verdict, FarVerdict::kOpen);
  positions.push_back(0.701);
  EXPECT_EQ(judged(positions, 4).verdict, FarVerdict::kOpen);
  positions.push_back(0.703);
  EXPECT_EQ(judged(positions, 4).verdict, FarVerdict::kJump);
}

// With one sample before it, later ones have to tell what is usual.
TEST(FarPositions, AJumpAfterTheFirstSampleTakesSixSamples) {
  std::vector<double> positions{0};
  for (int i = 0; i < 5; ++i) {
    positions.push_back(0.7 + 0.01 * i);
    EXPECT_EQ(judged(positions, 1).verdict, FarVerdict::kOpen) << i;
  }
  positions.push_back(0.75);
  EXPECT_EQ(judged(positions, 1).verdict, FarVerdict::kJump);
}

TEST(FarPositions, OneOrTwoSamplesStandAlone) {
  const FarFinding one = judged({0.1, 0.11, 0.12, 0.13, 0.14, 0.15, -3, 0.17}, 6);
  EXPECT_EQ(one.verdict, FarVerdict::kAlone);
  EXPECT_EQ(one.alone, 1);
  const FarFinding two = judged({0.1, 0.11, 0.12, 0.13, 0.14, 0.15, -3, 4, 0.18}, 6);
  EXPECT_EQ(two.verdict, FarVerdict::kAlone);
  EXPECT_EQ(two.alone, 2);
  EXPECT_EQ(judged({0.1, 0.11, 0.12, 0.13, 0.14, -3}, 5).verdict, FarVerdict::kOpen);
}

TEST(FarPositions, ASetOffIsMotion) {
  // From standstill to 100 rad/s at once.
  EXPECT_EQ(judged({0, 0, 0, 0, 0, 0.8, 1.6, 2.4}, 5).verdict, FarVerdict::kMotion);
  // And to a standstill that is reached in four steps.
  EXPECT_EQ(judged({0, 0, 0, 0, 0, 0.8, 1.2, 1.4, 1.5}, 5).verdict, FarVerdict::kMotion);
}

TEST(FarPositions, PublishersThatContradictEachOtherAreMotion) {
  EXPECT_EQ(judged({0, 0.7, 0, 0.7, 0, 0.7, 0, 0.7}, 5).verdict, FarVerdict::kMotion);
}

TEST(FarPositions, IsDecidedInTheEnd) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10000; ++i)
    for (int first = 1; first <= kBeforeFar; ++first) {
      std::vector<double> positions;
      for (int k = 0; k < first + kMostFar; ++k)
        positions.push_back(std::pow(10, 3 * normal(random)));
      ASSERT_NE(judged(positions, first).verdict, FarVerdict::kOpen);
    }
}

}  // namespace
}  // namespace virtual_work_dynamics
