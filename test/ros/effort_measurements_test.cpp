#include "ros/effort_measurements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kMs = 1000000;
constexpr double kMaxGap = 0.25;  // s

/// Measurements of two joints, each of which a driver of its own tells.
class EffortMeasurement : public testing::Test {
 protected:
  void take(std::int64_t stamp_ns, int coordinate, double q, double qd, double effort) {
    JointSample sample;
    sample.stamp_ns = stamp_ns;
    sample.count = 1;
    sample.coordinates = &coordinate;
    sample.q = &q;
    sample.qd = &qd;
    sample.effort = &effort;
    measurements->take(sample);
  }

  std::shared_ptr<EffortMeasurements> measurements =
      std::make_shared<EffortMeasurements>(std::vector<std::string>{"elbow", "finger"}, kMaxGap);
  EffortMeasurements::User user{measurements};
  std::int64_t now = 0;
};

TEST_F(EffortMeasurement, TakesEachDriverByItsOwnStamps) {
  for (std::int64_t i = 0; i < 10; ++i) {
    const auto value = static_cast<double>(i);
    take(10 * i * kMs, 0, 1 + value, 2, 3 + value);
    take(10 * i * kMs, 1, 4 + value, 5, 6 + value);  // not newer than that of the other driver
  }
  take(95 * kMs, 0, 20, 2, 30);
  take(92 * kMs, 1, 40, 5, 60);  // older than that of the other driver
  const EffortMeasurements::Latest& latest = measurements->latest();
  EXPECT_EQ(latest.stamp_ns, 95 * kMs);
  EXPECT_EQ(latest.stamps_ns, (std::vector<std::int64_t>{95 * kMs, 92 * kMs}));
  EXPECT_EQ(latest.q, (std::vector<double>{20, 40}));
  EXPECT_EQ(latest.effort, (std::vector<double>{30, 60}));
  EXPECT_EQ(measurements->at(0, 15 * kMs), 4.5);
  EXPECT_EQ(measurements->at(1, 15 * kMs), 7.5);
  EXPECT_EQ(measurements->at(1, 92 * kMs), 60);
}

TEST_F(EffortMeasurement, KeepsTheNewestOfAJointWhereOneComesLate) {
  take(10 * kMs, 0, 1, 2, 3);
  take(8 * kMs, 0, 4, 5, 6);
  EXPECT_EQ(measurements->latest().q[0], 1);
  EXPECT_EQ(measurements->latest().effort[0], 3);
  EXPECT_EQ(measurements->at(0, 10 * kMs), 3);
  EXPECT_TRUE(std::isnan(measurements->at(0, 9 * kMs)));
}

TEST_F(EffortMeasurement, ForgetsWhatWasMeasuredWhereTimeWentBack) {
  measurements->setRest(1, 0.4);
  take(1000 * kMs, 0, 1, 2, 3);
  take(1000 * kMs, 1, 4, 5, 6);
  measurements->restart();
  const EffortMeasurements::Latest& latest = measurements->latest();
  EXPECT_EQ(latest.stamp_ns, EffortMeasurements::kNever);
  EXPECT_TRUE(std::isnan(measurements->at(0, 1000 * kMs)));
  take(990 * kMs, 0, 7, 8, 9);  // less than the longest gap before
  EXPECT_EQ(latest.stamp_ns, 990 * kMs);
  EXPECT_EQ(latest.q, (std::vector<double>{7, 0.4}));
  EXPECT_EQ(measurements->at(0, 990 * kMs), 9);
}

TEST_F(EffortMeasurement, LetsAJointRestUntilItComes) {
  measurements->setRest(1, 0.4);
  const EffortMeasurements::Latest& latest = measurements->latest();
  take(10 * kMs, 0, 1, 2, 3);
  EXPECT_EQ(latest.q[1], 0.4);
  EXPECT_EQ(latest.qd[1], 0);
  EXPECT_TRUE(std::isnan(latest.effort[1]));
  take(12 * kMs, 1, 7, 8, 9);
  EXPECT_EQ(latest.q[1], 7);
  EXPECT_EQ(latest.qd[1], 8);
}

TEST_F(EffortMeasurement, NamesOnceWhatAnObserverLacks) {
  const auto takeMany = [&] {
    std::vector<std::string> news;
    for (int i = 0; i < 200; ++i) {
      now += kMs;
      take(now, 0, 1, 2, 3);
      if (const auto text = measurements->news()) news.push_back(*text);
    }
    return news;
  };
  EXPECT_TRUE(takeMany().empty());  // the residual of a joint that never comes is not asked for
  const EffortMeasurements::User observer(measurements, true);
  const std::vector<std::string> news = takeMany();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_NE(news[0].find("no position or no velocity of 'finger'"), std::string::npos) << news[0];
  EXPECT_TRUE(takeMany().empty());
}

TEST_F(EffortMeasurement, HasNothingToSayToAnObserverOfAJointAtRest) {
  measurements->setRest(1, 0.4);
  const EffortMeasurements::User observer(measurements, true);
  for (int i = 1; i <= 200; ++i) {
    take(i * kMs, 0, 1, 2, 3);
    EXPECT_FALSE(measurements->news());
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
