#include "virtual_work_dynamics/spline.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "virtual_work_dynamics/error.h"

// With w = 1/h and d = (q1 - q0)/h on the piece between two knots of distance h, the derivatives of
// the quintic Hermite polynomial at the start of the piece are
//   third:   3 w [ 20 w (d - qd0) - 8 w (qd1 - qd0) - 3 qdd0 + qdd1 ]
//   fourth: 12 w^2 [ -30 w (d - qd0) + 14 w (qd1 - qd0) + 3 qdd0 - 2 qdd1 ]
// At its end they are the same with 0 and 1 exchanged and the sign of w changed.

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string knotText(Index row) {
  return "knot " + std::to_string(row + 1);
}

void checkShape(const MatrixXd& values, const MotionTable& knots, const std::string& what) {
  const Index rows = static_cast<Index>(knots.times.size());
  if (values.rows() == rows && values.cols() == knots.positions.cols()) return;
  throw MotionError(what + " of the knots: expected " + std::to_string(rows) + " rows of " +
                    std::to_string(knots.positions.cols()) + ", got " +
                    std::to_string(values.rows()) + " of " + std::to_string(values.cols()));
}

void checkFinite(const MatrixXd& values, const MotionTable& knots, const std::string& what) {
  for (Index row = 0; row < values.rows(); ++row) {
    for (Index column = 0; column < values.cols(); ++column) {
      if (std::isfinite(values(row, column))) continue;
      const std::string joint = knots.joints.empty()
                                    ? "coordinate " + std::to_string(column + 1)
                                    : "joint " + knots.joints[static_cast<std::size_t>(column)];
      throw MotionError(knotText(row) + ": the " + what + " of " + joint +
                        " is not finite: " + numberText(values(row, column)));
    }
  }
}

void checkTimes(const std::vector<double>& times) {
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (!std::isfinite(times[row])) {
      throw MotionError(knotText(static_cast<Index>(row)) +
                        ": the time is not finite: " + numberText(times[row]));
    }
    if (row > 0 && times[row] <= times[row - 1]) {
      throw MotionError(knotText(static_cast<Index>(row)) + ": the time " + numberText(times[row]) +
                        " s does not come after " + numberText(times[row - 1]) + " s");
    }
  }
}

void checkKnots(const MotionTable& knots) {
  if (knots.times.empty()) throw MotionError("a motion needs at least one knot, got none");
  checkShape(knots.positions, knots, "positions");
  if (knots.hasVelocities()) checkShape(knots.velocities, knots, "velocities");
  if (knots.hasAccelerations()) checkShape(knots.accelerations, knots, "accelerations");
  if (!knots.joints.empty() && static_cast<Index>(knots.joints.size()) != knots.positions.cols()) {
    throw MotionError("positions of the knots: expected a column for each of " +
                      std::to_string(knots.joints.size()) + " joints, got " +
                      std::to_string(knots.positions.cols()));
  }
  checkTimes(knots.times);
  checkFinite(knots.positions, knots, "position");
  checkFinite(knots.velocities, knots, "velocity");
  checkFinite(knots.accelerations, knots, "acceleration");
}

/// The velocity at an end of the cubic spline: the given one, or zero when it is empty.
VectorXd endVelocity(const VectorXd& given, Index coordinates, const std::string& what) {
  if (given.size() == 0) return VectorXd::Zero(coordinates);
  if (given.size() != coordinates || !given.allFinite()) {
    throw MotionError(what + " velocity: expected " + std::to_string(coordinates) +
                      " finite values, got " + std::to_string(given.size()));
  }
  return given;
}

struct Tridiagonal {
  explicit Tridiagonal(Index rows)
      : lower(VectorXd::Zero(rows)), diagonal(VectorXd::Zero(rows)), upper(VectorXd::Zero(rows)) {}

  VectorXd lower;  ///< [i] multiplies unknown i - 1
  VectorXd diagonal;
  VectorXd upper;  ///< [i] multiplies unknown i + 1
};

