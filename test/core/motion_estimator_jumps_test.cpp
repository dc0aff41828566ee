#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "joint_state_stream.h"

namespace virtual_work_dynamics {
namespace {

using namespace estimator_test;

constexpr double kStep = 1e-4;  // rad, of the encoder

State swing(double t) {
  return {0.7L + 0.5L * std::sin(3.0L * t), 1.5L * std::cos(3.0L * t), -4.5L * std::sin(3.0L * t)};
}

double encoded(double t) {
  return std::round(static_cast<double>(swing(t).q) / kStep) * kStep;
}

struct Errors {
  double acceleration = 0;  // largest, rad/s^2
  double position = 0;      // largest, rad
  int motions = 0;
  StreamQuality quality;
};

/// Runs a swing whose position at sample i is what `driver` makes of the encoder's, from sample
/// `first` on.
Errors run(double lag, double rate, double from, double to,
           const std::function<double(int i, double position)>& driver, int first = 0) {
  Stream stream({kR}, settingsOf(lag));
  Errors errors;
  const int count = static_cast<int>(std::lround(to * rate));
  for (int i = first; i < count; ++i) {
    const double t = i / rate;
    stream.push(std::llround(t * 1e9), {0}, {driver(i, encoded(t))});
    while (stream.estimator.ready()) {
      const double instant = static_cast<double>(stream.evaluate()) * 1e-9;
      ++errors.motions;
      if (instant < from) continue;
      const State right = swing(instant);
      errors.position =
          std::max(errors.position, std::abs(stream.motion.q[0] - static_cast<double>(right.q)));
      errors.acceleration = std::max(
          errors.acceleration, std::abs(stream.motion.qdd[0] - static_cast<double>(right.qdd)));
    }
  }
  errors.quality = stream.estimator.quality(0);
  return errors;
}

double asItIs(int, double position) {
  return position;
}

class JumpingPositions : public testing::TestWithParam<double> {};

// Drivers that have not read their encoders yet send zeros.
TEST_P(JumpingPositions, FirstPositionsOfZeroDoNotSpoilWhatFollows) {
  const double rate = GetParam();
  for (const double lag : {0.0, 0.05})
    for (const int zeros : {1, 2, 3, 5, 10, 30, 60, 100, 300}) {
      SCOPED_TRACE(std::to_string(zeros) + " zeros, lag " + std::to_string(lag));
      const double begin = zeros / rate, end = begin + 2;
      // Like a joint that came with the first true sample.
      Stream late({kR}, settingsOf(lag));
      Stream jumping({kR}, settingsOf(lag));
      const int count = static_cast<int>(std::lround(end * rate));
      double worst = 0;
      double largest = 0;
      for (int i = 0; i < count; ++i) {
        const std::int64_t time = std::llround(i / rate * 1e9);
        jumping.push(time, {0}, {i < zeros ? 0 : encoded(i / rate)});
        if (i >= zeros) late.push(time, {0}, {encoded(i / rate)});
        while (late.estimator.ready()) {
          const std::int64_t instant = late.evaluate();
          std::int64_t other = -1;
          while (other < instant && jumping.estimator.ready()) other = jumping.evaluate();
          if (other != instant) continue;  // still in doubt
          const double right = static_cast<double>(swing(static_cast<double>(instant) * 1e-9).qdd);
          worst = std::max(worst, std::abs(jumping.motion.qdd[0] - right));
          largest = std::max(largest, std::abs(late.motion.qdd[0] - right));
        }
      }
      EXPECT_LE(worst, 1.5 * largest + 0.1);
      EXPECT_EQ(jumping.estimator.quality(0).jumps, 1);
      EXPECT_EQ(jumping.estimator.quality(0).left_out, 0);
    }
}

TEST_P(JumpingPositions, APositionThatStandsAloneIsLeftOut) {
  const double rate = GetParam();
  const int at = static_cast<int>(std::lround(2 * rate));
  for (const double lag : {0.0, 0.05})
    for (const double glitch : {0.2, -0.7, 1000.0})
      for (const int samples : {1, 2}) {
        SCOPED_TRACE(std::to_string(samples) + " of " + std::to_string(glitch));
        const auto disturbed = [&](int i, double position) {
          return i >= at && i < at + samples ? position + glitch : position;
        };
        const Errors clean = run(lag, rate, 1, 4, asItIs);
        const Errors found = run(lag, rate, 1, 4, disturbed);
        EXPECT_EQ(found.motions, clean.motions);
        EXPECT_LE(found.acceleration, 1.3 * clean.acceleration);
        EXPECT_LE(found.position, 1.3 * clean.position);
        EXPECT_EQ(found.quality.left_out, samples);
        EXPECT_EQ(found.quality.jumps, 0);
      }
}

TEST_P(JumpingPositions, AJumpBeginsAnotherMotion) {
  const double rate = GetParam();
  const int at = static_cast<int>(std::lround(2 * rate));
  // A driver that takes another zero.
  const auto rezeroed = [&](int i, double position) { return i < at ? position + 0.3 : position; };
  // Like a joint that came with the first sample after it.
  const Errors anew = run(0.05, rate, 2, 4, asItIs, at);
  const Errors found = run(0.05, rate, 2, 4, rezeroed);
  EXPECT_LE(found.acceleration, 1.5 * anew.acceleration + 0.1);
  EXPECT_EQ(found.quality.jumps, 1);
}

INSTANTIATE_TEST_SUITE_P(Rates, JumpingPositions, testing::Values(125.0, 500.0, 2000.0));

TEST(JumpingPosition, WhiteNoiseIsNoJump) {
  for (const double deviation : {1e-3, 1e-2, 0.1})
    for (unsigned seed = 0; seed < 10; ++seed) {
      std::mt19937 random(seed);
      std::normal_distribution<double> noise(0, deviation);
      Stream stream({kR}, settingsOf(0));
      for (int i = 0; i < 4000; ++i) {
        stream.push(i * kMillisecond, {0},
                    {static_cast<double>(swing(1e-3 * i).q) + noise(random)});
        stream.drain();
      }
      const StreamQuality quality = stream.estimator.quality(0);
      EXPECT_EQ(quality.jumps + quality.left_out, 0) << deviation << ", seed " << seed;
    }
}

// What is in doubt is given later, and nothing is lost.
TEST(JumpingPosition, GivesNoMotionWhileItIsOpen) {
  Stream stream({kR}, settingsOf(0));
  int i = 0;
  const auto push = [&](double position) {
    stream.push(i++ * kMillisecond, {0}, {position});
    return stream.drain();
  };
  for (int k = 0; k < 100; ++k) push(0.1);
  EXPECT_EQ(push(0.5), 0);
  EXPECT_EQ(push(0.1), 2);
  EXPECT_EQ(push(0.1), 1);
  EXPECT_EQ(push(0.5), 0);
  EXPECT_EQ(push(0.5), 0);
  // Four samples are needed for any motion.
  EXPECT_EQ(push(0.5), 0);
  EXPECT_EQ(push(0.5), 4);
}

// A joint that goes silent while it is in doubt does not hold up the others.
TEST(JumpingPosition, HoldsUpNobody) {
  Stream stream({kR, kR}, settingsOf(0));
  for (int i = 0; i < 100; ++i) {
    stream.push(i * kMillisecond, {0, 1}, {0.1, 0.2});
    stream.drain();
  }
  stream.push(100 * kMillisecond, {0, 1}, {0.1, 0.9});
  int motions = stream.drain();
  for (int i = 101; i < 1000; ++i) {
    stream.push(i * kMillisecond, {0}, {0.1});
    motions += stream.drain();
  }
  EXPECT_EQ(motions, 900);
}

TEST(JumpingPosition, IsJudgedWithLateSamplesToo) {
  Stream stream({kR}, settingsOf(0));
  const auto push = [&](int i, double position) {
    stream.push(i * kMillisecond, {0}, {position});
    return stream.drain();
  };
  for (int i = 0; i < 100; ++i) push(i, 0.1);
  push(100, 0.5);
  push(102, 0.5);
  push(101, 0.5);
  push(103, 0.5);
  EXPECT_EQ(stream.estimator.quality(0).jumps, 1);
  EXPECT_EQ(stream.motion.q[0], 0.5);
  EXPECT_EQ(stream.motion.qdd[0], 0);
}

}  // namespace
}  // namespace virtual_work_dynamics
