#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "joint_state_stream.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {
namespace {

using namespace estimator_test;

}  // namespace

TEST(MotionEstimator, GivesInputsLessWindowMinusOnePerRestart) {
  for (const int window : {4, 9, 30}) {
    Stream stream({kR, kR}, settingsOf(window, 3, 2));
    int inputs = 0;
    int outputs = 0;
    const auto play = [&](std::int64_t begin, Verdict first) {
      for (int i = 0; i < 50; ++i, ++inputs) {
        EXPECT_EQ(stream.push(begin + i * kMillisecond, {0, 1}, {1.0 * i, 2.0}),
                  i == 0 ? first : Verdict::kAccepted);
        if (!stream.estimator.ready()) continue;
        ++outputs;
        EXPECT_EQ(stream.evaluate(), begin + (i - 2) * kMillisecond);
      }
    };
    play(0, Verdict::kAccepted);
    play(20 * kMillisecond, Verdict::kRestartedBack);
    play(500 * kMillisecond, Verdict::kRestartedGap);
    play(0, Verdict::kRestartedBack);
    EXPECT_EQ(outputs, inputs - 4 * (window - 1));
  }
}

TEST(MotionEstimator, RestartsAtAGapOfAnyCoordinateOfTheMessage) {
  EstimatorSettings settings = settingsOf(2, 1, 0);
  settings.max_gap = 0.3;
  Stream stream({kR, kR}, settings);
  const std::int64_t gap = 300 * kMillisecond;
  EXPECT_EQ(stream.push(0, {0, 1}, {1, 1}), Verdict::kAccepted);
  EXPECT_EQ(stream.push(gap, {0}, {1}), Verdict::kAccepted);
  EXPECT_EQ(stream.push(gap + 1, {0}, {1}), Verdict::kAccepted);  // coordinate 1 is not in it
  EXPECT_EQ(stream.push(gap + 1, {0, 1}, {1, 1}), Verdict::kEqualStamp);
  EXPECT_EQ(stream.push(gap + 2, {0, 1}, {1, 1}), Verdict::kRestartedGap);
  EXPECT_FALSE(stream.estimator.ready());
  EXPECT_EQ(stream.push(2 * gap + 2, {0, 1}, {1, 1}), Verdict::kAccepted);
  EXPECT_TRUE(stream.estimator.ready());
}

TEST(MotionEstimator, RestartForgetsTheSamplesOfEveryCoordinate) {
  Stream stream({kR, kR}, settingsOf(4, 3, 0));
  for (int i = 0; i < 6; ++i) stream.push((i + 3) * kMillisecond, {0, 1}, {7.0 * i * i, -3.0 * i});
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.push(0, {0}, {0.25}), Verdict::kRestartedBack);
  EXPECT_FALSE(stream.estimator.stale(0));
  EXPECT_TRUE(stream.estimator.stale(1));
  EXPECT_EQ(stream.push(0, {1}, {0.5}), Verdict::kAccepted);
  for (int i = 1; i < 4; ++i) {
    EXPECT_FALSE(stream.estimator.ready());
    EXPECT_EQ(stream.push(i * kMillisecond, {0, 1}, {0.25, 0.5}), Verdict::kAccepted);
  }
  EXPECT_EQ(stream.evaluate(), 3 * kMillisecond);
  EXPECT_EQ(stream.motion.q, Eigen::Vector2d(0.25, 0.5));
  EXPECT_EQ(stream.motion.qd, Eigen::Vector2d(0, 0));
  EXPECT_EQ(stream.motion.qdd, Eigen::Vector2d(0, 0));
}

TEST(MotionEstimator, DropsAMessageOfAnEqualStampWhole) {
  Stream stream({kR, kR}, settingsOf(2, 1, 0));
  EXPECT_EQ(stream.push(5, {0}, {1}), Verdict::kAccepted);
  EXPECT_EQ(stream.push(5, {1, 0}, {2, 3}), Verdict::kEqualStamp);
  double q = 0;
  EXPECT_TRUE(stream.estimator.latestPosition(0, q));
  EXPECT_EQ(q, 1);
  EXPECT_FALSE(stream.estimator.latestPosition(1, q));
  EXPECT_TRUE(stream.estimator.stale(1));
  // Behind one coordinate and equal to another one: time went back.
  EXPECT_EQ(stream.push(6, {1}, {2}), Verdict::kAccepted);
  EXPECT_EQ(stream.push(5, {0, 1}, {1, 2}), Verdict::kRestartedBack);
}

