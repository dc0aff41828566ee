#include "dynamics/wrench_history.h"

#include <gtest/gtest.h>

namespace virtual_work_dynamics {
namespace {

using Verdict = WrenchHistory::Verdict;

constexpr std::int64_t kMs = 1000000;

MeasuredWrench at(std::int64_t stamp_ns, double force = 0) {
  MeasuredWrench wrench;
  wrench.stamp_ns = stamp_ns;
  wrench.value.force.x() = force;
  return wrench;
}

TEST(WrenchHistory, FindsTheMeasurementsOnBothSides) {
  WrenchHistory history(100 * kMs);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(history.push(at(10 * i * kMs, i)), Verdict::kTaken);
  const WrenchHistory::Reading between = history.read(73 * kMs);
  ASSERT_TRUE(between.before && between.after);
  EXPECT_EQ(between.before->value.force.x(), 7);
  EXPECT_EQ(between.after->value.force.x(), 8);
  EXPECT_DOUBLE_EQ(between.share, 0.3);
  EXPECT_FALSE(between.held);
  const WrenchHistory::Reading on = history.read(50 * kMs);
  EXPECT_EQ(on.before->value.force.x(), 5);
  EXPECT_EQ(on.share, 0);
}

TEST(WrenchHistory, HoldsTheNewestUpToTheTimeout) {
  WrenchHistory history(100 * kMs);
  EXPECT_EQ(history.read(0).before, nullptr);
  history.push(at(10 * kMs, 3));
  EXPECT_EQ(history.read(10 * kMs - 1).before, nullptr);
  EXPECT_FALSE(history.read(10 * kMs).held);
  const WrenchHistory::Reading last = history.read(110 * kMs);
  ASSERT_TRUE(last.before);
  EXPECT_EQ(last.before->value.force.x(), 3);
  EXPECT_EQ(last.after, nullptr);
  EXPECT_TRUE(last.held);
  EXPECT_EQ(history.read(110 * kMs + 1).before, nullptr);
}

TEST(WrenchHistory, InterpolatesNoGap) {
  WrenchHistory history(100 * kMs);
  history.push(at(0, 1));
  history.push(at(100 * kMs, 2));
  history.push(at(200 * kMs + 1, 3));
  EXPECT_TRUE(history.read(99 * kMs).after);
  const WrenchHistory::Reading held = history.read(150 * kMs);
  ASSERT_TRUE(held.before);
  EXPECT_EQ(held.after, nullptr);
  EXPECT_TRUE(held.held);
  history.push(at(400 * kMs, 4));
  EXPECT_EQ(history.read(301 * kMs).before, nullptr);
}

TEST(WrenchHistory, RefusesWhatIsNotNewerUnlessTimeWentBack) {
  WrenchHistory history(100 * kMs);
  history.push(at(500 * kMs, 1));
  EXPECT_EQ(history.push(at(500 * kMs, 2)), Verdict::kEqualStamp);
  EXPECT_EQ(history.push(at(400 * kMs, 2)), Verdict::kTooLate);
  EXPECT_EQ(history.read(500 * kMs).before->value.force.x(), 1);
  EXPECT_EQ(history.push(at(400 * kMs - 1, 3)), Verdict::kTaken);
  EXPECT_EQ(history.size(), 1u);
  EXPECT_EQ(history.read(420 * kMs).before->value.force.x(), 3);
}

TEST(WrenchHistory, KeepsTheLatest) {
  WrenchHistory history(100 * kMs);
  const auto count = static_cast<std::int64_t>(WrenchHistory::kMost) + 100;
  for (std::int64_t i = 0; i < count; ++i) history.push(at(i * kMs, static_cast<double>(i)));
  const WrenchHistory::Reading oldest = history.read(100 * kMs);
  const WrenchHistory::Reading forgotten = history.read(100 * kMs - 1);
  const WrenchHistory::Reading newest = history.read((count - 1) * kMs);
  EXPECT_EQ(history.size(), WrenchHistory::kMost);
  EXPECT_EQ(oldest.before->value.force.x(), 100);
  EXPECT_EQ(forgotten.before, nullptr);
  EXPECT_EQ(newest.before->value.force.x(), static_cast<double>(count - 1));
}

}  // namespace
}  // namespace virtual_work_dynamics
