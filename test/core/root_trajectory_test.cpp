#include "motion/root_trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tumbling_roots.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kStart = 1600000000123456789;
constexpr std::int64_t kMs = 1000000;
constexpr double kRounding = 1e-13;

std::int64_t stampAt(double t) {
  return kStart + std::llround(t * 1e9);
}

// Drivers may turn a quaternion's sign as they like.
std::vector<RootPoint> points(const TumblingRoot& root, double from, double step, int count) {
  std::vector<RootPoint> made;
  for (int i = 0; i < count; ++i)
    made.push_back({stampAt(from + i * step), root.at(from + i * step)});
  for (std::size_t i = 0; i < made.size(); i += 3) made[i].motion.orientation.coeffs() *= -1;
  return made;
}

/// The largest error of accelerations, m/s^2 and rad/s^2, and of other parts, in [from, to].
struct Error {
  double accelerations = 0, others = 0;
};
Error errorOf(RootTrajectory& trajectory, const TumblingRoot& root, double from, double to) {
  Error error;
  for (double t = from; t < to; t += 0.0071) {
    RootMotion found;
    EXPECT_TRUE(trajectory.read(stampAt(t), found)) << t;
    const RootMotion wanted = root.at(static_cast<double>(stampAt(t) - kStart) / 1e9);
    error.accelerations =
        std::max({error.accelerations, (found.acceleration - wanted.acceleration).norm(),
                  (found.angular_acceleration - wanted.angular_acceleration).norm()});
    error.others = std::max({error.others, angleBetween(found, wanted),
                             (found.position - wanted.position).norm(),
                             (found.velocity - wanted.velocity).norm(),
                             (found.angular_velocity - wanted.angular_velocity).norm()});
  }
  return error;
}

TEST(RootTrajectory, IsExactAtItsPoints) {
  const TumblingRoot root;
  RootTrajectory trajectory(100 * kMs);
  const std::vector<RootPoint> given = points(root, 0, 0.25, 41);
  trajectory.take(given);
  EXPECT_EQ(trajectory.first(), kStart);
  EXPECT_EQ(trajectory.last(), stampAt(10));
  for (const RootPoint& point : given) {
    RootMotion found;
    ASSERT_TRUE(trajectory.read(point.stamp_ns, found));
    EXPECT_FALSE(trajectory.foreseen());
    EXPECT_LT(angleBetween(found, point.motion), kRounding);
    EXPECT_LT((found.angular_velocity - point.motion.angular_velocity).norm(), kRounding);
    EXPECT_LT((found.angular_acceleration - point.motion.angular_acceleration).norm(),
              20 * kRounding);
    EXPECT_LT((found.acceleration - point.motion.acceleration).norm(), kRounding);
  }
}

// Quintics: accelerations of fourth order in the time from point to point, all else of fifth.
TEST(RootTrajectory, IsCloseBetweenThem) {
  const TumblingRoot root;
  std::vector<Error> errors;
  for (const double step : {0.1, 0.05, 0.025}) {
    RootTrajectory trajectory(100 * kMs);
    trajectory.take(points(root, 0, step, static_cast<int>(8 / step) + 1));
    errors.push_back(errorOf(trajectory, root, 0, 8));
  }
  EXPECT_LT(errors[0].accelerations, 5e-3);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_NEAR(errors[i - 1].accelerations / errors[i].accelerations, 16, 3);
    EXPECT_NEAR(errors[i - 1].others / errors[i].others, 32, 8);
  }
}

TEST(RootTrajectory, MessagesOfOnePointAreJoined) {
  const TumblingRoot root;
  RootTrajectory trajectory(100 * kMs);
  for (double t = 0; t < 2; t += 0.02) trajectory.take({{stampAt(t), root.at(t)}});
  EXPECT_LT(errorOf(trajectory, root, 0, 1.98).accelerations, 1e-4);
}

TEST(RootTrajectory, GoesOnForATimeBehindItsEnd) {
  RootTrajectory trajectory(100 * kMs);
  RootMotion end;
  end.orientation = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX());
  end.angular_velocity << 0, 0, 2;
  end.acceleration << 1, 2, 3;
  trajectory.take({{kStart, end}});
  RootMotion found;
  EXPECT_FALSE(trajectory.read(kStart - 1, found));
  ASSERT_TRUE(trajectory.read(kStart + 100 * kMs, found));
  EXPECT_TRUE(trajectory.foreseen());
  EXPECT_EQ(found.acceleration, end.acceleration);
  RootMotion turned = end;
  turned.orientation = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) * end.orientation;
  EXPECT_LT(angleBetween(found, turned), 1e-3);  // the cube of a tenth of a radian
  EXPECT_FALSE(trajectory.read(kStart + 100 * kMs + 1, found));
  ASSERT_TRUE(trajectory.read(kStart, found));
  EXPECT_FALSE(trajectory.foreseen());
}

TEST(RootTrajectory, TwoFarApartAreNotJoined) {
  const TumblingRoot root;
  RootTrajectory trajectory(100 * kMs);
  trajectory.take(points(root, 0, 0.5, 2));
  trajectory.take(points(root, 0.7, 0.5, 2));
  RootMotion found;
  EXPECT_TRUE(trajectory.read(stampAt(0.25), found));  // between points of one trajectory
  EXPECT_TRUE(trajectory.read(stampAt(0.6), found));
  EXPECT_TRUE(trajectory.foreseen());
  EXPECT_FALSE(trajectory.read(stampAt(0.65), found));
  EXPECT_TRUE(trajectory.read(stampAt(0.7), found));
  EXPECT_FALSE(trajectory.foreseen());
}

// A new trajectory holds from its first point on; the one before, up to there.
TEST(RootTrajectory, ANewOneReplacesWhatComesLater) {
  const TumblingRoot first, second{{1.4, -0.2, 0.8}, 1.3};
  RootTrajectory trajectory(100 * kMs);
  trajectory.take(points(first, 0, 0.05, 41));
  trajectory.take(points(second, 1.02, 0.05, 21));
  EXPECT_LT(errorOf(trajectory, first, 0, 1.02).accelerations, 1e-3);
  EXPECT_LT(errorOf(trajectory, second, 1.021, 2.02).accelerations, 5e-3);
  // As a looped bag does it.
  trajectory.take(points(first, 0, 0.05, 3));
  EXPECT_EQ(trajectory.last(), stampAt(0.1));
  RootMotion found;
  EXPECT_FALSE(trajectory.read(stampAt(1.5), found));
}

TEST(RootTrajectory, KeepsTheLatestPoints) {
  RootTrajectory trajectory(100 * kMs);
  for (std::size_t i = 0; i < RootTrajectory::kMost + 10; ++i) {
    trajectory.take({{kStart + static_cast<std::int64_t>(i) * kMs, RootMotion()}});
  }
  EXPECT_EQ(trajectory.first(), kStart + 10 * kMs);
}

}  // namespace
}  // namespace virtual_work_dynamics