TEST(MotionEstimator, IsReadyOnceEveryCoordinateWasRefreshed) {
  Stream stream({kR, kR}, settingsOf(3, 1, 1));
  std::int64_t time = 0;
  const auto push = [&](int coordinate) { stream.push(++time, {coordinate}, {1.0 * coordinate}); };
  for (const int coordinate : {0, 1, 0, 0, 0, 1}) push(coordinate);
  EXPECT_FALSE(stream.estimator.ready());  // two samples of joint 1
  push(1);
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_FALSE(stream.estimator.stale(0));
  EXPECT_EQ(stream.evaluate(), 4);  // joint 0 came at 5 last, joint 1 at 7
  EXPECT_TRUE(stream.estimator.stale(0));
  EXPECT_TRUE(stream.estimator.stale(1));
  EXPECT_FALSE(stream.estimator.ready());
  push(0);
  EXPECT_FALSE(stream.estimator.stale(0));
  EXPECT_FALSE(stream.estimator.ready());
  push(1);
  EXPECT_TRUE(stream.estimator.ready());
  stream.estimator.skip();
  EXPECT_TRUE(stream.estimator.stale(0));
  EXPECT_FALSE(stream.estimator.ready());
  push(1);
  push(0);
  EXPECT_TRUE(stream.estimator.ready());  // skip() kept the windows
}

TEST(MotionEstimator, ResetForgetsSamplesButNotTheLatestPosition) {
  Stream stream({kR, kR}, settingsOf(2, 1, 0));
  stream.push(1, {0, 1}, {1, 2});
  stream.push(2, {0, 1}, {3, 4});
  ASSERT_TRUE(stream.estimator.ready());
  stream.estimator.reset();
  EXPECT_FALSE(stream.estimator.ready());
  EXPECT_TRUE(stream.estimator.stale(0));
  double q = 0;
  ASSERT_TRUE(stream.estimator.latestPosition(1, q));
  EXPECT_EQ(q, 4);
  EXPECT_EQ(stream.push(1, {0, 1}, {5, 6}), Verdict::kAccepted);  // nothing to go back from
  EXPECT_FALSE(stream.estimator.ready());
}

TEST(MotionEstimator, WithoutEstimatePassesStatesOn) {
  EstimatorSettings settings = settingsOf(0, 0, -1);  // have no part in it
  settings.estimate = false;
  Stream stream({kC, kR}, settings);
  stream.motion.qdd.setConstant(9);
  EXPECT_EQ(stream.push(0, {0, 1}, {3, 1}), Verdict::kAccepted);
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), 0);
  EXPECT_EQ(stream.motion.q, Eigen::Vector2d(3, 1));
  EXPECT_EQ(stream.motion.qd, Eigen::Vector2d(0, 0));
  EXPECT_EQ(stream.motion.qdd, Eigen::Vector2d(0, 0));
  const std::int64_t hour = 3600 * 1000 * kMillisecond;  // no gap is too long
  EXPECT_EQ(stream.push(hour, {1}, {2}, {0.5}), Verdict::kAccepted);
  EXPECT_FALSE(stream.estimator.ready());
  EXPECT_EQ(stream.push(hour + 1, {0}, {-3}), Verdict::kAccepted);
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), hour);
  EXPECT_EQ(stream.motion.q, Eigen::Vector2d(-3 + 2 * std::acos(-1.0), 2)) << "not unwrapped";
  EXPECT_EQ(stream.motion.qd, Eigen::Vector2d(0, 0.5));
  EXPECT_EQ(stream.push(hour, {1}, {2}), Verdict::kEqualStamp);
  EXPECT_EQ(stream.push(hour, {0}, {2}), Verdict::kRestartedBack);
}

