#include "virtual_work_dynamics/motion_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "joint_state_stream.h"

namespace virtual_work_dynamics {
namespace {

using namespace estimator_test;

constexpr double kPi = 3.14159265358979323846;

/// The paper's (5.11).
Law cosineLaw(long double amplitude) {
  return [amplitude](long double t) {
    const long double w = std::acos(-1.0L) / 6;
    return State{amplitude * (1 - std::cos(w * t)), amplitude * w * std::sin(w * t),
                 amplitude * w * w * std::cos(w * t)};
  };
}

Law sineLaw(long double amplitude, long double w) {
  return [amplitude, w](long double t) {
    return State{amplitude * std::sin(w * t), amplitude * w * std::cos(w * t),
                 -amplitude * w * w * std::sin(w * t)};
  };
}

void expectNear(const Motion& motion, Eigen::Index c, std::int64_t instant, const Law& law,
                double q_tolerance, double qd_tolerance, double qdd_tolerance) {
  const State state = law(static_cast<long double>(instant) * 1e-9L);
  ASSERT_TRUE(std::isfinite(motion.q[c] + motion.qd[c] + motion.qdd[c]));
  EXPECT_NEAR(motion.q[c], static_cast<double>(state.q), q_tolerance);
  EXPECT_NEAR(motion.qd[c], static_cast<double>(state.qd), qd_tolerance);
  EXPECT_NEAR(motion.qdd[c], static_cast<double>(state.qdd), qdd_tolerance);
}

TEST(MotionEstimator, FollowsTheCosineLawAt1kHz) {
  const std::vector<Law> laws = {cosineLaw(kPi / 12), cosineLaw(kPi / 6)};
  const double ranges[] = {kPi / 6, kPi / 3};
  const double w = kPi / 6;
  for (const bool velocities : {false, true})
    for (const int jitter : {0, 100000, 450000}) {
      SCOPED_TRACE(std::to_string(jitter) + (velocities ? " ns, velocities" : " ns"));
      Stream stream({kR, kR}, {});
      std::mt19937 random(7);
      std::uniform_int_distribution<std::int64_t> offset(-jitter, jitter);
      int outputs = 0;
      for (int i = 0; i <= 6000; ++i) {
        const std::int64_t time = i * kMillisecond + offset(random);
        std::vector<double> q;
        std::vector<double> qd;
        for (const Law& law : laws) {
          const State state = law(static_cast<long double>(time) * 1e-9L);
          q.push_back(static_cast<double>(state.q));
          qd.push_back(static_cast<double>(state.qd));
        }
        ASSERT_EQ(stream.push(time, {0, 1}, q, velocities ? qd : std::vector<double>()),
                  Verdict::kAccepted);
        while (stream.estimator.ready()) {
          const std::int64_t instant = stream.evaluate();
          ++outputs;
          if (instant < 1000 * kMillisecond) continue;  // still learning
          for (int c = 0; c < 2; ++c)
            expectNear(stream.motion, c, instant, laws[static_cast<std::size_t>(c)],
                       1e-8 * ranges[c], 1e-6 * ranges[c] * w, 5e-5 * ranges[c] * w * w);
        }
      }
      EXPECT_NEAR(outputs, 6001 - 50, 1);
    }
}

TEST(MotionEstimator, JointsMayComeByTurnsAtUnevenTimes) {
  const std::vector<Law> laws = {sineLaw(1, 2), sineLaw(-0.5L, 3), sineLaw(0.2L, 4)};
  for (const double lag : {0.0, 0.02})
    for (const bool velocities : {false, true}) {
      SCOPED_TRACE("lag " + std::to_string(lag) + (velocities ? " with velocities" : ""));
      Stream stream({kR, kR, kR}, settingsOf(lag));
      std::mt19937 random(13);
      std::int64_t time = 0;
      std::vector<std::int64_t> stamps;  // of the joint that came first, which leads
      std::size_t outputs = 0;
      for (int i = 0; i < 3 * 1000; ++i) {
        const auto c = static_cast<std::size_t>(i % 3);
        time += kMillisecond / 2 + static_cast<std::int64_t>(random() % 500000);
        stream.push(time, i % 3, laws[c], velocities);
        if (c == 0) stamps.push_back(time);
        while (stream.estimator.ready()) {
          const std::int64_t instant = stream.evaluate();
          if (outputs == 0) outputs = 1;  // at the first one the others had not come
          ASSERT_EQ(instant, stamps[outputs++]);
          ASSERT_LE(instant, time - std::llround(lag * 1e9));
          if (instant < 1000 * kMillisecond) continue;  // still learning
          for (std::size_t k = 0; k < 3; ++k) {
            // Without lag the others are extrapolated over up to 2 ms.
            const double part = lag > 0 ? 1e-4 : 1e-3;
            expectNear(stream.motion, static_cast<Eigen::Index>(k), instant, laws[k], 1e-3 * part,
                       part, 30 * part);
          }
        }
      }
      EXPECT_GE(outputs + static_cast<std::size_t>(lag * 450) + 1, stamps.size());
    }
}

TEST(MotionEstimator, UnwrapsContinuousJointsOnly) {
  const double speed = 40;
  const double acceleration = -8;  // turns back on the way
  for (const double multiple : {1.0, 100.0}) {
    Stream stream({kC, kR, kC}, {});
    for (int i = 0; i < 2000; ++i) {
      const double t = 0.005 * i;
      const double q = 1 + speed * t + acceleration / 2 * t * t;
      // A driver's wrap to (-pi, pi], and one that takes off many turns at once.
      const double wrapped = q - 2 * kPi * multiple * std::round(q / (2 * kPi * multiple));
      stream.push(i * 5 * kMillisecond, {0, 1, 2}, {wrapped, std::fmod(t, 5), -wrapped});
      while (stream.estimator.ready()) {
        const double instant = static_cast<double>(stream.evaluate()) * 1e-9;
        if (instant < 1) continue;
        // The revolute joint's jump of 5 rad, more than half a turn, is left in it.
        if (std::abs(instant - 5) > 0.5) {
          ASSERT_NEAR(stream.motion.q[1], std::fmod(instant, 5), 1e-9) << instant;
        }
        const double expected = 1 + speed * instant + acceleration / 2 * instant * instant;
        // Roundings of positions up to 700, over (5 ms)^2.
        for (const int c : {0, 2}) {
          const double sign = c == 0 ? 1 : -1;
          ASSERT_NEAR(stream.motion.q[c], sign * expected, 1e-12);
          ASSERT_NEAR(stream.motion.qd[c], sign * (speed + acceleration * instant), 1e-10);
          ASSERT_NEAR(stream.motion.qdd[c], sign * acceleration, 3e-8);
        }
      }
    }
  }
}

// A driver that wraps a revolute joint, at 200 Hz, with an encoder's noise: what it leaves out is
// put back with and without estimates, and where trajectories look for the latest position.
TEST(MotionEstimator, UnwrapsARevoluteJointWhoseDriverWraps) {
  constexpr double kSpeed = 3, kNoise = 1e-4;
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0, kNoise);
  for (const bool estimate : {true, false}) {
    EstimatorSettings settings = settingsOf(0.02);
    settings.estimate = estimate;
    Stream stream({kR}, settings);
    int results = 0;
    for (int i = 0; i < 2000; ++i) {
      const double q = kSpeed * 0.005 * i;
      stream.push(i * 5 * kMillisecond, {0}, {std::remainder(q + noise(generator), 2 * kPi)});
      if (!stream.estimator.ready()) continue;
      const double instant = static_cast<double>(stream.evaluate()) * 1e-9;
      ASSERT_NEAR(stream.motion.q[0], kSpeed * instant, 6 * kNoise) << i;
      double latest = 0;
      ASSERT_TRUE(stream.estimator.latestPosition(0, latest));
      ASSERT_NEAR(latest, q, 6 * kNoise) << i;
      ++results;
    }
    EXPECT_GE(results, 1990);
  }
}

TEST(MotionEstimator, KeepsTheDigitsOfAJointThatHasTurnedFar) {
  Stream stream({kC}, {});
  // The driver counts a million turns, then starts again from zero. Until then a double resolves
  // 1e-9 rad; from then on the samples are below 3, and so good to 4e-16.
  for (int i = 0; i < 2000; ++i) {
    const double q = 0.75 * (0.001 * i) * (0.001 * i);
    stream.push(i * kMillisecond, {0}, {i < 20 ? q + 2 * kPi * 1e6 : q});
    while (stream.estimator.ready()) stream.evaluate();
  }
  EXPECT_NEAR(stream.motion.q[0], 2 * kPi * 1e6, 4);
  EXPECT_NEAR(stream.motion.qdd[0], 1.5, 1e-7);
}

TEST(MotionEstimator, UnwrappingStartsAfreshAfterARestart) {
  Stream stream({kC}, settingsOf(0));
  const auto play = [&](std::int64_t begin, double from) {
    for (int i = 0; i < 40; ++i)
      stream.push(begin + i * kMillisecond, {0}, {std::remainder(from + 0.01 * i, 2 * kPi)});
    stream.drain();
  };
  play(500 * kMillisecond, 3);
  EXPECT_NEAR(stream.motion.q[0], 3.39, 1e-6);
  play(0, -3);
  EXPECT_NEAR(stream.motion.q[0], -2.61, 1e-6);
}

// It is as if the joint had begun after it.
TEST(MotionEstimator, AnAbsurdPositionDoesNotOutliveItsWindow) {
  for (const JointType type : {kR, kC})
    for (const double absurd : {1000.0, -1e6, 1e300, -std::numeric_limits<double>::max()})
      for (const bool twice : {false, true}) {
        SCOPED_TRACE(std::to_string(absurd) + (twice ? ", twice" : ", once"));
        Stream stream({type}, {});
        const Law law = sineLaw(0.5, 3);
        for (int i = 0; i < 4000; ++i) {
          const std::int64_t time = i * kMillisecond;
          if (i == 2000 || (twice && i == 2001)) {
            stream.push(time, {0}, {i == 2000 ? absurd : -absurd});
          } else {
            const double q = static_cast<double>(law(1e-3L * i).q);
            stream.push(time, {0}, {std::round(q / 1e-4) * 1e-4});
          }
          while (stream.estimator.ready()) {
            const std::int64_t instant = stream.evaluate();
            if (instant < 1500 * kMillisecond ||
                std::abs(instant - 2000 * kMillisecond) < 200 * kMillisecond)
              continue;
            const State state = law(static_cast<long double>(instant) * 1e-9L);
            ASSERT_TRUE(std::isfinite(stream.motion.q[0] + stream.motion.qd[0]));
            const double turned =
                std::remainder(stream.motion.q[0] - static_cast<double>(state.q), 2 * kPi);
            ASSERT_LE(std::abs(turned), 1e-3) << instant;
            ASSERT_NEAR(stream.motion.qdd[0], static_cast<double>(state.qdd), 1) << instant;
          }
        }
      }
}

TEST(MotionEstimator, VelocitiesThatAreNotGivenAreNotUsed) {
  EstimatorSettings without = settingsOf(0.02);
  without.noise.use_velocity = false;
  Stream used({kR}, settingsOf(0.02));
  Stream ignored({kR}, without);
  Stream absent({kR}, settingsOf(0.02));
  Stream unknown({kR}, settingsOf(0.02));
  Stream some({kR}, settingsOf(0.02));
  const Law law = sineLaw(1, 5);
  double squares[3] = {0, 0, 0};
  for (int i = 0; i < 4000; ++i) {
    const std::int64_t time = i * kMillisecond;
    const State state = law(1e-3L * i);
    const double q = 1e-3 * std::round(1e3 * static_cast<double>(state.q));
    const double qd = static_cast<double>(state.qd);
    used.push(time, {0}, {q}, {qd});
    ignored.push(time, {0}, {q}, {qd});
    absent.push(time, {0}, {q});
    unknown.push(time, {0}, {q}, {std::nan("")});
    some.push(time, {0}, {q}, {i > 3000 && i % 2 ? std::nan("") : qd});
    while (absent.estimator.ready()) {
      const std::int64_t instant = absent.evaluate();
      const double qdd = static_cast<double>(law(static_cast<long double>(instant) * 1e-9L).qdd);
      Stream* streams[] = {&absent, &some, &used, &ignored, &unknown};
      for (int k = 1; k < 5; ++k) ASSERT_EQ(streams[k]->evaluate(), instant);
      EXPECT_EQ(ignored.motion.qdd[0], absent.motion.qdd[0]);
      EXPECT_EQ(unknown.motion.qdd[0], absent.motion.qdd[0]);
      if (instant < 3000 * kMillisecond) continue;
      for (int k = 0; k < 3; ++k) squares[k] += std::pow(streams[k]->motion.qdd[0] - qdd, 2);
    }
  }
  // Clean velocities are worth much, and half of them nearly as much.
  EXPECT_LT(squares[2], 0.25 * squares[0]);
  EXPECT_LT(squares[1], 0.5 * squares[0]);
}

TEST(MotionEstimator, JointsDoNotDisturbEachOther) {
  // Joints with and without velocities, spacing that changes and comes back: each as if it were
  // alone, to the bit.
  const int joints = 5;
  Stream all(std::vector<JointType>(joints, kR), settingsOf(0.01));
  std::vector<std::unique_ptr<Stream>> alone;
  for (int c = 0; c < joints; ++c)
    alone.push_back(std::make_unique<Stream>(std::vector<JointType>{kR}, settingsOf(0.01)));
  std::int64_t time = 0;
  int compared = 0;
  for (int i = 0; i < 1500; ++i) {
    time += (i / 200 % 2 ? 3 : 1) * kMillisecond;
    for (int c = 0; c < joints; ++c) {
      const double t = static_cast<double>(time) * 1e-9;
      const double q = 1e-4 * std::round(1e4 * std::sin((1 + c) * t));
      const std::vector<double> qd =
          c % 2 ? std::vector<double>{(1 + c) * std::cos((1 + c) * t)} : std::vector<double>{};
      all.push(time, {c}, {q}, qd);
      alone[static_cast<std::size_t>(c)]->push(time, {0}, {q}, qd);
    }
    while (all.estimator.ready()) {
      const std::int64_t instant = all.evaluate();
      for (int c = 0; c < joints; ++c) {
        Stream& one = *alone[static_cast<std::size_t>(c)];
        ASSERT_EQ(one.evaluate(), instant);
        EXPECT_EQ(all.motion.q[c], one.motion.q[0]);
        EXPECT_EQ(all.motion.qd[c], one.motion.qd[0]);
        EXPECT_EQ(all.motion.qdd[c], one.motion.qdd[0]);
        EXPECT_EQ(all.covariance.coordinates[static_cast<std::size_t>(c)],
                  one.covariance.coordinates[0]);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, joints * 1485);
}

// To the bit.
TEST(MotionEstimator, WhatComesAfterAGapDoesNotChangeWhatWasBeforeIt) {
  Stream one({kR}, {});
  Stream other({kR}, {});
  int compared = 0;
  for (int i = 0; i < 1504; ++i) {
    const double q = 1e-4 * std::round(1e4 * std::sin(3e-3 * i));
    const int gap = i < 1500 ? 0 : 300;
    one.push((i + gap) * kMillisecond, {0}, {q});
    other.push((i + gap) * kMillisecond, {0}, {i < 1500 ? q : 0.5 + 1e-3 * (i % 2)});
    while (one.estimator.ready()) {
      const std::int64_t instant = one.evaluate();
      ASSERT_EQ(other.evaluate(), instant);
      ASSERT_EQ(one.motion.q, other.motion.q) << instant;
      ASSERT_EQ(one.motion.qdd, other.motion.qdd) << instant;
      compared += i >= 1500;
    }
  }
  EXPECT_EQ(compared, 50);
}

TEST(MotionEstimator, EvaluatesFastAndSlowJointsAtTheInstantsOfTheFastOne) {
  const Law slow = cosineLaw(1);
  const Law fast = sineLaw(1, 20);
  // At 10 kHz the samples that are kept of the fast joint reach back 0.1 s.
  for (const int microseconds : {1000, 100}) {
    Stream stream({kR, kR}, {});
    std::int64_t expected = 0;
    for (std::int64_t i = 0; i < 2000000 / microseconds; ++i) {
      const std::int64_t time = i * microseconds * 1000;
      if (time % (20 * kMillisecond) == 0) stream.push(time, 1, slow);
      stream.push(time, 0, fast);
      while (stream.estimator.ready()) {
        const std::int64_t instant = stream.evaluate();
        ASSERT_EQ(instant, expected);
        expected = instant + microseconds * 1000;
        if (instant < 1000 * kMillisecond) continue;
        ASSERT_EQ(instant, time - 50 * kMillisecond);
        expectNear(stream.motion, 0, instant, fast, 1e-6, 2e-4, 0.1);
        expectNear(stream.motion, 1, instant, slow, 1e-5, 1e-3, 1e-2);
      }
    }
    EXPECT_EQ(expected, 2000 * kMillisecond - 50 * kMillisecond);
  }
}

TEST(MotionEstimator, AJointThatBeginsLateIsWaitedFor) {
  const Law slow = cosineLaw(1);
  const Law fast = cosineLaw(0.5);
  for (const bool rests : {false, true}) {
    Stream stream({kR, kR}, {});
    if (rests) stream.estimator.setRest(0, 7);
    std::int64_t expected = rests ? 0 : 1510 * kMillisecond;
    for (int i = 0; i < 3000; ++i) {
      const std::int64_t time = i * kMillisecond;
      stream.push(time, 1, slow);
      if (i >= 1510) stream.push(time, 0, fast);
      while (stream.estimator.ready()) {
        const std::int64_t instant = stream.evaluate();
        // Nothing is known of a motion before its first sample.
        ASSERT_EQ(instant, expected);
        expected += kMillisecond;
        if (instant < 1510 * kMillisecond) {
          ASSERT_EQ(stream.motion.q[0], 7);
          ASSERT_EQ(stream.motion.qd[0], 0);
          ASSERT_TRUE(stream.estimator.held(0));
        } else {
          ASSERT_FALSE(stream.estimator.held(0)) << instant;
          expectNear(stream.motion, 0, instant, fast, 1e-7, 1e-4, 1e-2);
        }
      }
    }
    EXPECT_EQ(expected, 2950 * kMillisecond);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
