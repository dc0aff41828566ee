#include "ros/trajectory_queue.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace virtual_work_dynamics {
namespace {

using Clock = TrajectoryQueue::Clock;
using std::chrono::milliseconds;
using Stamps = std::vector<std::int64_t>;

constexpr double kRate = 1000;  // points/s
constexpr milliseconds kHeldUp{15};

class TrajectoryQueues : public testing::Test {
 protected:
  void add(Stamps stamps) {
    TrajectoryMotion trajectory;
    trajectory.stamps_ns = std::move(stamps);
    queue.add(std::move(trajectory), now);
  }

  /// Stamps of the points that are due.
  Stamps play() {
    Stamps played;
    queue.playDue(now, [&](const TrajectoryMotion& trajectory, std::size_t point) {
      played.push_back(trajectory.stamps_ns.at(point));
    });
    return played;
  }

  TrajectoryQueue queue{kRate};
  Clock::time_point now{std::chrono::seconds(1)};
};

TEST_F(TrajectoryQueues, PlayPointsOneAfterTheOther) {
  add({1, 2, 3});
  EXPECT_EQ(queue.waiting(), 3u);
  EXPECT_EQ(play(), Stamps{1});
  EXPECT_EQ(play(), Stamps());
  now += milliseconds(1);
  EXPECT_EQ(play(), Stamps{2});
  add({4});
  EXPECT_EQ(queue.waiting(), 2u);
  now += milliseconds(2);
  EXPECT_EQ(play(), (Stamps{3, 4}));
  EXPECT_TRUE(queue.empty());
}

// More points are due than exist.
TEST_F(TrajectoryQueues, EndWithTheLastPointHoweverLate) {
  add({1, 2, 3});
  add({});
  add({4, 5});
  EXPECT_EQ(play(), Stamps{1});
  now += kHeldUp;
  EXPECT_EQ(play(), (Stamps{2, 3, 4, 5}));
  EXPECT_EQ(queue.waiting(), 0u);
  EXPECT_TRUE(queue.empty());
  now += kHeldUp;
  EXPECT_EQ(play(), Stamps());
  add({6, 7});
  EXPECT_EQ(play(), Stamps{6});
}

// Two points a second apart, sampled at 4 Hz.
TEST_F(TrajectoryQueues, PlaySamplesWhereThereAreSome) {
  MotionTable points;
  points.times = {0, 1};
  points.positions = Eigen::MatrixXd::Zero(2, 1);
  TrajectoryMotion trajectory;
  trajectory.stamps_ns = {10, 1000000010};
  trajectory.samples.emplace(TrajectoryCurve(points), 4, 10);
  queue.add(std::move(trajectory), now);
  EXPECT_EQ(queue.waiting(), 5u);
  now += kHeldUp;
  Stamps stamps;
  queue.playDue(now, [&](const TrajectoryMotion& played, std::size_t sample) {
    stamps.push_back(played.samples->stampNs(sample));
  });
  EXPECT_EQ(stamps, (Stamps{10, 250000010, 500000010, 750000010, 1000000010}));
  EXPECT_TRUE(queue.empty());
}

TEST_F(TrajectoryQueues, DoNotCatchUpInABurst) {
  add(Stamps(100, 0));
  now += std::chrono::seconds(1);
  EXPECT_EQ(play().size(), static_cast<std::size_t>(TrajectoryQueue::kMostAtOnce));
  EXPECT_LE(play().size(), 1u);
}

}  // namespace
}  // namespace virtual_work_dynamics
