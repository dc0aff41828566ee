#include "motion/root_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tumbling_roots.h"

namespace virtual_work_dynamics {
namespace {

using Verdict = RootEstimator::Verdict;

constexpr std::int64_t kStart = 1600000000123456789;
constexpr std::int64_t kMs = 1000000;
constexpr std::int64_t kTimeout = 100 * kMs;
constexpr double kLag = 0.05;

std::int64_t stampAt(double t) {
  return kStart + std::llround(t * 1e9);
}

/// How poses are measured.
struct Sensor {
  double rate = 200;          // Hz
  double position_noise = 0;  // m
  double angle_noise = 0;     // rad, about each axis
  double jitter = 0;          // standard deviation of stamps, s
  double twist_noise = -1;    // m/s and rad/s; negative: no twists
  bool signs_change = false;  // of the quaternions, at random
};

RootPose measured(const RootMotion& truth, double stamp, const Sensor& sensor,
                  std::mt19937& generator) {
  std::normal_distribution<double> normal;
  const auto noise = [&](double size) {
    const double x = size * normal(generator), y = size * normal(generator);
    return Eigen::Vector3d(x, y, size * normal(generator));
  };
  RootPose pose;
  pose.stamp_ns = stampAt(stamp);
  pose.position = truth.position + noise(sensor.position_noise);
  const Eigen::Vector3d turn = noise(sensor.angle_noise);
  pose.orientation = truth.orientation * Eigen::AngleAxisd(turn.norm(), turn.stableNormalized());
  if (turn.isZero()) pose.orientation = truth.orientation;
  if (sensor.signs_change && generator() % 2 == 0) pose.orientation.coeffs() *= -1;
  if (sensor.twist_noise >= 0) {
    pose.velocity = truth.velocity + noise(sensor.twist_noise);
    pose.angular_velocity = truth.angular_velocity + noise(sensor.twist_noise);
  }
  return pose;
}

/// Root mean squares of errors of what results depend on.
struct Errors {
  double attitude = 0, rate = 0, angular = 0, linear = 0;
  double worst_angular = 0;
  int count = 0;
};

/// Feeds poses from 0 to `duration`, and reads at 500 instants per second, a lag behind the newest.
Errors follow(const std::function<RootMotion(double)>& root, const Sensor& sensor, double from,
              double duration, unsigned seed = 1) {
  RootEstimator estimator(EstimatorSettings(), kTimeout);
  std::mt19937 generator(seed), clock(seed + 1);
  std::normal_distribution<double> normal;
  Errors errors;
  double next = from;
  for (int i = 0; i / sensor.rate < duration; ++i) {
    const double t = i / sensor.rate;
    estimator.push(measured(root(t), t + sensor.jitter * normal(clock), sensor, generator));
    for (; next <= t - kLag; next += 0.002) {
      RootMotion found;
      if (!estimator.read(stampAt(next), found)) {
        ADD_FAILURE() << "at " << next;
        return errors;
      }
      const RootMotion truth = root(next);
      const double angular = (found.angular_acceleration - truth.angular_acceleration).norm();
      errors.attitude += std::pow(angleBetween(found, truth), 2);
      errors.rate += (found.angular_velocity - truth.angular_velocity).squaredNorm();
      errors.angular += angular * angular;
      errors.linear += (found.acceleration - truth.acceleration).squaredNorm();
      errors.worst_angular = std::max(errors.worst_angular, angular);
      ++errors.count;
    }
  }
  for (double* sum : {&errors.attitude, &errors.rate, &errors.angular, &errors.linear}) {
    *sum = std::sqrt(*sum / errors.count);
  }
  return errors;
}

std::function<RootMotion(double)> tumbling(const Eigen::Vector3d& start = {0.4, 0.2, -0.3},
                                           double speed = 1) {
  return [root = TumblingRoot{start, speed}](double t) { return root.at(t); };
}

const Sensor kExact{200};
const Sensor kNoisy{200, 1e-4, 1e-4};

// Angles about z, y, x at first: the motion is led through other attitudes, half a radian off and
// in gimbal lock among them.
const std::vector<Eigen::Vector3d> kStarts{{0.4, 0.2, -0.3},
                                           {0.9, 0.2, -0.3},
                                           {2, -1.1, 0.5},
                                           {-1.3, 1.5707963267948966, 2.1},
                                           {3, 0.1, -3}};

TEST(RootEstimator, ExactPosesGiveTheMotionAtEveryAttitude) {
  for (const Eigen::Vector3d& start : kStarts) {
    const Errors errors = follow(tumbling(start), kExact, 1, 8);
    EXPECT_GT(errors.count, 3400);
    // What a motion of some tens of rad/s^4 leaves in 5 ms: measured 2e-11, 1.2e-8 and 1.2e-5.
    EXPECT_LT(errors.attitude, 1e-10);
    EXPECT_LT(errors.rate, 1e-7);
    EXPECT_LT(errors.angular, 1e-4);
    EXPECT_LT(errors.worst_angular, 2e-3);
    EXPECT_LT(errors.linear, 1e-4);
  }
}

TEST(RootEstimator, NoisyPosesAreSmoothedAlikeAtEveryAttitude) {
  for (const Eigen::Vector3d& start : kStarts) {
    const Errors errors = follow(tumbling(start), kNoisy, 1, 8);
    EXPECT_LT(errors.attitude, 1e-4);  // of poses that are off by 1.7e-4
    EXPECT_LT(errors.rate, 2e-3);
    EXPECT_LT(errors.angular, 0.06);
    EXPECT_LT(errors.worst_angular, 0.3);
    // Three coordinates of the same noise.
    EXPECT_LT(errors.angular, 1.5 * errors.linear);
  }
}

TEST(RootEstimator, RatesCountByTheirOwnNoise) {
  Sensor with_twists = kNoisy;
  with_twists.twist_noise = 1e-3;
  const Errors without = follow(tumbling(), kNoisy, 2, 8);
  const Errors with = follow(tumbling(), with_twists, 2, 8);
  EXPECT_LT(with.angular, without.angular / 2);
  EXPECT_LT(with.linear, without.linear / 2);
}

TEST(RootEstimator, SignsOfQuaternionsDoNotMatter) {
  Sensor signs = kExact;
  signs.signs_change = true;
  const Errors as_they_come = follow(tumbling(), signs, 1, 6);
  EXPECT_LT(as_they_come.angular, 1e-4);
}

TEST(RootEstimator, StampsMayJitter) {
  Sensor jitters{50};
  jitters.jitter = 2e-4;
  const Errors errors = follow(tumbling(), jitters, 2, 8);
  EXPECT_LT(errors.angular, 0.2);
  EXPECT_LT(errors.linear, 0.2);
}

// Where a robot rests in axes of the inertial frame, and then sets off.
TEST(RootEstimator, ARootThatSetsOffIsFollowed) {
  const auto root = [](double t) {
    const double begun = std::max(0.0, t - 3), end = 1 - std::cos(2 * begun);
    CarrierAngles turn;
    turn.angles << 0.8 * end, 0, 0.5 * end;
    turn.rates << 1.6 * std::sin(2 * begun), 0, std::sin(2 * begun);
    turn.accelerations << 3.2 * std::cos(2 * begun), 0, 2 * std::cos(2 * begun);
    if (t < 3) turn.accelerations.setZero();
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    return turn.root(none, none, none);
  };
  const Errors rests = follow(root, kNoisy, 1, 2.9);
  EXPECT_LT(rests.angular, 2 * rests.linear);
  const Errors moves = follow(root, kNoisy, 3.5, 8);
  EXPECT_LT(moves.angular, 0.1);
}

RootPose at(std::int64_t stamp_ns) {
  std::mt19937 generator(1);
  const double t = static_cast<double>(stamp_ns - kStart) / 1e9;
  return measured(TumblingRoot().at(t), t, kExact, generator);
}

TEST(RootEstimator, NeedsFourPoses) {
  RootEstimator estimator(EstimatorSettings(), kTimeout);
  RootMotion motion;
  EXPECT_TRUE(estimator.empty());
  EXPECT_FALSE(estimator.read(kStart, motion));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(estimator.push(at(kStart + 10 * i * kMs)), Verdict::kAccepted);
    EXPECT_FALSE(estimator.read(kStart + 10 * kMs, motion));
  }
  estimator.push(at(kStart + 30 * kMs));
  EXPECT_TRUE(estimator.read(kStart + 10 * kMs, motion));
  EXPECT_EQ(estimator.first(), kStart);
  EXPECT_EQ(estimator.last(), kStart + 30 * kMs);
  EXPECT_FALSE(estimator.read(kStart - 1, motion));
}

TEST(RootEstimator, ForeseesUpToTheTimeout) {
  RootEstimator estimator(EstimatorSettings(), kTimeout);
  for (int i = 0; i <= 100; ++i) estimator.push(at(kStart + 10 * i * kMs));
  RootMotion motion;
  EXPECT_TRUE(estimator.read(kStart + 1000 * kMs, motion));
  EXPECT_FALSE(estimator.foreseen());
  ASSERT_TRUE(estimator.read(kStart + 1100 * kMs, motion));
  EXPECT_TRUE(estimator.foreseen());
  EXPECT_LT(angleBetween(motion, TumblingRoot().at(1.1)), 0.01);
  EXPECT_FALSE(estimator.read(kStart + 1100 * kMs + 1, motion));
}

TEST(RootEstimator, AssumesNothingAcrossGaps) {
  RootEstimator estimator(EstimatorSettings(), kTimeout);
  for (int i = 0; i < 20; ++i) estimator.push(at(kStart + 10 * i * kMs));
  EXPECT_EQ(estimator.push(at(kStart + 500 * kMs)), Verdict::kAfterGap);
  EXPECT_DOUBLE_EQ(estimator.interval(), 0.31);
  for (int i = 1; i < 20; ++i) estimator.push(at(kStart + (500 + 10 * i) * kMs));
  RootMotion motion;
  EXPECT_TRUE(estimator.read(kStart + 250 * kMs, motion));
  EXPECT_FALSE(estimator.read(kStart + 400 * kMs, motion));
  EXPECT_TRUE(estimator.read(kStart + 500 * kMs, motion));
}

TEST(RootEstimator, PosesTooFarApartGiveNoAccelerations) {
  RootEstimator estimator(EstimatorSettings(), kTimeout);
  RootMotion motion;
  for (int i = 0; i < 20; ++i) {
    estimator.push(at(kStart + 300 * i * kMs));
    EXPECT_FALSE(estimator.read(kStart + 300 * i * kMs, motion));
  }
}

TEST(RootEstimator, PosesOutOfOrderTakeTheirPlaceOrAreNamed) {
  RootEstimator estimator(EstimatorSettings(), kTimeout);
  for (int i = 0; i < 50; ++i) {
    if (i != 40) estimator.push(at(kStart + 10 * i * kMs));
  }
  EXPECT_EQ(estimator.push(at(kStart + 400 * kMs)), Verdict::kReordered);
  EXPECT_EQ(estimator.push(at(kStart + 400 * kMs)), Verdict::kEqualStamp);
  RootEstimator early(EstimatorSettings(), kTimeout);
  for (int i = 0; i < 5; ++i) early.push(at(kStart + 10 * i * kMs));
  EXPECT_EQ(early.push(at(kStart - 10 * kMs)), Verdict::kTooLate);
  for (int i = 0; i < 9; ++i) early.push(at(kStart - (20 + i) * kMs));
  EXPECT_EQ(early.push(at(kStart - 50 * kMs)), Verdict::kRestartedBack);
  EXPECT_EQ(early.last(), kStart - 50 * kMs);
}

TEST(RootEstimator, StartsAnewWhenTimeGoesBack) {
  RootEstimator estimator(EstimatorSettings(), kTimeout);
  for (int i = 0; i < 100; ++i) estimator.push(at(kStart + 10 * i * kMs));
  EXPECT_EQ(estimator.push(at(kStart)), Verdict::kRestartedBack);
  RootMotion motion;
  EXPECT_FALSE(estimator.read(kStart + 500 * kMs, motion));
  for (int i = 1; i < 100; ++i)
    EXPECT_EQ(estimator.push(at(kStart + 10 * i * kMs)), Verdict::kAccepted);
  ASSERT_TRUE(estimator.read(kStart + 500 * kMs, motion));
  EXPECT_LT(angleBetween(motion, TumblingRoot().at(0.5)), 1e-6);
}

TEST(RootEstimator, TakesPosesAsTheyComeWhereNothingIsEstimated) {
  EstimatorSettings settings;
  settings.estimate = false;
  RootEstimator estimator(settings, kTimeout);
  RootPose pose = at(kStart);
  estimator.push(pose);
  RootMotion motion;
  ASSERT_TRUE(estimator.read(kStart + kTimeout, motion));
  EXPECT_LT(pose.orientation.angularDistance(motion.orientation), 1e-7);
  EXPECT_EQ(motion.angular_velocity, Eigen::Vector3d::Zero());
  EXPECT_EQ(motion.acceleration, Eigen::Vector3d::Zero());
  EXPECT_FALSE(estimator.read(kStart + kTimeout + 1, motion));
  pose.stamp_ns += kMs;
  pose.velocity << 1, 2, 3;
  pose.angular_velocity << 3, 2, 1;
  estimator.push(pose);
  ASSERT_TRUE(estimator.read(pose.stamp_ns, motion));
  EXPECT_LT((motion.angular_velocity - pose.angular_velocity).norm(), 1e-14);
  EXPECT_EQ(motion.angular_acceleration, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace virtual_work_dynamics
