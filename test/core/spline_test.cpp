#include "virtual_work_dynamics/spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "spline_oracles.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using spline_oracles::expectClose;
using spline_oracles::sample;
using spline_oracles::sine;

// Closed forms with values of order 1 to 100 and steps of 0.2 to 1 s: rounding of the data (1e-16),
// amplified by up to 60 / 0.2^2 in the second derivative.
constexpr double kClosedForm = 1e-12;

// --- known splines ----------------------------------------------------------------------------

TEST(Spline, TwoKnotsWithVelocitiesAreTheCubicHermitePolynomial) {
  // From 1 to 3 in 2 s with velocities 0.5 and -1; in s = t / 2 the velocities are 1 and -2, and
  // q = 1 + s + (3*2 - 2*1 + 2) s^2 + (-2*2 + 1 - 2) s^3.
  MotionTable table;
  table.times = {0, 2};
  table.positions = (MatrixXd(2, 1) << 1, 3).finished();
  table.velocities = (MatrixXd(2, 1) << 0.5, -1).finished();
  const Spline spline(table);
  Motion motion;
  for (const double t : {0.0, 0.3, 1.0, 1.7, 2.0}) {
    const double s = t / 2;
    spline.evaluate(t, motion);
    expectClose(motion.q[0], 1 + s + 6 * s * s - 5 * s * s * s, kClosedForm, "q");
    expectClose(motion.qd[0], (1 + 12 * s - 15 * s * s) / 2, kClosedForm, "qd");
    expectClose(motion.qdd[0], (12 - 30 * s) / 4, kClosedForm, "qdd");
  }
}

TEST(Spline, ClampedCubicThroughAHump) {
  // 0, 1, 0 at rest at both ends: by symmetry the middle velocity is zero and both halves are
  // 3 s^2 - 2 s^3, with accelerations 6, -6, 6.
  MotionTable table;
  table.times = {0, 1, 2};
  table.positions = (MatrixXd(3, 1) << 0, 1, 0).finished();
  const Spline spline(table);
  const double expected[3] = {6, -6, 6};
  for (Index i = 0; i < 3; ++i) {
    expectClose(spline.knots().velocities(i, 0), 0, kClosedForm, "qd");
    expectClose(spline.knots().accelerations(i, 0), expected[i], kClosedForm, "qdd");
  }
  Motion motion;
  spline.evaluate(0.25, motion);
  expectClose(motion.q[0], 0.15625, kClosedForm, "q");
}

TEST(Spline, ClampedCubicThroughUnevenKnots) {
  // 0, 1, 4 at 0, 1, 3 s, at rest at the ends: (1/1 + 1/2) 2 v = 3 (1 + 3/4), so v = 7/4;
  // accelerations of the cubic pieces: 6 - 2 v = 5/2, 4 v - 6 = 1 and v - 6 * 3/4 = -11/4.
  MotionTable table;
  table.times = {0, 1, 3};
  table.positions = (MatrixXd(3, 1) << 0, 1, 4).finished();
  const Spline spline(table);
  expectClose(spline.knots().velocities(1, 0), 1.75, kClosedForm, "qd");
  expectClose(spline.knots().accelerations(0, 0), 2.5, kClosedForm, "qdd");
  expectClose(spline.knots().accelerations(1, 0), 1, kClosedForm, "qdd");
  expectClose(spline.knots().accelerations(2, 0), -2.75, kClosedForm, "qdd");
}

TEST(Spline, QuinticThroughAHump) {
  // 0, 1, 0 with zero velocities given, unit steps: by symmetry the third derivative at the middle
  // is zero; with the fourth zero at the ends: 3 a - 2 b = 30 and 6 b - 2 a = -40, so a = 50/7,
  // b = -30/7.
  MotionTable table;
  table.times = {0, 1, 2};
  table.positions = (MatrixXd(3, 1) << 0, 1, 0).finished();
  table.velocities = MatrixXd::Zero(3, 1);
  const Spline spline(table);
  expectClose(spline.knots().accelerations(0, 0), 50.0 / 7, kClosedForm, "qdd");
  expectClose(spline.knots().accelerations(1, 0), -30.0 / 7, kClosedForm, "qdd");
  expectClose(spline.knots().accelerations(2, 0), 50.0 / 7, kClosedForm, "qdd");
}

// --- values at knots and outside --------------------------------------------------------------

bool identicalBits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(Spline, KnotsAreReturnedBitForBit) {
  for (const bool velocities : {false, true}) {
    for (const bool accelerations : {false, true}) {
      MotionTable table = sample({0.1, 0.2, 0.3, 1.0 / 3, 7.7}, {sine(), sine()}, velocities,
                                 velocities && accelerations);
      table.positions.row(2) << -0.0, std::numeric_limits<double>::denorm_min();
      const Spline spline(table);
      Motion motion;
      for (std::size_t i = 0; i < table.times.size(); ++i) {
        const Index row = static_cast<Index>(i);
        spline.evaluate(table.times[i], motion);
        for (Index j = 0; j < 2; ++j) {
          EXPECT_TRUE(identicalBits(motion.q[j], table.positions(row, j)));
          EXPECT_TRUE(identicalBits(motion.qd[j], spline.knots().velocities(row, j)));
          EXPECT_TRUE(identicalBits(motion.qdd[j], spline.knots().accelerations(row, j)));
          if (velocities) {
            EXPECT_TRUE(identicalBits(motion.qd[j], table.velocities(row, j)));
          }
          if (velocities && accelerations) {
            EXPECT_TRUE(identicalBits(motion.qdd[j], table.accelerations(row, j)));
          }
        }
      }
    }
  }
}

