#include <gtest/gtest.h>

#include <cmath>
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

TEST(MotionEstimator, GivesAMotionAtEverySampleOnceItIsOldEnough) {
  for (const int lag : {0, 2, 30}) {
    Stream stream({kR, kR}, settingsOf(1e-3 * lag));
    int outputs = 0;
    std::int64_t expected = 0;
    const auto play = [&](std::int64_t begin, Verdict first) {
      for (int i = 0; i < 50; ++i) {
        const std::int64_t time = begin + i * kMillisecond;
        EXPECT_EQ(stream.push(time, {0, 1}, {0.001 * i, 2.0}), i == 0 ? first : Verdict::kAccepted);
        // Derivatives take four samples.
        if (i < 3) {
          EXPECT_FALSE(stream.estimator.ready());
        }
        for (; stream.estimator.ready(); ++outputs) {
          const std::int64_t instant = stream.evaluate();
          EXPECT_EQ(instant, expected);
          EXPECT_GE(time - instant, lag * kMillisecond);
          expected += expected == 49 * kMillisecond ? 451 * kMillisecond : kMillisecond;
        }
      }
    };
    play(0, Verdict::kAccepted);
    play(500 * kMillisecond, Verdict::kAfterGap);
    EXPECT_EQ(outputs, 100 - lag);
    expected = 0;
    play(0, Verdict::kRestartedBack);
    EXPECT_EQ(outputs, 150 - 2 * lag);
  }
}

TEST(MotionEstimator, AGapOfOneJointDoesNotRestartTheOthers) {
  EstimatorSettings settings = settingsOf(0.01);
  settings.max_gap = 0.3;
  Stream both({kR, kR}, settings);
  Stream alone({kR}, settings);
  int motions = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t time = i * kMillisecond;
    const double q = 1e-4 * std::round(1e4 * std::sin(4e-3 * i));
    alone.push(time, {0}, {q});
    if (i >= 300 && i < 700) {
      EXPECT_EQ(both.push(time, {0}, {q}), Verdict::kAccepted);
      EXPECT_EQ(both.estimator.latestGap(), 0);
    } else {
      EXPECT_EQ(both.push(time, {0, 1}, {q, 1e-3 * i}),
                i == 700 ? Verdict::kAfterGap : Verdict::kAccepted);
    }
    if (i == 700) {
      EXPECT_EQ(both.estimator.latestGap(), 401 * kMillisecond);
      EXPECT_EQ(both.estimator.latestGapCoordinate(), 1);
    }
    while (alone.estimator.ready()) {
      ASSERT_TRUE(both.estimator.ready()) << i;  // with no delay either
      ASSERT_EQ(both.evaluate(), alone.evaluate());
      EXPECT_EQ(both.motion.q[0], alone.motion.q[0]);
      EXPECT_EQ(both.motion.qd[0], alone.motion.qd[0]);
      EXPECT_EQ(both.motion.qdd[0], alone.motion.qdd[0]);
      ++motions;
    }
    EXPECT_FALSE(both.estimator.ready());
  }
  EXPECT_EQ(motions, 990);
}

TEST(MotionEstimator, AGapOfExactlyMaxGapIsNone) {
  EstimatorSettings settings = settingsOf(0);
  settings.max_gap = 0.3;
  Stream stream({kR, kR}, settings);
  const std::int64_t gap = 300 * kMillisecond;
  EXPECT_EQ(stream.push(0, {0, 1}, {1, 1}), Verdict::kAccepted);
  EXPECT_EQ(stream.push(gap, {0}, {1}), Verdict::kAccepted);
  EXPECT_EQ(stream.push(gap + 1, {0}, {1}), Verdict::kAccepted);  // coordinate 1 is not in it
  EXPECT_EQ(stream.push(gap + 1, {0, 1}, {1, 1}), Verdict::kAfterGap);
  EXPECT_EQ(stream.estimator.latestGap(), gap + 1);
  EXPECT_EQ(stream.push(2 * gap + 1, {0, 1}, {1, 1}), Verdict::kAccepted);
  EXPECT_EQ(stream.estimator.latestGap(), 0);
}

