#include "motion/block_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kWallClock = 1700000000123456789;  // ns

/// A record of a ramp of 0.5 rad/s at 1 kHz: blocks of two samples, from the twelfth sample on.
class Ramp {
 public:
  Ramp() { record.reserve(); }
  void add(int samples, std::int64_t interval = kMillisecond) {
    for (int i = 0; i < samples; ++i) {
      stamp_ += interval;
      const double t = static_cast<double>(stamp_ - kWallClock) * 1e-9;
      record.add(stamp_, 1e4 + 0.5 * t, 0.5, ++stretch_, static_cast<double>(interval) * 1e-9);
    }
  }
  std::vector<StreamBlock> blocks() {
    std::vector<StreamBlock> blocks;
    record.copyTo(blocks);
    return blocks;
  }

  BlockRecord record;

 private:
  std::int64_t stamp_ = kWallClock;
  int stretch_ = 0;
};

TEST(BlockRecord, HoldsMeansOfSamples) {
  Ramp ramp;
  ramp.add(11 + 2 * 10 + 1);
  EXPECT_EQ(ramp.record.count(), 10u);
  EXPECT_EQ(ramp.record.fresh(), 10u);
  EXPECT_EQ(ramp.record.samples(), 2);
  EXPECT_NEAR(ramp.record.interval(), 0.002, 1e-15);
  const std::vector<StreamBlock> blocks = ramp.blocks();
  ASSERT_EQ(blocks.size(), 10u);
  EXPECT_EQ(ramp.record.fresh(), 0u);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    // The twelfth sample is the first: at 12 ms, with times from it.
    const double time = 0.0005 + 0.002 * static_cast<double>(i);
    EXPECT_NEAR(blocks[i].time, time, 1e-12);
    EXPECT_NEAR(blocks[i].position, 1e4 + 0.5 * (0.012 + time), 1e-11);
    EXPECT_EQ(blocks[i].velocity, 0.5);
  }
}

TEST(BlockRecord, KeepsTheLatest) {
  Ramp ramp;
  ramp.add(11 + 2 * static_cast<int>(BlockRecord::kMost + 5));
  std::vector<StreamBlock> blocks = ramp.blocks();
  ASSERT_EQ(blocks.size(), BlockRecord::kMost);
  EXPECT_NEAR(blocks[0].time, 0.0005 + 0.002 * 5, 1e-12);
  for (std::size_t i = 1; i < blocks.size(); ++i)
    EXPECT_NEAR(blocks[i].time - blocks[i - 1].time, 0.002, 1e-9);
  const double newest = blocks.back().time;
  ramp.record.keep(3);
  blocks = ramp.blocks();
  ASSERT_EQ(blocks.size(), 3u);
  EXPECT_EQ(blocks.back().time, newest);
}

TEST(BlockRecord, KeepsSixSecondsOfSlowStreams) {
  Ramp ramp;
  ramp.add(2000, 5 * kMillisecond);
  EXPECT_EQ(ramp.record.samples(), 1);
  EXPECT_EQ(ramp.record.count(), 1200u);
  EXPECT_NEAR(ramp.blocks().back().time - ramp.blocks()[0].time, 5.995, 1e-9);
}

TEST(BlockRecord, KeepsEnoughBlocksOfTheSlowest) {
  Ramp ramp;
  ramp.add(2000, 20 * kMillisecond);
  EXPECT_EQ(ramp.record.count(), BlockRecord::kMost / 2);
}

TEST(BlockRecord, HasNoBlockAcrossTheBeginningOfAStretch) {
  Ramp ramp;
  ramp.add(11 + 2 + 1);
  ramp.record.beginStretch();
  ramp.add(2);
  const std::vector<StreamBlock> blocks = ramp.blocks();
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_NEAR(blocks[1].time - blocks[0].time, 0.003, 1e-12);  // one sample belongs to none
}

TEST(BlockRecord, BeginsAnewAtAnotherRate) {
  Ramp ramp;
  ramp.add(11 + 2 * 10);
  ramp.add(1, 2 * kMillisecond);
  EXPECT_EQ(ramp.record.count(), 0u);
  ramp.add(7, 2 * kMillisecond);
  EXPECT_EQ(ramp.record.samples(), 1);
  EXPECT_EQ(ramp.record.count(), 7u);
}

TEST(BlockRecord, ForgetsWhenItIsCleared) {
  Ramp ramp;
  ramp.add(11 + 2 * 10 + 1);
  ramp.record.clear();
  EXPECT_EQ(ramp.record.count() + ramp.record.fresh(), 0u);
  ramp.add(1);
  EXPECT_EQ(ramp.record.count(), 0u);
  ramp.add(1);
  EXPECT_EQ(ramp.record.count(), 1u);
}

}  // namespace
}  // namespace virtual_work_dynamics