TEST(Spline, HeldAtRestOutsideOfTheKnots) {
  const MotionTable table = sample({1, 2, 3}, {sine()}, true, true);
  const Spline spline(table);
  Motion motion;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double t : {std::nextafter(1.0, 0.0), -5.0, -infinity}) {
    spline.evaluate(t, motion);
    EXPECT_EQ(motion.q[0], table.positions(0, 0));
    EXPECT_EQ(motion.qd[0], 0);
    EXPECT_EQ(motion.qdd[0], 0);
  }
  for (const double t : {std::nextafter(3.0, 4.0), 50.0, infinity}) {
    spline.evaluate(t, motion);
    EXPECT_EQ(motion.q[0], table.positions(2, 0));
    EXPECT_EQ(motion.qd[0], 0);
    EXPECT_EQ(motion.qdd[0], 0);
  }
  EXPECT_THROW(spline.evaluate(std::nan(""), motion), MotionError);
}

TEST(Spline, CubicIsAtRestAtTheEndsUnlessToldOtherwise) {
  const MotionTable table = sample({0, 1, 2}, {sine()}, false, false);
  Motion motion;
  const Spline at_rest(table);
  at_rest.evaluate(0, motion);
  EXPECT_EQ(motion.qd[0], 0);
  at_rest.evaluate(2, motion);
  EXPECT_EQ(motion.qd[0], 0);
  const Spline moving(table, VectorXd::Constant(1, 0.25), VectorXd::Constant(1, -4));
  moving.evaluate(0, motion);
  EXPECT_EQ(motion.qd[0], 0.25);
  moving.evaluate(2, motion);
  EXPECT_EQ(motion.qd[0], -4);
}

TEST(Spline, AccelerationsWithoutVelocitiesAreTheCubic) {
  MotionTable table = sample({0, 1, 2}, {sine()}, false, false);
  const Spline cubic(table);
  table.accelerations = MatrixXd::Constant(3, 1, 17);
  const Spline spline(table);
  EXPECT_EQ(spline.knots().velocities, cubic.knots().velocities);
  EXPECT_EQ(spline.knots().accelerations, cubic.knots().accelerations);
}

TEST(Spline, SingleKnotIsAConstant) {
  MotionTable table;
  table.times = {2};
  table.positions = MatrixXd::Constant(1, 1, 0.7);
  Motion motion;
  for (const double t : {1.0, 2.0, 3.0}) {
    Spline(table).evaluate(t, motion);
    EXPECT_EQ(motion.q[0], 0.7);
    EXPECT_EQ(motion.qd[0], 0);
    EXPECT_EQ(motion.qdd[0], 0);
  }
  table.velocities = MatrixXd::Constant(1, 1, 0.3);
  Spline(table).evaluate(2, motion);
  EXPECT_EQ(motion.qd[0], 0.3);
  EXPECT_EQ(motion.qdd[0], 0);
  table.accelerations = MatrixXd::Constant(1, 1, -0.2);
  Spline(table).evaluate(2, motion);
  EXPECT_EQ(motion.qd[0], 0.3);
  EXPECT_EQ(motion.qdd[0], -0.2);
}

// --- refusals ---------------------------------------------------------------------------------

void expectRefused(const MotionTable& table, const std::string& part,
                   const VectorXd& start = VectorXd()) {
  try {
    Spline spline(table, start);
    ADD_FAILURE() << "not refused: " << part;
  } catch (const MotionError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Spline, RefusesBadTables) {
  const MotionTable good = sample({0, 1, 2}, {sine(), sine()}, true, true);
  expectRefused(MotionTable(), "at least one knot");
  MotionTable table = good;
  table.times[2] = 1;
  expectRefused(table, "knot 3: the time 1 s does not come after 1 s");
  table = good;
  table.times[1] = std::nan("");
  expectRefused(table, "knot 2: the time is not finite");
  table = good;
  table.times.pop_back();
  expectRefused(table, "positions of the knots: expected 2 rows of 2, got 3 of 2");
  table = good;
  table.velocities.resize(3, 1);
  expectRefused(table, "velocities of the knots: expected 3 rows of 2, got 3 of 1");
  table = good;
  table.accelerations.resize(2, 2);
  expectRefused(table, "accelerations of the knots: expected 3 rows of 2, got 2 of 2");
  table = good;
  table.joints.pop_back();
  expectRefused(table, "each of 1 joints, got 2");
  table = good;
  table.positions(1, 1) = std::numeric_limits<double>::infinity();
  expectRefused(table, "knot 2: the position of joint joint_2 is not finite: inf");
  table = good;
  table.velocities(0, 0) = std::nan("");
  expectRefused(table, "knot 1: the velocity of joint joint_1 is not finite: nan");
  table = good;
  table.accelerations(2, 0) = std::nan("");
  expectRefused(table, "knot 3: the acceleration of joint joint_1");
}

TEST(Spline, RefusesBadEndVelocities) {
  const MotionTable table = sample({0, 1, 2}, {sine()}, false, false);
  expectRefused(table, "start velocity: expected 1 finite values, got 2", VectorXd::Zero(2));
  expectRefused(table, "start velocity", VectorXd::Constant(1, std::nan("")));
}

TEST(Spline, RefusesKnotsTooFarApartForTheirTimes) {
  MotionTable table = sample({0, 1e-200, 1}, {sine()}, false, false);
  table.positions(1, 0) = 1e200;
  expectRefused(table, "computed velocity");
}

}  // namespace
}  // namespace virtual_work_dynamics