TEST(MotionEstimator, RestartForgetsTheSamplesOfEveryCoordinate) {
  Stream stream({kR, kR}, settingsOf(0));
  for (int i = 0; i < 6; ++i)
    stream.push((i + 300) * kMillisecond, {0, 1}, {0.07 * i * i, -0.03 * i});
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.push(0, {0}, {0.25}), Verdict::kRestartedBack);
  EXPECT_TRUE(std::isinf(stream.estimator.age(1)));
  EXPECT_EQ(stream.push(0, {1}, {0.5}), Verdict::kAccepted);
  for (int i = 1; i < 4; ++i) {
    EXPECT_FALSE(stream.estimator.ready());
    EXPECT_EQ(stream.push(i * kMillisecond, {0, 1}, {0.25, 0.5}), Verdict::kAccepted);
  }
  EXPECT_EQ(stream.evaluate(), 0);
  EXPECT_EQ(stream.motion.q, Eigen::Vector2d(0.25, 0.5));
  EXPECT_EQ(stream.motion.qd, Eigen::Vector2d(0, 0));
  EXPECT_EQ(stream.motion.qdd, Eigen::Vector2d(0, 0));
}

TEST(MotionEstimator, TimeThatWentBackALittleForGoodRestarts) {
  Stream stream({kR}, settingsOf(0));
  for (int i = 0; i < 200; ++i) stream.push(i * kMillisecond, {0}, {1});
  stream.drain();
  // Behind more samples than late ones are put before, but within max_gap.
  int dropped = 0;
  Verdict verdict = Verdict::kTooLate;
  for (; verdict == Verdict::kTooLate && dropped < 100; ++dropped)
    verdict = stream.push(dropped * kMillisecond + 1, {0}, {2});
  EXPECT_EQ(verdict, Verdict::kRestartedBack);
  EXPECT_EQ(dropped, 11);
  for (int i = 11; i < 14; ++i) stream.push(i * kMillisecond + 1, {0}, {2});
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), 10 * kMillisecond + 1);
  EXPECT_NEAR(stream.motion.q[0], 2, 1e-12);
}

// A bag that is played in a loop and is shorter than max_gap: its stamps come again, exactly.
TEST(MotionEstimator, StampsThatComeAgainRestart) {
  Stream stream({kR, kR}, settingsOf(0));
  int restarts = 0;
  for (int round = 0; round < 3; ++round) {
    int results = 0;
    for (int i = 0; i < 100; ++i) {
      const Verdict verdict = stream.push(i * kMillisecond, {0, 1}, {1, 2});
      if (round == 0) {
        EXPECT_EQ(verdict, Verdict::kAccepted) << i;
      }
      restarts += verdict == Verdict::kRestartedBack;
      while (stream.estimator.ready()) {
        stream.evaluate();
        ++results;
      }
    }
    EXPECT_EQ(results, round == 0 ? 100 : 90) << round;
  }
  EXPECT_EQ(restarts, 2);
}

// While a clock stands still, states of one stamp come again and again: nothing has gone back.
TEST(MotionEstimator, AStampThatIsRepeatedIsNoRestart) {
  Stream stream({kR}, settingsOf(0));
  for (int i = 0; i < 10; ++i) stream.push(i * kMillisecond, {0}, {1});
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(stream.push(9 * kMillisecond, {0}, {1}), Verdict::kEqualStamp);
  EXPECT_EQ(stream.push(10 * kMillisecond, {0}, {1}), Verdict::kAccepted);
}

