#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "spline_oracles.h"
#include "virtual_work_dynamics/motion_law.h"
#include "virtual_work_dynamics/spline.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Function = std::function<double(double)>;

// Rounding of positions (1e-16 of up to 10 rad) over the squared step, 1e-4 s^2, times the 4 of the
// second derivative of an end slope and as much again.
constexpr double kRounding = 1e-9;

/// A recording of positions every `step` s, from `start` on; every third row comes late by a fifth.
MotionTable recording(const Function& motion, double start, double step, int rows) {
  MotionTable table;
  table.joints = {"joint"};
  table.positions.resize(rows, 1);
  for (int i = 0; i < rows; ++i) {
    const double t = start + step * (i + (i % 3 == 1 ? 0.2 : 0));
    table.times.push_back(t);
    table.positions(i, 0) = motion(t);
  }
  return table;
}

/// The largest difference of the law's accelerations from the true ones, between and at the rows.
double worstError(const MotionLaw& law, const MotionTable& table, const Function& acceleration) {
  constexpr int kSteps = 5000;
  Motion motion;
  double worst = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = std::min(law.duration() * i / kSteps, law.duration());
    law.evaluate(t, motion);
    const double error = std::abs(motion.qdd[0] - acceleration(table.times.front() + t));
    worst = std::isfinite(error) ? std::max(worst, error) : error;
  }
  return worst;
}

Motion at(const MotionLaw& law, double t) {
  Motion motion;
  law.evaluate(t, motion);
  return motion;
}

TEST(TableLaw, ASteadyTurnIsSteadyFromTheFirstRowToTheLast) {
  for (const int rows : {3, 4, 5, 400}) {
    const MotionTable table = recording([](double t) { return 3 * t; }, 7, 0.01, rows);
    const auto law = tableLaw(table);
    EXPECT_LE(worstError(*law, table, [](double) { return 0.0; }), kRounding) << rows;
    EXPECT_NEAR(at(*law, 0).qd[0], 3, kRounding);
    EXPECT_NEAR(at(*law, law->duration()).qd[0], 3, kRounding);
  }
}

TEST(TableLaw, CubicsAreReproduced) {
  const MotionTable table =
      recording([](double t) { return 1 - 2 * t + 0.5 * t * t + 3 * t * t * t; }, 0, 0.01, 60);
  const auto law = tableLaw(table);
  EXPECT_LE(worstError(*law, table, [](double t) { return 1 + 18 * t; }), kRounding);
}

TEST(TableLaw, MovingEndsConvergeWithSecondOrder) {
  const Function motion = [](double t) { return std::sin(3 * t); };
  const Function acceleration = [](double t) { return -9 * std::sin(3 * t); };
  const auto error = [&](double step) {
    const MotionTable table = recording(motion, 0.3, step, static_cast<int>(2 / step));
    return worstError(*tableLaw(table), table, acceleration);
  };
  // A cubic spline's own error: h^2 / 12 of the fourth derivative, 81, and the uneven rows.
  EXPECT_LE(error(0.01), 0.01 * 0.01 * 81);
  EXPECT_LE(error(0.005), error(0.01) / 3.5);
}

TEST(TableLaw, ARecordingAtRestAtItsEndsStaysSo) {
  // From rest to rest: with the least jerk, and along a cosine that starts with its acceleration.
  const Function smooth = [](double t) {
    const double s = t / 2;
    return s * s * s * (10 - 15 * s + 6 * s * s);
  };
  const Function cosine = [](double t) { return 1 - std::cos(std::acos(-1.0) * t); };
  for (const Function& motion : {smooth, cosine}) {
    MotionTable table = recording(motion, 0, 0.01, 201);
    const auto law = tableLaw(table);
    const Spline at_rest(table);
    for (int i = 0; i <= 1000; ++i) {
      const double t = std::min(law->duration() * i / 1000, law->duration());
      Motion expected;
      at_rest.evaluate(t, expected);
      ASSERT_EQ(at(*law, t).qd, expected.qd) << t;
      ASSERT_EQ(at(*law, t).qdd, expected.qdd) << t;
    }
  }
}

TEST(TableLaw, NoiseAtTheEndsIsLikeNoiseInTheMiddle) {
  // A spline through noisy rows is noisy: where a recording moves and where it rests, its ends
  // shall be of the same kind. In the first row 1.8 to 2.4 times the middle's acceleration was
  // seen; an end taken as at rest while it moves at 3 rad/s makes 57 times.
  constexpr double kMost = 3.5;
  constexpr int kTrials = 100, kRows = 60;
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0, 3e-5);
  for (const double speed : {0.0, 0.2, 3.0}) {
    double ends = 0, middle = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const MotionTable table =
          recording([&](double t) { return speed * t + noise(generator); }, 0, 0.001, kRows);
      const auto law = tableLaw(table);
      for (const double t : {0.0, law->duration()}) ends += std::pow(at(*law, t).qdd[0], 2) / 2;
      middle += std::pow(at(*law, table.times[kRows / 2]).qdd[0], 2);
    }
    EXPECT_LE(std::sqrt(ends / middle), kMost) << speed;
  }
}

TEST(TableLaw, OneOrTwoRowsAreAtRest) {
  MotionTable table = recording([](double t) { return 3 * t; }, 0, 1, 2);
  const auto law = tableLaw(table);
  EXPECT_EQ(at(*law, 0).qd[0], 0);
  EXPECT_EQ(at(*law, law->duration()).qd[0], 0);
  table = recording([](double) { return 2; }, 0, 1, 1);
  EXPECT_EQ(at(*tableLaw(table), 0).qd[0], 0);
}

TEST(TableLaw, GivenVelocitiesAreTheEndsOwn) {
  MotionTable table = recording([](double t) { return 3 * t; }, 0, 0.01, 20);
  table.velocities = Eigen::MatrixXd::Constant(20, 1, 2.5);
  EXPECT_EQ(at(*tableLaw(table), 0).qd[0], 2.5);
}

}  // namespace
}  // namespace virtual_work_dynamics
