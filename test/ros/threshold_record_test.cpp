#include "ros/threshold_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kMs = 1000000;
constexpr double kMaxGap = 0.25;  // s
constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

TEST(ThresholdRecord, CountsWhatStaysBeyondForTheHoldTime) {
  ThresholdRecord record({"elbow", "wrist"}, {3, kNone}, 0.02, kMaxGap);
  record.record(0, {-4, 100});
  record.record(19 * kMs, {-6, 100});
  EXPECT_TRUE(record.take().empty());  // not long enough
  record.record(20 * kMs, {-5, 100});
  const auto found = record.take();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "elbow");
  EXPECT_EQ(found[0].threshold, 3);
  EXPECT_EQ(found[0].peak, -6);
  EXPECT_DOUBLE_EQ(found[0].seconds, 0.02);
  EXPECT_TRUE(record.take().empty());  // said once…
  record.record(21 * kMs, {-3.5, 100});
  const auto lasting = record.take();  // …and again while it lasts
  ASSERT_EQ(lasting.size(), 1U);
  EXPECT_EQ(lasting[0].peak, -3.5);
  EXPECT_DOUBLE_EQ(lasting[0].seconds, 0.021);
}

TEST(ThresholdRecord, BeginsAnewAfterEachInterruption) {
  ThresholdRecord record({"elbow"}, {3}, 0.02, kMaxGap);
  for (const double between : {3.0, kNotKnown}) {
    for (int i = 0; i < 10; ++i) {
      record.record(100 * i * kMs, {9});
      record.record((100 * i + 15) * kMs, {9});
      record.record((100 * i + 30) * kMs, {between});
    }
    EXPECT_TRUE(record.take().empty()) << between;
    record.record(-5 * kMs, {between});  // time goes back
  }
}

TEST(ThresholdRecord, HoldsAcrossNoLongGap) {
  ThresholdRecord record({"elbow"}, {3}, 0.02, kMaxGap);
  record.record(0, {9});
  record.record(251 * kMs, {9});
  record.record(270 * kMs, {9});
  EXPECT_TRUE(record.take().empty());
  record.record(271 * kMs, {8});
  const auto found = record.take();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_DOUBLE_EQ(found[0].seconds, 0.02);
}

TEST(ThresholdRecord, BeginsAnewWhereTimeGoesBackALittle) {
  ThresholdRecord record({"elbow"}, {3}, 0.02, kMaxGap);
  record.record(100 * kMs, {9});
  record.record(119 * kMs, {9});
  record.record(110 * kMs, {9});
  record.record(121 * kMs, {9});
  EXPECT_TRUE(record.take().empty());
  record.record(130 * kMs, {9});
  EXPECT_EQ(record.take().size(), 1U);
}

}  // namespace
}  // namespace virtual_work_dynamics