TEST(MotionEstimator, DropsAMessageOfAnEqualStamp) {
  Stream stream({kR, kR}, settingsOf(0));
  EXPECT_EQ(stream.push(5, {0}, {1}), Verdict::kAccepted);
  EXPECT_EQ(stream.push(5, {0}, {3}), Verdict::kEqualStamp);
  double q = 0;
  EXPECT_TRUE(stream.estimator.latestPosition(0, q));
  EXPECT_EQ(q, 1);
  EXPECT_FALSE(stream.estimator.latestPosition(1, q));
  // What is new in it is taken.
  EXPECT_EQ(stream.push(5, {1, 0}, {2, 3}), Verdict::kAccepted);
  EXPECT_TRUE(stream.estimator.latestPosition(1, q));
  EXPECT_EQ(q, 2);
  EXPECT_EQ(stream.push(5, {1, 0}, {4, 5}), Verdict::kEqualStamp);
  EXPECT_TRUE(stream.estimator.latestPosition(0, q));
  EXPECT_EQ(q, 1);
}

TEST(MotionEstimator, PutsALateSampleInItsPlace) {
  Stream stream({kR}, settingsOf(0.01));
  EXPECT_EQ(stream.push(10 * kMillisecond, {0}, {1}), Verdict::kAccepted);
  EXPECT_EQ(stream.push(9 * kMillisecond, {0}, {1}), Verdict::kTooLate);  // before the first
  for (int i = 11; i < 110; ++i)
    if (i != 50 && i != 100) stream.push(i * kMillisecond, {0}, {1.0 + i});
  stream.drain();
  EXPECT_EQ(stream.push(100 * kMillisecond, {0}, {101}), Verdict::kReordered);
  EXPECT_EQ(stream.push(100 * kMillisecond, {0}, {7}), Verdict::kEqualStamp);
  double q = 0;
  EXPECT_TRUE(stream.estimator.latestPosition(0, q));
  EXPECT_EQ(q, 110);  // the one of the newest stamp
  stream.push(110 * kMillisecond, {0}, {111});
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), 100 * kMillisecond);
  for (int i = 111; i < 114; ++i) stream.push(i * kMillisecond, {0}, {1.0 + i});
  stream.drain();
  // No motion is given for a sample that comes after the motions of later instants.
  EXPECT_EQ(stream.push(50 * kMillisecond, {0}, {51}), Verdict::kReordered);
  EXPECT_FALSE(stream.estimator.ready());
}

TEST(MotionEstimator, SkipPassesOverWhatIsDueOnly) {
  Stream stream({kR}, settingsOf(0.002));
  for (int i = 0; i < 10; ++i) stream.push(i * kMillisecond, {0}, {1});
  stream.estimator.skip();
  EXPECT_FALSE(stream.estimator.ready());
  stream.push(10 * kMillisecond, {0}, {1});
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), 8 * kMillisecond);
  EXPECT_EQ(stream.motion.q[0], 1);  // from the samples before as well
  EXPECT_FALSE(stream.estimator.ready());
}

TEST(MotionEstimator, ResetForgetsSamplesButNotTheLatestPosition) {
  Stream stream({kR, kR}, settingsOf(0));
  for (int i = 0; i < 5; ++i) stream.push(i * kMillisecond, {0, 1}, {1.0 * i, 2});
  ASSERT_TRUE(stream.estimator.ready());
  stream.estimator.reset();
  EXPECT_FALSE(stream.estimator.ready());
  EXPECT_TRUE(std::isinf(stream.estimator.age(0)));
  double q = 0;
  ASSERT_TRUE(stream.estimator.latestPosition(0, q));
  EXPECT_EQ(q, 4);
  EXPECT_EQ(stream.push(1, {0, 1}, {5, 6}), Verdict::kAccepted);  // nothing to go back from
  EXPECT_FALSE(stream.estimator.ready());
}

