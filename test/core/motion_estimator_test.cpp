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

Law cubicLaw(long double a, long double b) {
  return [a, b](long double t) {
    return State{0.3L + a * t + b * t * t * t, a + 3 * b * t * t, 6 * b * t};
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

}  // namespace

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
        if (!stream.estimator.ready()) continue;
        ++outputs;
        const std::int64_t instant = stream.evaluate();
        // A cubic over 8 ms neglects the fourth derivative: by the formulae of Savitzky and Golay
        // that is 2e-7 of the range of the acceleration with even spacing, and twice that for
        // jitter.
        for (int c = 0; c < 2; ++c)
          expectNear(stream.motion, c, instant, laws[static_cast<std::size_t>(c)],
                     1e-12 * ranges[c], 1e-9 * ranges[c] * w, 4e-7 * ranges[c] * w * w);
      }
      EXPECT_EQ(outputs, 6001 - 8);
    }
}

TEST(MotionEstimator, IsExactForCubicsWithPartialMessagesAtUnevenTimes) {
  const std::vector<Law> laws = {cubicLaw(1, 2), cubicLaw(-0.5L, 1), cubicLaw(0.2L, -3)};
  for (const int lag : {0, 1, 4, 8})
    for (const bool velocities : {false, true}) {
      SCOPED_TRACE("lag " + std::to_string(lag) + (velocities ? " with velocities" : ""));
      Stream stream({kR, kR, kR}, settingsOf(9, 3, lag));
      std::mt19937 random(13);
      std::int64_t time = 0;
      std::int64_t last_instant = -1;
      std::vector<std::vector<std::int64_t>> stamps(3);
      int outputs = 0;
      for (int i = 0; i < 3 * 40; ++i) {
        const auto c = static_cast<std::size_t>(i % 3);
        time += 2 * kMillisecond + static_cast<std::int64_t>(random() % 1500000);
        stream.push(time, i % 3, laws[c], velocities);
        stamps[c].push_back(time);
        if (!stream.estimator.ready()) continue;
        ++outputs;
        std::int64_t expected = time;
        for (const auto& joint : stamps)
          expected = std::min(expected, joint[joint.size() - 1 - static_cast<std::size_t>(lag)]);
        const std::int64_t instant = stream.evaluate();
        ASSERT_EQ(instant, expected);
        ASSERT_GT(instant, last_instant);
        last_instant = instant;
        // 10 eps of a sample of up to 1, over a spacing of 8 ms (squared), and a margin of 10 for
        // the weights at the window's edge.
        for (std::size_t k = 0; k < 3; ++k)
          expectNear(stream.motion, static_cast<Eigen::Index>(k), instant, laws[k], 2e-14, 3e-12,
                     4e-10);
      }
      // A lag of the whole window lies before the first samples of some joint at first.
      EXPECT_EQ(outputs, lag == 8 ? 31 : 32);
    }
}