/// Solves a tridiagonal system by the Thomas algorithm, without pivoting, as the systems here are
/// diagonally dominant.
/// @param values right-hand sides in columns; on return the solutions.
void solve(Tridiagonal system, MatrixXd& values) {
  const Index rows = values.rows();
  for (Index i = 1; i < rows; ++i) {
    const double factor = system.lower[i] / system.diagonal[i - 1];
    system.diagonal[i] -= factor * system.upper[i - 1];
    values.row(i) -= factor * values.row(i - 1);
  }
  values.row(rows - 1) /= system.diagonal[rows - 1];
  for (Index i = rows - 2; i >= 0; --i) {
    values.row(i) = (values.row(i) - system.upper[i] * values.row(i + 1)) / system.diagonal[i];
  }
}

/// The inverse lengths w of all pieces.
VectorXd inverseSteps(const std::vector<double>& times) {
  VectorXd w(static_cast<Index>(times.size()) - 1);
  for (Index i = 0; i < w.size(); ++i) {
    const std::size_t row = static_cast<std::size_t>(i);
    w[i] = 1 / (times[row + 1] - times[row]);
  }
  return w;
}

/// The slopes d of all pieces, in rows.
MatrixXd slopes(const MatrixXd& q, const VectorXd& w) {
  return w.asDiagonal() * (q.bottomRows(w.size()) - q.topRows(w.size()));
}

/// Fills in the velocities of the clamped cubic spline, whose second derivative is continuous at
/// inner knots.
void fillVelocities(MotionTable& knots, const VectorXd& start, const VectorXd& end) {
  const Index rows = knots.positions.rows();
  const VectorXd w = inverseSteps(knots.times);
  const MatrixXd d = slopes(knots.positions, w);
  Tridiagonal system(rows);
  MatrixXd& qd = knots.velocities;
  qd.resize(rows, knots.positions.cols());
  system.diagonal[0] = system.diagonal[rows - 1] = 1;
  qd.row(0) = start.transpose();
  if (rows > 1) qd.row(rows - 1) = end.transpose();
  for (Index i = 1; i + 1 < rows; ++i) {
    system.lower[i] = w[i - 1];
    system.diagonal[i] = 2 * (w[i - 1] + w[i]);
    system.upper[i] = w[i];
    qd.row(i) = 3 * (w[i - 1] * d.row(i - 1) + w[i] * d.row(i));
  }
  solve(std::move(system), qd);
}

/// Fills in the accelerations of the cubic pieces between knots, which the velocities make
/// continuous.
void fillCubicAccelerations(MotionTable& knots) {
  const Index rows = knots.positions.rows();
  const VectorXd w = inverseSteps(knots.times);
  const MatrixXd d = slopes(knots.positions, w);
  const MatrixXd& qd = knots.velocities;
  MatrixXd& qdd = knots.accelerations;
  qdd.setZero(rows, qd.cols());
  for (Index i = 0; i + 1 < rows; ++i) {
    qdd.row(i) = w[i] * (6 * (d.row(i) - qd.row(i)) - 2 * (qd.row(i + 1) - qd.row(i)));
  }
  if (rows < 2) return;
  const Index end = rows - 1;
  qdd.row(end) =
      -w[end - 1] * (6 * (d.row(end - 1) - qd.row(end)) - 2 * (qd.row(end - 1) - qd.row(end)));
}

/// Fills in the accelerations that make the third derivative of the quintic pieces continuous at
/// inner knots and their fourth derivative zero at both ends; between two knots, those of the
/// cubic.
void fillQuinticAccelerations(MotionTable& knots) {
  const Index rows = knots.positions.rows();
  const VectorXd w = inverseSteps(knots.times);
  const MatrixXd d = slopes(knots.positions, w);
  const MatrixXd& qd = knots.velocities;
  MatrixXd& qdd = knots.accelerations;
  qdd.setZero(rows, qd.cols());
  if (rows < 2) return;
  Tridiagonal system(rows);
  for (Index i = 1; i + 1 < rows; ++i) {
    const double before = w[i - 1];
    const double after = w[i];
    system.lower[i] = -before;
    system.diagonal[i] = 3 * (before + after);
    system.upper[i] = -after;
    qdd.row(i) =
        after * after * (20 * (d.row(i) - qd.row(i)) - 8 * (qd.row(i + 1) - qd.row(i))) -
        before * before * (20 * (d.row(i - 1) - qd.row(i)) - 8 * (qd.row(i - 1) - qd.row(i)));
  }
  const Index end = rows - 1;
  system.diagonal[0] = system.diagonal[end] = 3;
  system.upper[0] = system.lower[end] = -2;
  qdd.row(0) = w[0] * (30 * (d.row(0) - qd.row(0)) - 14 * (qd.row(1) - qd.row(0)));
  qdd.row(end) =
      -w[end - 1] * (30 * (d.row(end - 1) - qd.row(end)) - 14 * (qd.row(end - 1) - qd.row(end)));
  solve(std::move(system), qdd);
}

}  // namespace