TEST(MotionEstimator, WithoutEstimatePassesStatesOn) {
  EstimatorSettings settings = settingsOf(-1);  // has no part in it
  settings.estimate = false;
  Stream stream({kC, kR}, settings);
  stream.motion.qdd.setConstant(9);
  EXPECT_EQ(stream.push(0, {0, 1}, {3, 1}), Verdict::kAccepted);
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), 0);
  EXPECT_EQ(stream.motion.q, Eigen::Vector2d(3, 1));
  EXPECT_EQ(stream.motion.qd, Eigen::Vector2d(0, 0));
  EXPECT_EQ(stream.motion.qdd, Eigen::Vector2d(0, 0));
  EXPECT_FALSE(stream.estimator.ready());
  const std::int64_t hour = 3600 * 1000 * kMillisecond;  // no gap is too long
  EXPECT_EQ(stream.push(hour, {0, 1}, {-3, 2}, {std::nan(""), 0.5}), Verdict::kAccepted);
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), hour);
  EXPECT_EQ(stream.motion.q, Eigen::Vector2d(-3 + 2 * std::acos(-1.0), 2)) << "not unwrapped";
  EXPECT_EQ(stream.motion.qd, Eigen::Vector2d(0, 0.5));
  EXPECT_FALSE(stream.estimator.held(1));
  // One that stays away is held, without its velocity.
  EXPECT_EQ(stream.push(2 * hour, {0}, {-2}, {0.25}), Verdict::kAccepted);
  ASSERT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), 2 * hour);
  EXPECT_TRUE(stream.estimator.held(1));
  EXPECT_EQ(stream.motion.q, Eigen::Vector2d(-2 + 2 * std::acos(-1.0), 2));
  EXPECT_EQ(stream.motion.qd, Eigen::Vector2d(0.25, 0));
  EXPECT_EQ(stream.push(2 * hour, {0}, {2}), Verdict::kEqualStamp);
  EXPECT_EQ(stream.push(2 * hour - 1, {0}, {2}), Verdict::kTooLate);
  EXPECT_EQ(stream.push(hour, {0}, {2}), Verdict::kRestartedBack);
}

