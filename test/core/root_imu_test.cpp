#include "motion/root_imu.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tumbling_roots.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kTimeout = 100000000;
constexpr double kLag = 0.05;
const Eigen::Vector3d kGravity(0.3, -0.2, -9.7);
const Eigen::Vector3d kAt(0.4, -0.3, 0.2);

// What the unit measures, by the second difference of the closed form of its own position.
ImuSample measured(const TumblingRoot& root, double t) {
  const auto place = [&](double at) {
    const RootMotion motion = root.at(at);
    return Eigen::Vector3d(motion.position + motion.orientation * kAt);
  };
  const double h = 1e-3;
  const Eigen::Vector3d acceleration =
      (16 * (place(t + h) + place(t - h)) - 30 * place(t) - (place(t + 2 * h) + place(t - 2 * h))) /
      (12 * h * h);
  const RootMotion motion = root.at(t);
  ImuSample sample;
  sample.stamp_ns = std::llround(t * 1e9);
  sample.angular_velocity = motion.orientation.conjugate() * motion.angular_velocity;
  sample.specific_force = motion.orientation.conjugate() * (acceleration - kGravity);
  sample.at = kAt;
  return sample;
}

struct Errors {
  double rate = 0, angular = 0, force = 0;
};

// Largest errors of what dynamics need, at a rate in Hz, with noises in rad/s and m/s^2.
Errors follow(double rate, double rate_noise, double force_noise) {
  const TumblingRoot root;
  RootImu imu(EstimatorSettings(), kTimeout, kGravity);
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  const auto noise = [&](double size) {
    const double x = size * normal(generator), y = size * normal(generator);
    return Eigen::Vector3d(x, y, size * normal(generator));
  };
  Errors errors;
  for (int i = 0; i < 6 * rate; ++i) {
    ImuSample sample = measured(root, i / rate);
    sample.angular_velocity += noise(rate_noise);
    sample.specific_force += noise(force_noise);
    imu.push(sample);
    const std::int64_t stamp = sample.stamp_ns - std::llround(kLag * 1e9);
    const double t = static_cast<double>(stamp) / 1e9;
    RootMotion found;
    if (t < 2) continue;
    EXPECT_TRUE(imu.read(stamp, found));
    const RootMotion truth = root.at(t);
    const RootState wanted(truth, kGravity, false), got(found, kGravity, false);
    errors.rate = std::max(errors.rate, (got.angular_velocity - wanted.angular_velocity).norm());
    errors.angular =
        std::max(errors.angular, (got.angular_acceleration - wanted.angular_acceleration).norm());
    errors.force = std::max(errors.force, (got.acceleration - wanted.acceleration).norm());
  }
  return errors;
}

TEST(RootImu, GivesWhatTheRecursionStartsFrom) {
  const Errors errors = follow(200, 0, 0);
  EXPECT_LT(errors.rate, 1e-6);
  EXPECT_LT(errors.angular, 1e-4);
  EXPECT_LT(errors.force, 1e-4);
}

TEST(RootImu, SmoothsNoise) {
  const Errors errors = follow(200, 2e-3, 0.02);
  EXPECT_LT(errors.rate, 0.004);
  EXPECT_LT(errors.angular, 0.1);
  EXPECT_LT(errors.force, 0.08);
}

TEST(RootImu, AtRestReadsGravityOnce) {
  RootImu imu(EstimatorSettings(), kTimeout, kGravity);
  RootMotion found;
  EXPECT_FALSE(imu.read(0, found));
  for (int i = 0; i < 20; ++i) {
    ImuSample sample;
    sample.stamp_ns = 5000000LL * i;
    sample.specific_force = -kGravity;
    sample.at = kAt;
    imu.push(sample);
  }
  ASSERT_TRUE(imu.read(50000000, found));
  EXPECT_LT(found.acceleration.norm(), 1e-12);
  EXPECT_EQ(found.angular_velocity.norm(), 0);
  EXPECT_FALSE(imu.foreseen());
  EXPECT_TRUE(imu.read(imu.last() + kTimeout, found));
  EXPECT_TRUE(imu.foreseen());
  EXPECT_FALSE(imu.read(imu.last() + kTimeout + 1, found));
}

}  // namespace
}  // namespace virtual_work_dynamics
