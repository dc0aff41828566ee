#include "motion/velocity_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace virtual_work_dynamics {
namespace {

constexpr double kInterval = 0.002;
constexpr double kNoise = 1e-4;

/// Blocks of a swinging joint whose velocities are `given` of the true ones.
std::vector<StreamBlock> blocksOf(const std::function<double(double qd)>& given,
                                  double amplitude = 0.5) {
  std::mt19937 generator(2);
  std::normal_distribution<double> normal(0, kNoise);
  std::vector<StreamBlock> blocks;
  for (int i = 0; i < 1500; ++i) {
    const double t = 5 + kInterval * i;
    const double qd = amplitude * 3 * std::cos(3 * t);
    blocks.push_back({t, amplitude * std::sin(3 * t) + normal(generator), given(qd)});
  }
  return blocks;
}

VelocityJudgement judged(const std::vector<StreamBlock>& blocks) {
  return judgeVelocities(blocks, kInterval, kNoise);
}

// Noise of positions of 1e-4 in differences of 0.1 rad.
constexpr double kRatio = 2e-3;

TEST(VelocityJudge, TrueVelocitiesAgree) {
  const VelocityJudgement judgement = judged(blocksOf([](double qd) { return qd; }));
  EXPECT_TRUE(judgement.moved);
  EXPECT_TRUE(judgement.agree);
  EXPECT_NEAR(judgement.ratio, 1, kRatio);
}

TEST(VelocityJudge, NoiseThatAveragesOutIsNoContradiction) {
  std::mt19937 generator(9);
  std::normal_distribution<double> normal(0, 0.3);
  EXPECT_TRUE(judged(blocksOf([&](double qd) { return qd + normal(generator); })).agree);
  EXPECT_TRUE(judged(blocksOf([](double qd) { return std::round(qd / 0.1) * 0.1; })).agree);
}

TEST(VelocityJudge, FindsTheRatioOfWrongVelocities) {
  for (const double factor : {0.0, 57.29577951, 1.2, 0.8, -1.0}) {
    const VelocityJudgement judgement = judged(blocksOf([&](double qd) { return factor * qd; }));
    EXPECT_TRUE(judgement.moved);
    EXPECT_FALSE(judgement.agree) << factor;
    EXPECT_NEAR(judgement.ratio, factor, kRatio * std::max(1.0, std::abs(factor)));
  }
  EXPECT_TRUE(judged(blocksOf([](double qd) { return 1.05 * qd; })).agree);
}

TEST(VelocityJudge, WhatIsNotTheMotionIsAContradiction) {
  std::mt19937 generator(9);
  std::normal_distribution<double> normal(0, 10);
  EXPECT_FALSE(judged(blocksOf([&](double) { return normal(generator); })).agree);
  EXPECT_FALSE(judged(blocksOf([](double) { return 1.5; })).agree);  // "maximum" velocities
  // In the mean right, but with the motion of another joint on top.
  int i = 0;
  EXPECT_FALSE(judged(blocksOf([&](double qd) { return qd + 1.2 * std::sin(0.04 * i++); })).agree);
}

TEST(VelocityJudge, AJointThatRestsTellsNothing) {
  const VelocityJudgement judgement = judged(blocksOf([](double) { return 3; }, 0));
  EXPECT_FALSE(judgement.moved);
  EXPECT_TRUE(judgement.agree);
  EXPECT_EQ(judgement.ratio, 1);
  EXPECT_FALSE(judged({}).moved);
  EXPECT_FALSE(judged({{0, 1, 1}, {kInterval, 2, 1}}).moved);
}

TEST(VelocityJudge, StretchesWithoutVelocitiesOrWithGapsAreLeftOut) {
  std::vector<StreamBlock> blocks = blocksOf([](double qd) { return qd; });
  // A gap in which the joint went elsewhere, and velocities that are missing.
  for (std::size_t i = 700; i < blocks.size(); ++i) {
    blocks[i].time += 2;
    blocks[i].position += 40;
  }
  for (std::size_t i = 100; i < 300; ++i) blocks[i].velocity = std::nan("");
  const VelocityJudgement judgement = judged(blocks);
  EXPECT_TRUE(judgement.moved);
  EXPECT_TRUE(judgement.agree);
  EXPECT_NEAR(judgement.ratio, 1, kRatio);
  for (StreamBlock& block : blocks) block.velocity = std::nan("");
  EXPECT_FALSE(judged(blocks).moved);
}

}  // namespace
}  // namespace virtual_work_dynamics