TEST(MotionEstimator, RefusesSettingsOutOfRange) {
  const auto message = [](const EstimatorSettings& settings) -> std::string {
    try {
      const MotionEstimator estimator(mechanismOf({kR}), settings);
    } catch (const MotionError& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto of = [&](double EstimatorSettings::*member, double value) {
    EstimatorSettings settings;
    settings.*member = value;
    return message(settings);
  };
  const auto ofNoise = [&](double NoiseSettings::*member, double value) {
    EstimatorSettings settings;
    settings.noise.*member = value;
    return message(settings);
  };
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = infinity - infinity;
  EXPECT_EQ(of(&EstimatorSettings::lag, -0.001),
            "motion estimator: lag is -0.001, must be from 0 to 1 s");
  EXPECT_EQ(of(&EstimatorSettings::lag, 1.5),
            "motion estimator: lag is 1.5, must be from 0 to 1 s");
  EXPECT_NE(of(&EstimatorSettings::lag, nan), "accepted");
  EXPECT_EQ(of(&EstimatorSettings::lag, 0), "accepted");
  EXPECT_EQ(of(&EstimatorSettings::lag, 1), "accepted");
  for (const auto& [name, member] : {std::make_pair("max_gap", &EstimatorSettings::max_gap),
                                     std::make_pair("hold_after", &EstimatorSettings::hold_after)})
    for (const auto& [value, text] : {std::make_pair(0.0, "0"), std::make_pair(-0.5, "-0.5"),
                                      std::make_pair(infinity, "inf")}) {
      EXPECT_EQ(of(member, value), std::string("motion estimator: ") + name + " is " + text +
                                       ", must be a positive number of seconds");
      EXPECT_NE(of(member, nan), "accepted");
      EXPECT_EQ(of(member, 1e300), "accepted");
    }
  for (const auto& [name, member] :
       {std::make_pair("position_noise", &NoiseSettings::position_noise),
        std::make_pair("velocity_noise", &NoiseSettings::velocity_noise),
        std::make_pair("stamp_noise", &NoiseSettings::stamp_noise),
        std::make_pair("bandwidth", &NoiseSettings::bandwidth)}) {
    EXPECT_EQ(ofNoise(member, infinity),
              std::string("motion estimator: ") + name + " is inf, must be a finite number");
    EXPECT_NE(ofNoise(member, nan), "accepted");
    EXPECT_EQ(ofNoise(member, -3), "accepted");
    EXPECT_EQ(ofNoise(member, 1e-3), "accepted");
  }
  EXPECT_EQ(ofNoise(&NoiseSettings::bandwidth, 0),
            "motion estimator: bandwidth is 0, must be positive");
}

TEST(MotionEstimator, RefusesToEvaluateTooEarlyOrIntoAnotherSize) {
  Stream stream({kR, kR}, settingsOf(0));
  EXPECT_THROW(stream.evaluate(), MotionError);
  for (int i = 0; i < 4; ++i) stream.push(i, {0, 1}, {1, 2});
  Motion motion(3);
  EXPECT_THROW(stream.estimator.evaluate(motion), MotionError);
  MotionCovariance covariance;
  covariance.coordinates.resize(1);
  EXPECT_THROW(stream.estimator.evaluate(stream.motion, &covariance), MotionError);
  EXPECT_TRUE(stream.estimator.ready());
  EXPECT_EQ(stream.evaluate(), 0);
}

TEST(MotionEstimator, IsNeverReadyWithoutCoordinates) {
  Stream stream({JointType::kFixed}, {});
  EXPECT_NE(stream.push(0, std::vector<int>(), {}), Verdict::kRestartedBack);
  EXPECT_FALSE(stream.estimator.ready());
}

TEST(MotionEstimator, WaitsOnlyForTheCoordinatesItIsToldTo) {
  for (const bool estimate : {true, false}) {
    EstimatorSettings settings = settingsOf(0);
    settings.estimate = estimate;
    Stream stream({kR, kR, kR}, settings);
    stream.estimator.waitFor({true, false, true});
    stream.motion.q.setConstant(7);
    stream.motion.qd.setConstant(8);
    stream.motion.qdd.setConstant(9);
    // Coordinate 1 comes once, and late.
    stream.push(100 * kMillisecond, {1}, {3});
    std::int64_t instant = -1;
    for (int i = 0; i < 4; ++i) {
      stream.push(i * kMillisecond, {0, 2}, {0.5, 0.5 + 0.01 * i});
      while (stream.estimator.ready()) instant = stream.evaluate();
    }
    EXPECT_EQ(instant, 3 * kMillisecond);
    EXPECT_NEAR(stream.motion.q[2], 0.53, 1e-3);
    EXPECT_EQ(stream.motion.q[1], 7);
    EXPECT_EQ(stream.motion.qd[1], 8);
    EXPECT_EQ(stream.motion.qdd[1], 9);
    EXPECT_THROW(stream.estimator.waitFor({true, true}), MotionError);
  }
}

TEST(MotionEstimator, TwoPublishersThatContradictEachOtherAreTold) {
  Stream stream({kR, kR}, settingsOf(0));
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(stream.estimator.contradictory(1));
    if (i < 20) {
      EXPECT_FALSE(stream.estimator.contradictory(0));
    }
    // Joint 1 moves to and fro as fast, but as a motion does.
    stream.push(i * kMillisecond, {0, 1}, {i % 2 ? 1 : 1.5, std::sin(0.1 * i)});
  }
  EXPECT_TRUE(stream.estimator.contradictory(0));
  for (int i = 100; i < 200; ++i) stream.push(i * kMillisecond, {0, 1}, {1, 1});
  EXPECT_FALSE(stream.estimator.contradictory(0));  // one of them has ended
}

}  // namespace
}  // namespace virtual_work_dynamics
