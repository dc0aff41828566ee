#include "motion/trajectory_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/spline.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Values of order 1 to 100 from pieces of 0.5 s and more, computed in another order.
constexpr double kClosedForm = 1e-12;

/// Two joints through three points at uneven times.
MotionTable threePoints() {
  MotionTable points;
  points.joints = {"a", "b"};
  points.times = {1, 1.5, 3};
  points.positions = (MatrixXd(3, 2) << 0.1, -2, 0.7, 1, -0.4, 1.5).finished();
  points.velocities = (MatrixXd(3, 2) << 0, 1, 0.5, -2, 0, 0.3).finished();
  points.accelerations = (MatrixXd(3, 2) << 0, 0.2, 4, -1, 2, 0).finished();
  return points;
}

/// The cubic from (q, qd) to (q, qd) in the form of Hermite's basis functions, at s of 0 to 1.
struct Hermite {
  double q0, qd0, q1, qd1, h;
  double q(double s) const {
    return (1 + 2 * s) * (1 - s) * (1 - s) * q0 + s * (1 - s) * (1 - s) * h * qd0 +
           s * s * (3 - 2 * s) * q1 + s * s * (s - 1) * h * qd1;
  }
  double qd(double s) const {
    return 6 * s * (s - 1) * (q0 - q1) / h + (3 * s * s - 4 * s + 1) * qd0 +
           (3 * s * s - 2 * s) * qd1;
  }
  double qdd(double s) const {
    return ((12 * s - 6) * (q0 - q1) / h + (6 * s - 4) * qd0 + (6 * s - 2) * qd1) / h;
  }
};

TEST(TrajectoryCurve, PositionsAndVelocitiesAreJoinedByCubics) {
  MotionTable points = threePoints();
  points.accelerations.resize(0, 0);
  const TrajectoryCurve curve(points);
  EXPECT_EQ(curve.startTime(), 1);
  EXPECT_EQ(curve.endTime(), 3);
  Motion motion;
  for (int piece = 0; piece < 2; ++piece) {
    const double start = points.times[static_cast<std::size_t>(piece)];
    const double h = points.times[static_cast<std::size_t>(piece) + 1] - start;
    // The end of a piece belongs to the next one, or to none after the last.
    for (int step = 0; step < (piece == 0 ? 16 : 17); ++step) {
      const double s = step / 16.0;
      curve.evaluate(start + s * h, motion);
      for (int j = 0; j < 2; ++j) {
        const Hermite cubic{points.positions(piece, j), points.velocities(piece, j),
                            points.positions(piece + 1, j), points.velocities(piece + 1, j), h};
        EXPECT_NEAR(motion.q[j], cubic.q(s), kClosedForm);
        EXPECT_NEAR(motion.qd[j], cubic.qd(s), kClosedForm);
        EXPECT_NEAR(motion.qdd[j], cubic.qdd(s), kClosedForm);
      }
    }
  }
}

TEST(TrajectoryCurve, PassesItsPointsExactly) {
  for (const bool accelerations : {false, true}) {
    MotionTable points = threePoints();
    if (!accelerations) points.accelerations.resize(0, 0);
    const TrajectoryCurve curve(points);
    Motion motion;
    for (Eigen::Index row = 0; row < 3; ++row) {
      curve.evaluate(points.times[static_cast<std::size_t>(row)], motion);
      EXPECT_EQ(motion.q, points.positions.row(row).transpose());
      EXPECT_EQ(motion.qd, points.velocities.row(row).transpose());
      if (!accelerations) continue;
      EXPECT_EQ(motion.qdd, points.accelerations.row(row).transpose());
    }
  }
}

// Spline has its own tests.
TEST(TrajectoryCurve, OtherPointsAreJoinedByTheSpline) {
  MotionTable positions = threePoints();
  positions.velocities.resize(0, 0);
  positions.accelerations.resize(0, 0);
  const VectorXd start = Eigen::Vector2d(0.3, -1);
  const VectorXd end = Eigen::Vector2d(2, 0);
  const TrajectoryCurve curves[] = {TrajectoryCurve(threePoints()),
                                    TrajectoryCurve(positions, start, end)};
  const Spline splines[] = {Spline(threePoints()), Spline(positions, start, end)};
  Motion motion, expected;
  for (int i = 0; i < 2; ++i) {
    for (int step = 0; step <= 40; ++step) {
      const double t = 1 + 0.05 * step;
      curves[i].evaluate(t, motion);
      splines[i].evaluate(t, expected);
      EXPECT_EQ(motion.q, expected.q);
      EXPECT_EQ(motion.qd, expected.qd);
      EXPECT_EQ(motion.qdd, expected.qdd);
    }
  }
}

TEST(TrajectoryCurve, RestsOutsideOfThePoints) {
  MotionTable points = threePoints();
  points.accelerations.resize(0, 0);
  const TrajectoryCurve curve(points);
  Motion motion;
  for (const double t : {0.9, 3.1, 1e300}) {
    curve.evaluate(t, motion);
    EXPECT_EQ(motion.q, points.positions.row(t < 1 ? 0 : 2).transpose());
    EXPECT_EQ(motion.qd, Eigen::Vector2d::Zero());
    EXPECT_EQ(motion.qdd, Eigen::Vector2d::Zero());
  }
  EXPECT_THROW(curve.evaluate(std::numeric_limits<double>::quiet_NaN(), motion), MotionError);
}

TEST(TrajectoryCurve, ASinglePointIsAMoment) {
  MotionTable point;
  point.times = {0};
  point.positions = MatrixXd::Constant(1, 1, 3);
  point.velocities = MatrixXd::Constant(1, 1, 2);
  Motion motion;
  TrajectoryCurve(point).evaluate(0, motion);
  EXPECT_EQ(motion.q[0], 3);
  EXPECT_EQ(motion.qd[0], 2);
}

}  // namespace
}  // namespace virtual_work_dynamics
