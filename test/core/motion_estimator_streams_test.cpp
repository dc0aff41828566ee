#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "encoder_streams.h"
#include "estimated_streams.h"
#include "joint_state_stream.h"
#include "virtual_work_dynamics/motion_estimator.h"

// What encoders and drivers really send, and how well motions are estimated from it.

namespace virtual_work_dynamics {
namespace {

using encoder_streams::Encoder;
using encoder_streams::Moves;
using encoder_streams::sampled;
using encoder_streams::Samples;
using estimated_streams::encoderOf;
using estimated_streams::estimated;
using estimated_streams::Estimates;
using estimated_streams::kRise;
using estimated_streams::movesOf;
using estimator_test::kMillisecond;
using estimator_test::kR;
using estimator_test::settingsOf;
using estimator_test::Stream;
using Law = encoder_streams::Law;
using State = encoder_streams::State;

TEST(MotionEstimator, LateSamplesTakeTheirPlace) {
  const Encoder encoder = encoderOf(1000, 1e-4);
  const Samples samples = sampled(movesOf(2, 4, 6), encoder, 4, 4);
  const Estimates in_order = estimated(samples, {});
  for (const double part : {0.05, 0.5}) {
    std::mt19937 generator(8);
    std::uniform_real_distribution<double> chance(0, 1);
    std::vector<std::size_t> order(samples.rows());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
      if (chance(generator) < part) {
        std::swap(order[i], order[i + 1]);
        ++i;
      }
    const Estimates exchanged = estimated(samples, {}, order);
    EXPECT_GE(static_cast<double>(exchanged.rows.size()),
              0.98 * static_cast<double>(in_order.rows.size()));
    EXPECT_TRUE(std::is_sorted(exchanged.rows.begin(), exchanged.rows.end()));
    for (const std::size_t joint : {0, 1})
      EXPECT_LT(exchanged.error(samples, joint), 1.1 * in_order.error(samples, joint));
  }
}

// A finger beside a 500 Hz arm: every message of the arm gives one motion, without delay.
TEST(MotionEstimator, AJointAtAnotherRateHoldsUpNoOne) {
  const Law arm = Moves(7, 5, kRise);
  const Law finger = [](double t) {
    return State{0.02 + 0.01 * std::sin(2 * t), 0.02 * std::cos(2 * t), -0.04 * std::sin(2 * t)};
  };
  for (const double rate : {0.0, 1.0, 10.0}) {
    SCOPED_TRACE(std::to_string(rate) + " Hz");
    Stream stream({kR, kR}, {});
    if (rate == 0) stream.estimator.setRest(1, 0.02);
    const int every = rate > 0 ? static_cast<int>(500 / rate) : 1000000;
    std::int64_t latest = -1;
    int motions = 0;
    for (int i = 0; i < 2500; ++i) {
      const std::int64_t time = i * 2 * kMillisecond;
      const double t = 0.002 * i;
      if (rate > 0 && i % every == 0) {
        stream.push(time, {1}, {finger(t).q});
        latest = time;
      }
      stream.push(time, {0}, {1e-4 * std::round(1e4 * arm(t).q)});
      const double age = stream.estimator.age(1);
      if (rate > 0) {
        EXPECT_NEAR(age, static_cast<double>(time - latest) * 1e-9, 1e-12);
      } else {
        EXPECT_TRUE(std::isinf(age));
      }
      if (i == 499) motions = 0;
      while (stream.estimator.ready()) {
        const std::int64_t instant = stream.evaluate();
        ++motions;
        if (i < 500) continue;
        ASSERT_EQ(instant, time - 50 * kMillisecond);
        const double at = static_cast<double>(instant) * 1e-9;
        if (rate == 10) {
          ASSERT_FALSE(stream.estimator.held(1));
          ASSERT_NEAR(stream.motion.q[1], finger(at).q, 3e-4);
          ASSERT_NEAR(stream.motion.qd[1], finger(at).qd, 5e-3);
          continue;
        }
        ASSERT_TRUE(stream.estimator.held(1)) << at;
        ASSERT_EQ(stream.motion.qd[1], 0);
        ASSERT_EQ(stream.motion.qdd[1], 0);
        ASSERT_TRUE(stream.covariance.coordinates[1].isZero(0));
        const double before = std::floor(at + 1e-9);
        ASSERT_NEAR(stream.motion.q[1], rate == 0 ? 0.02 : finger(before).q, 1e-12) << at;
      }
    }
    EXPECT_EQ(motions, 2001);
    EXPECT_FALSE(stream.estimator.held(0));
  }
}

TEST(MotionEstimator, AJointThatGoesSilentIsHeldAfterAWhile) {
  EstimatorSettings settings = settingsOf(0.02);
  settings.hold_after = 0.1;
  Stream stream({kR, kR}, settings);
  const auto q = [](double t) { return std::sin(3 * t); };
  bool was_held = false;
  for (int i = 0; i < 4000; ++i) {
    const std::int64_t time = i * kMillisecond;
    stream.push(time, {0}, {0.5 * q(0.001 * i)});
    if (i <= 2000 || i >= 2800) stream.push(time, {1}, {q(0.001 * i)});
    while (stream.estimator.ready()) {
      const double t = static_cast<double>(stream.evaluate()) * 1e-9;
      EXPECT_FALSE(stream.estimator.held(0));
      const bool held = stream.estimator.held(1);
      was_held = was_held || held;
      ASSERT_EQ(held, t > 2.1 + 1e-9 && t < 2.8 - 1e-9) << t;
      if (t < 1) continue;
      if (held) {
        ASSERT_EQ(stream.motion.q[1], q(2)) << t;
        ASSERT_EQ(stream.motion.qd[1], 0);
      } else if (t <= 2 || t > 2.85) {
        ASSERT_NEAR(stream.motion.q[1], q(t), 1e-5) << t;
        ASSERT_NEAR(stream.motion.qd[1], 3 * std::cos(3 * t), 1e-3) << t;
      }
    }
  }
  EXPECT_TRUE(was_held);
}

// Before and behind a gap the motion is as if nothing were on its other side.
TEST(MotionEstimator, AFitNeverReachesAcrossAGap) {
  for (const double behind : {0.0, 1e3}) {
    Stream stream({kR}, {});
    const auto q = [](double t) { return std::sin(3 * t); };
    int near = 0;
    for (int i = 0; i < 3000; ++i) {
      if (i > 1500 && i < 1800) continue;
      stream.push(i * kMillisecond, {0},
                  {1e-4 * std::round(1e4 * q(0.001 * i)) + (i < 1700 ? 0 : behind)});
      while (stream.estimator.ready()) {
        const double t = static_cast<double>(stream.evaluate()) * 1e-9;
        if (t < 1) continue;
        const double jump = t < 1.7 ? 0 : behind;
        ASSERT_NEAR(stream.motion.q[0] - jump, q(t), 3e-4) << t;
        if (t > 1.8 && t < 1.85) continue;  // few samples, and newest ones
        ASSERT_NEAR(stream.motion.qdd[0], -9 * std::sin(3 * t), 3) << t;
        near += std::abs(t - 1.65) < 0.2;
      }
    }
    EXPECT_GT(near, 45);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