TEST(MotionEstimator, RefusesSettingsThatContradictEachOther) {
  const auto message = [](int window, int order, int lag, double max_gap) -> std::string {
    EstimatorSettings settings = settingsOf(window, order, lag);
    settings.max_gap = max_gap;
    try {
      const MotionEstimator estimator(mechanismOf({kR}), settings);
    } catch (const MotionError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(9, 0, 4, 0.1), "motion estimator: order is 0, must be from 1 to 6");
  EXPECT_EQ(message(9, 7, 4, 0.1), "motion estimator: order is 7, must be from 1 to 6");
  EXPECT_EQ(message(3, 3, 0, 0.1),
            "motion estimator: window is 3, must be from order + 1 = 4 to 128");
  EXPECT_EQ(message(129, 3, 0, 0.1),
            "motion estimator: window is 129, must be from order + 1 = 4 to 128");
  EXPECT_EQ(message(9, 3, 9, 0.1), "motion estimator: lag is 9, must be from 0 to window - 1 = 8");
  EXPECT_EQ(message(9, 3, -1, 0.1),
            "motion estimator: lag is -1, must be from 0 to window - 1 = 8");
  EXPECT_EQ(message(9, 3, 4, 0),
            "motion estimator: max_gap is 0, must be a positive number of seconds");
  EXPECT_EQ(message(9, 3, 4, -0.5),
            "motion estimator: max_gap is -0.5, must be a positive number of seconds");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(message(9, 3, 4, infinity),
            "motion estimator: max_gap is inf, must be a positive number of seconds");
  EXPECT_NE(message(9, 3, 4, infinity - infinity), "accepted");
  EXPECT_EQ(message(128, 6, 127, 1e300), "accepted");
  EXPECT_EQ(message(2, 1, 0, 1e-3), "accepted");
}

TEST(MotionEstimator, RefusesToEvaluateTooEarlyOrIntoAnotherSize) {
  Stream stream({kR, kR}, settingsOf(2, 1, 0));
  EXPECT_THROW(stream.evaluate(), MotionError);
  stream.push(0, {0, 1}, {1, 2});
  stream.push(1, {0, 1}, {1, 2});
  Motion motion(3);
  EXPECT_THROW(stream.estimator.evaluate(motion), MotionError);
  EXPECT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), 1);
}

TEST(MotionEstimator, IsNeverReadyWithoutCoordinates) {
  Stream stream({JointType::kFixed}, {});
  EXPECT_EQ(stream.push(0, std::vector<int>(), {}), Verdict::kAccepted);
  EXPECT_FALSE(stream.estimator.ready());
}

TEST(MotionEstimator, WaitsOnlyForTheCoordinatesItIsToldTo) {
  for (const bool estimate : {true, false}) {
    EstimatorSettings settings = settingsOf(4, 3, 0);
    settings.estimate = estimate;
    Stream stream({kR, kR, kR}, settings);
    stream.estimator.waitFor({true, false, true});
    stream.motion.q.setConstant(7);
    stream.motion.qd.setConstant(8);
    stream.motion.qdd.setConstant(9);
    // Coordinate 1 comes once, and late: no window, and an instant of its own.
    stream.push(100 * kMillisecond, {1}, {3});
    for (int i = 0; i < 4; ++i) stream.push(i * kMillisecond, {0, 2}, {0.5, 1.0 * i});
    ASSERT_TRUE(stream.estimator.ready());
    EXPECT_EQ(stream.evaluate(), 3 * kMillisecond);
    EXPECT_NEAR(stream.motion.q[2], 3, 1e-12);
    EXPECT_EQ(stream.motion.q[1], 7);
    EXPECT_EQ(stream.motion.qd[1], 8);
    EXPECT_EQ(stream.motion.qdd[1], 9);
    stream.estimator.waitFor({true, true, true});
    stream.push(4 * kMillisecond, {0, 2}, {0.5, 4});
    EXPECT_FALSE(stream.estimator.ready());
    EXPECT_THROW(stream.estimator.waitFor({true, true}), MotionError);
  }
}

}  // namespace virtual_work_dynamics