Spline::Spline(MotionTable knots, const VectorXd& start_velocity, const VectorXd& end_velocity)
    : knots_(std::move(knots)) {
  checkKnots(knots_);
  const VectorXd start = endVelocity(start_velocity, coordinates(), "start");
  const VectorXd end = endVelocity(end_velocity, coordinates(), "end");
  if (!knots_.hasVelocities()) {
    fillVelocities(knots_, start, end);
    fillCubicAccelerations(knots_);
  } else if (!knots_.hasAccelerations()) {
    fillQuinticAccelerations(knots_);
  }
  // Values overflow where knots are too far apart for their distance in time.
  checkFinite(knots_.velocities, knots_, "computed velocity");
  checkFinite(knots_.accelerations, knots_, "computed acceleration");
}

void Spline::evaluate(double t, Motion& motion) const {
  if (std::isnan(t)) throw MotionError("a motion cannot be evaluated at time nan");
  const std::vector<double>& times = knots_.times;
  motion.q.resize(coordinates());
  motion.qd.resize(coordinates());
  motion.qdd.resize(coordinates());
  if (t < startTime() || t > endTime()) {
    motion.q = knots_.positions.row(t < startTime() ? 0 : knots_.positions.rows() - 1).transpose();
    motion.qd.setZero();
    motion.qdd.setZero();
    return;
  }
  Index far = std::upper_bound(times.begin(), times.end(), t) - times.begin();
  Index near = far - 1;
  const auto time = [&times](Index row) { return times[static_cast<std::size_t>(row)]; };
  if (time(near) == t) {
    motion.q = knots_.positions.row(near).transpose();
    motion.qd = knots_.velocities.row(near).transpose();
    motion.qdd = knots_.accelerations.row(near).transpose();
    return;
  }
  // The piece is expanded about the nearer knot, for accuracy; from the later one the step is
  // negative.
  if (t - time(near) > time(far) - t) std::swap(near, far);
  const double tau = t - time(near);
  const double h = time(far) - time(near);
  const double s = tau / h;
  for (Index j = 0; j < coordinates(); ++j) {
    const double q = knots_.positions(near, j);
    const double qd = knots_.velocities(near, j);
    const double qdd = knots_.accelerations(near, j);
    // The parabola through the near knot misses the far one by these amounts.
    const double miss = knots_.positions(far, j) - q - h * (qd + 0.5 * h * qdd);
    const double miss_d = h * (knots_.velocities(far, j) - qd - h * qdd);
    const double miss_dd = h * h * (knots_.accelerations(far, j) - qdd);
    const double c3 = 10 * miss - 4 * miss_d + 0.5 * miss_dd;
    const double c4 = -15 * miss + 7 * miss_d - miss_dd;
    const double c5 = 6 * miss - 3 * miss_d + 0.5 * miss_dd;
    motion.q[j] = q + tau * (qd + 0.5 * tau * qdd) + s * s * s * (c3 + s * (c4 + s * c5));
    motion.qd[j] = qd + tau * qdd + s * s * (3 * c3 + s * (4 * c4 + s * 5 * c5)) / h;
    motion.qdd[j] = qdd + s * (6 * c3 + s * (12 * c4 + s * 20 * c5)) / (h * h);
  }
}

}  // namespace virtual_work_dynamics