TEST(MotionEstimator, UnwrapsContinuousJointsOnly) {
  const double speed = 40;
  const double acceleration = -8;  // turns back on the way
  for (const double multiple : {1.0, 100.0}) {
    Stream stream({kC, kR, kC}, settingsOf(9, 2, 4));
    for (int i = 0; i < 2000; ++i) {
      const double t = 0.005 * i;
      const double q = 1 + speed * t + acceleration / 2 * t * t;
      // A driver's wrap to (-pi, pi], and one that takes off many turns at once.
      const double wrapped = q - 2 * kPi * multiple * std::round(q / (2 * kPi * multiple));
      stream.push(i * 5 * kMillisecond, {0, 1, 2}, {wrapped, std::fmod(t, 5), -wrapped});
      if (!stream.estimator.ready()) continue;
      const double instant = static_cast<double>(stream.evaluate()) * 1e-9;
      const double expected = 1 + speed * instant + acceleration / 2 * instant * instant;
      // Roundings of positions up to 700, over (5 ms)^2.
      for (const int c : {0, 2}) {
        const double sign = c == 0 ? 1 : -1;
        ASSERT_NEAR(stream.motion.q[c], sign * expected, 1e-12);
        ASSERT_NEAR(stream.motion.qd[c], sign * (speed + acceleration * instant), 1e-10);
        ASSERT_NEAR(stream.motion.qdd[c], sign * acceleration, 3e-8);
      }
      // The revolute joint's jumps of 5 rad, more than half a turn, are left in it.
      if (std::fmod(instant, 5) < 0.01 && instant > 1) {
        EXPECT_LT(stream.motion.qd[1], -20);
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
    EstimatorSettings settings = settingsOf(9, 2, 4);
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
  Stream stream({kC}, settingsOf(9, 2, 4));
  // The driver counts a million turns, then starts again from zero.
  for (int i = 0; i < 40; ++i) {
    const double q = 3.0 * (0.001 * i) * (0.001 * i);
    stream.push(i * kMillisecond, {0}, {i < 20 ? q + 2 * kPi * 1e6 : q});
  }
  stream.evaluate();
  EXPECT_NEAR(stream.motion.q[0], 2 * kPi * 1e6, 1e-2);
  EXPECT_NEAR(stream.motion.qdd[0], 6,
              1e-9);  // the samples are below 0.005: eps of that over (1 ms)^2
}

TEST(MotionEstimator, UnwrappingStartsAfreshAfterARestart) {
  Stream stream({kC}, settingsOf(2, 1, 0));
  stream.push(0, {0}, {3});
  stream.push(1, {0}, {-3});
  stream.evaluate();
  EXPECT_NEAR(stream.motion.q[0], 2 * kPi - 3, 1e-14);
  stream.push(0, {0}, {-3});
  stream.push(1, {0}, {-3 + kPi});  // exactly half a turn is no jump
  stream.evaluate();
  EXPECT_NEAR(stream.motion.q[0], -3 + kPi, 1e-14);
}

TEST(MotionEstimator, AnAbsurdPositionDoesNotOutliveItsWindow) {
  for (const double absurd : {1e300, -std::numeric_limits<double>::max()}) {
    Stream stream({kC}, settingsOf(4, 3, 0));
    stream.push(0, {0}, {0.5});
    stream.push(1, {0}, {absurd});
    stream.push(2, {0}, {-absurd});
    for (int i = 3; i < 7; ++i) stream.push(i, {0}, {0.5});
    stream.evaluate();
    EXPECT_EQ(stream.motion.q[0], 0.5);
    EXPECT_EQ(stream.motion.qdd[0], 0);
  }
}

TEST(MotionEstimator, UsesVelocitiesOnlyWhereAWholeWindowHasThem) {
  // Velocities that belie the positions, so that it shows whether they are used.
  EstimatorSettings without = settingsOf(5, 2, 2);
  without.use_velocity = false;
  Stream used({kR}, settingsOf(5, 2, 2));
  Stream ignored({kR}, without);
  Stream absent({kR}, settingsOf(5, 2, 2));
  for (int i = 0; i < 20; ++i) {
    const std::int64_t time = i * kMillisecond;
    const double q = 0.001 * i;
    used.push(time, {0}, {q}, i == 8 ? std::vector<double>() : std::vector<double>{7});
    ignored.push(time, {0}, {q}, {7});
    absent.push(time, {0}, {q});
    if (!absent.estimator.ready()) continue;
    used.evaluate();
    ignored.evaluate();
    absent.evaluate();
    EXPECT_EQ(ignored.motion.qd[0], absent.motion.qd[0]);
    EXPECT_NEAR(absent.motion.qd[0], 1, 1e-12);
    if (i >= 8 && i < 8 + 5) {
      EXPECT_EQ(used.motion.qd[0], absent.motion.qd[0]) << i;
    } else {
      EXPECT_GT(used.motion.qd[0], 2) << i;
    }
  }
}

TEST(MotionEstimator, JointsDoNotDisturbEachOther) {
  // Joints by turns with and without velocities, spacing that changes and comes back: each as if it
  // were alone, to the bit, whoever's weights it shares.
  const int joints = 5;
  const std::vector<int> spacing = {1, 1, 1, 1, 1, 1, 2, 1, 1, 1, 1,
                                    1, 1, 1, 3, 3, 3, 3, 3, 1, 1, 1};
  Stream all(std::vector<JointType>(joints, kR), settingsOf(4, 2, 1));
  std::vector<std::unique_ptr<Stream>> alone;
  for (int c = 0; c < joints; ++c) {
    alone.push_back(std::make_unique<Stream>(std::vector<JointType>{kR}, settingsOf(4, 2, 1)));
  }
  std::int64_t time = 0;
  int compared = 0;
  for (const int step : spacing) {
    time += step * kMillisecond;
    for (int c = 0; c < joints; ++c) {
      const double t = static_cast<double>(time) * 1e-9;
      const double q = 1 + c * t + t * t;
      const std::vector<double> qd = c % 2 ? std::vector<double>{c + 2 * t} : std::vector<double>{};
      all.push(time, {c}, {q}, qd);
      alone[static_cast<std::size_t>(c)]->push(time, {0}, {q}, qd);
    }
    if (!all.estimator.ready()) continue;
    const std::int64_t instant = all.evaluate();
    for (int c = 0; c < joints; ++c) {
      Stream& one = *alone[static_cast<std::size_t>(c)];
      ASSERT_EQ(one.evaluate(), instant);
      EXPECT_EQ(all.motion.q[c], one.motion.q[0]);
      EXPECT_EQ(all.motion.qd[c], one.motion.qd[0]);
      EXPECT_EQ(all.motion.qdd[c], one.motion.qdd[0]);
      EXPECT_NEAR(all.motion.qdd[c], 2, 1e-8);  // eps over (1 ms)^2, and a margin for the weights
      ++compared;
    }
  }
  EXPECT_EQ(compared, joints * (static_cast<int>(spacing.size()) - 3));
}

TEST(MotionEstimator, EvaluatesFastAndSlowJointsAtACommonInstant) {
  const Law slow = cosineLaw(1);
  // Far too quick for a polynomial that is used outside of its samples.
  const Law fast = [](long double t) {
    const long double w = 20;
    return State{std::sin(w * t), w * std::cos(w * t), -w * w * std::sin(w * t)};
  };
  // At 10 kHz the samples held of the fast joint reach back 51 ms, less than the lag of 200 ms.
  for (const int microseconds : {1000, 100}) {
    Stream stream({kR, kR}, {});
    std::int64_t last = -1;
    int outputs = 0;
    for (std::int64_t i = 0; i < 3000000 / microseconds; ++i) {
      const std::int64_t time = i * microseconds * 1000;
      stream.push(time, 0, fast);
      if (time % (50 * kMillisecond) != 0) continue;
      stream.push(time, 1, slow);
      if (!stream.estimator.ready()) continue;
      ++outputs;
      const std::int64_t instant = stream.evaluate();
      if (microseconds == 1000) {
        EXPECT_EQ(instant, time - 200 * kMillisecond);
      } else {
        EXPECT_EQ(instant, time - 511 * 100000);
      }
      ASSERT_GT(instant, last);
      last = instant;
      // The fourth derivative over a spacing of 1 ms, and of 50 ms; at the edge of the window of
      // the fast joint 5 times as much.
      expectNear(stream.motion, 0, instant, fast, 1e-5, 1e-3, 1);
      expectNear(stream.motion, 1, instant, slow, 1e-5, 1e-3, 1e-2);
    }
    EXPECT_EQ(outputs, 60 - 8);
  }
}

TEST(MotionEstimator, AJointThatBeginsLateIsWaitedFor) {
  const Law slow = cosineLaw(1);
  const Law fast = cosineLaw(0.5);
  Stream stream({kR, kR}, {});
  std::int64_t last = -1;
  int outputs = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t time = i * kMillisecond;
    if (i >= 1510) stream.push(time, 0, fast);
    if (i % 50 != 0) continue;
    stream.push(time, 1, slow);
    if (!stream.estimator.ready()) continue;
    ++outputs;
    const std::int64_t instant = stream.evaluate();
    EXPECT_EQ(instant, time - 200 * kMillisecond);
    EXPECT_GE(instant, 1510 * kMillisecond);
    ASSERT_GT(instant, last);
    last = instant;
    expectNear(stream.motion, 0, instant, fast, 1e-9, 1e-7, 1e-4);
  }
  EXPECT_EQ(outputs, (2950 - 1750) / 50 + 1);
}

}  // namespace virtual_work_dynamics
