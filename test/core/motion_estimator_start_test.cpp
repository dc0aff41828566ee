// What the estimator gives before it has learnt the noises of a stream, at its beginning and after
// a jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "joint_state_stream.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {
namespace {

using namespace estimator_test;

constexpr double kSecond = 1e-9;  // of a time in ns

// Errors as parts of the amplitudes of position, velocity and acceleration: 1.1e-5 at the first
// instant, and 5.2e-6 after 0.1 s.
TEST(MotionEstimator, StartsOnAnExactSine) {
  constexpr double kFromTheFirst = 1e-3;
  constexpr double kAfterATenth = 1e-5;
  constexpr double kW = 3;  // rad/s
  Stream stream({kR}, settingsOf(0.05));
  std::int64_t first = -1;
  for (int i = 0; i < 100; ++i) {
    const std::int64_t time = 10 * kMillisecond * i;
    stream.push(time, {0}, {std::sin(kW * kSecond * static_cast<double>(time))});
    while (stream.estimator.ready()) {
      const std::int64_t instant = stream.evaluate();
      if (first < 0) first = instant;
      const double t = kSecond * static_cast<double>(instant);
      const double tolerance = instant < 100 * kMillisecond ? kFromTheFirst : kAfterATenth;
      EXPECT_NEAR(stream.motion.q[0], std::sin(kW * t), tolerance) << t;
      EXPECT_NEAR(stream.motion.qd[0] / kW, std::cos(kW * t), tolerance) << t;
      EXPECT_NEAR(stream.motion.qdd[0] / (kW * kW), -std::sin(kW * t), tolerance) << t;
    }
  }
  EXPECT_EQ(first, 0);
}

/// Largest acceleration, rad/s^2, from 0.1 s to 1 s that a joint at rest seems to have whose
/// positions have white noise of three quanta of 1e-5 rad; the largest of 20 streams.
double largestAcceleration(double rate, double lag) {
  constexpr double kQuantum = 1e-5;
  double most = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> quanta(0, 3);
    Stream stream({kR}, settingsOf(lag));
    for (int i = 0; i < (1 + lag) * rate; ++i) {
      const double q = kQuantum * std::round(quanta(generator));
      stream.push(std::llround(1e9 * i / rate), {0}, {q});
      while (stream.estimator.ready()) {
        const bool settled = stream.evaluate() >= 100 * kMillisecond;
        if (settled) most = std::max(most, std::abs(stream.motion.qdd[0]));
      }
    }
  }
  return most;
}

// Bounds are 1.5 times what was found. Without the noise that differences show, the estimator
// follows the noise until it has learnt better: 0.74, 4.0, 0.70 and 128 rad/s^2.
TEST(MotionEstimator, DoesNotTakeWhiteNoiseForAccelerationInTheFirstSecond) {
  EXPECT_LT(largestAcceleration(125, 0.05), 1.5 * 0.11);
  EXPECT_LT(largestAcceleration(125, 0), 1.5 * 0.60);
  EXPECT_LT(largestAcceleration(1000, 0.05), 1.5 * 0.089);
  EXPECT_LT(largestAcceleration(1000, 0), 1.5 * 0.83);
}

// As for two motions that have nothing to do with each other.
TEST(MotionEstimator, BeginsAnotherMotionAfterAJump) {
  constexpr double kTolerance = 1e-9;     // rad, rad/s
  constexpr double kAcceleration = 1e-7;  // rad/s^2; 1.3e-9 was found
  constexpr int kJumpAt = 600;            // samples: by then the noise is learnt
  constexpr double kJump = 0.5;           // rad
  constexpr double kSpeed = 0.7;          // rad/s
  for (const std::int64_t interval : {kMillisecond, 8 * kMillisecond})
    for (const double lag : {0.0, 0.01, 0.05})
      for (const double sign : {1, -1}) {
        Stream stream({kR}, settingsOf(lag));
        int motions = 0;
        for (int i = 0; i < kJumpAt + 1000; ++i) {
          const auto positionAt = [&](std::int64_t time) {
            return kSpeed * kSecond * static_cast<double>(time) +
                   (time >= kJumpAt * interval ? sign * kJump : 0);
          };
          stream.push(i * interval, {0}, {positionAt(i * interval)});
          while (stream.estimator.ready()) {
            const std::int64_t instant = stream.evaluate();
            ++motions;
            EXPECT_NEAR(stream.motion.q[0], positionAt(instant), kTolerance) << instant;
            EXPECT_NEAR(stream.motion.qd[0], kSpeed, kTolerance) << instant;
            EXPECT_NEAR(stream.motion.qdd[0], 0, kAcceleration) << instant;
          }
        }
        EXPECT_GT(motions, 1500);
      }
}

}  // namespace
}  // namespace virtual_work_dynamics
