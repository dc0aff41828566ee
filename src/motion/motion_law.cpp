#include "virtual_work_dynamics/motion_law.h"

#include <Eigen/LU>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "motion/end_slopes.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/spline.h"

namespace virtual_work_dynamics {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

constexpr double kPi = 3.14159265358979323846;

void checkPositive(double value, const std::string& what) {
  if (value > 0 && std::isfinite(value)) return;
  throw MotionError(what + " must be positive, is " + numberText(value));
}

void checkFrequency(double value, const std::string& what) {
  if (value >= 0 && std::isfinite(value)) return;
  throw MotionError(what + " must not be negative, is " + numberText(value));
}

void checkAmplitudes(const VectorXd& amplitudes) {
  for (Index j = 0; j < amplitudes.size(); ++j) {
    if (std::isfinite(amplitudes[j])) continue;
    throw MotionError("amplitude " + std::to_string(j + 1) + " is not finite");
  }
}

class CosineLaw : public MotionLaw {
 public:
  CosineLaw(VectorXd amplitudes, double period, double duration)
      : amplitudes_(std::move(amplitudes)), rate_(2 * kPi / period), duration_(duration) {}

  Index coordinates() const override { return amplitudes_.size(); }
  double duration() const override { return duration_; }

  void evaluate(double t, Motion& motion) const override {
    const double angle = rate_ * t;
    const double half_sine = std::sin(0.5 * angle);
    // This is 1 - cos without its cancellation near zero.
    motion.q = 2 * half_sine * half_sine * amplitudes_;
    motion.qd = rate_ * std::sin(angle) * amplitudes_;
    motion.qdd = rate_ * rate_ * std::cos(angle) * amplitudes_;
  }

 private:
  VectorXd amplitudes_;
  double rate_;  ///< rad/s
  double duration_;
};

class SineSweepLaw : public MotionLaw {
 public:
  SineSweepLaw(VectorXd amplitudes, double start_frequency, double end_frequency, double duration)
      : amplitudes_(std::move(amplitudes)),
        start_rate_(2 * kPi * start_frequency),
        acceleration_(2 * kPi * (end_frequency - start_frequency) / duration),
        duration_(duration) {}

  Index coordinates() const override { return amplitudes_.size(); }
  double duration() const override { return duration_; }

  void evaluate(double t, Motion& motion) const override {
    const double phase = (start_rate_ + 0.5 * acceleration_ * t) * t;
    const double rate = start_rate_ + acceleration_ * t;
    const double sine = std::sin(phase);
    const double cosine = std::cos(phase);
    motion.q = sine * amplitudes_;
    motion.qd = rate * cosine * amplitudes_;
    motion.qdd = (acceleration_ * cosine - rate * rate * sine) * amplitudes_;
  }

 private:
  VectorXd amplitudes_;
  double start_rate_;    ///< rad/s
  double acceleration_;  ///< acceleration of the phase, rad/s^2
  double duration_;
};

class SplineLaw : public MotionLaw {
 public:
  explicit SplineLaw(Spline spline) : spline_(std::move(spline)) {}

  Index coordinates() const override { return spline_.coordinates(); }
  double duration() const override { return spline_.endTime(); }
  void evaluate(double t, Motion& motion) const override { spline_.evaluate(t, motion); }

 private:
  Spline spline_;
};

/// The table with its first row at t = 0.
MotionTable fromZero(MotionTable table) {
  if (table.times.empty()) return table;
  const double start = table.times.front();
  for (double& time : table.times) time -= start;
  return table;
}

/// The rows of an inner point in the linear system of fillMinimumJerk(): 2x2 blocks that multiply
/// (qd, qdd) of the point before, the point and the point after.
struct Blocks {
  Matrix2d lower;
  Matrix2d diagonal;
  Matrix2d upper;
};

/// The blocks by which, in the first row, the fourth derivative and, in the second row, the third
/// derivative of the quintic Hermite pieces on either side of a point are equal. `before` and
/// `after` are the inverse lengths of the pieces. Rows are scaled such that the whole system is
/// symmetric: it is the gradient of the integral.
Blocks jerkBlocks(double before, double after) {
  const double before2 = before * before;
  const double after2 = after * after;
  Blocks blocks;
  blocks.lower << 56 * before2 * before, 8 * before2, -8 * before2, -before;
  blocks.diagonal << 64 * (before2 * before + after2 * after), 12 * (after2 - before2),
      12 * (after2 - before2), 3 * (before + after);
  blocks.upper << 56 * after2 * after, -8 * after2, 8 * after2, -after;
  return blocks;
}

/// Fills in the velocities and accelerations at the points of a motion from rest to rest that
/// minimise the integral of the squared jerk of the quintic pieces between the points.
void fillMinimumJerk(MotionTable& points) {
  const Index rows = points.positions.rows();
  const Index columns = points.positions.cols();
  const auto w = [&points](Index piece) {
    const std::size_t row = static_cast<std::size_t>(piece);
    return 1 / (points.times[row + 1] - points.times[row]);
  };
  const MatrixXd& q = points.positions;
  MatrixXd& qd = points.velocities;
  MatrixXd& qdd = points.accelerations;
  qd.setZero(rows, columns);
  qdd.setZero(rows, columns);

  // Block elimination needs no pivoting, as the matrix is symmetric and positive definite. Row 0
  // stands for the first point, which is at rest.
  std::vector<Matrix2d> coupling(static_cast<std::size_t>(rows), Matrix2d::Zero());
  MatrixXd values(2, columns);
  for (Index i = 1; i + 1 < rows; ++i) {
    const std::size_t row = static_cast<std::size_t>(i);
    const Blocks blocks = jerkBlocks(w(i - 1), w(i));
    // These are w^2 d of each piece, with the slope d = w (q1 - q0).
    const RowVectorXd before = std::pow(w(i - 1), 3) * (q.row(i) - q.row(i - 1));
    const RowVectorXd after = std::pow(w(i), 3) * (q.row(i + 1) - q.row(i));
    values.row(0) = 120 * (w(i - 1) * before + w(i) * after);
    values.row(1) = 20 * (after - before);
    values.row(0) -= blocks.lower(0, 0) * qd.row(i - 1) + blocks.lower(0, 1) * qdd.row(i - 1);
    values.row(1) -= blocks.lower(1, 0) * qd.row(i - 1) + blocks.lower(1, 1) * qdd.row(i - 1);
    const Matrix2d inverse = (blocks.diagonal - blocks.lower * coupling[row - 1]).inverse();
    coupling[row] = inverse * blocks.upper;
    qd.row(i) = inverse.row(0) * values;
    qdd.row(i) = inverse.row(1) * values;
  }
  for (Index i = rows - 2; i > 0; --i) {
    const Matrix2d& factor = coupling[static_cast<std::size_t>(i)];
    qd.row(i) -= factor(0, 0) * qd.row(i + 1) + factor(0, 1) * qdd.row(i + 1);
    qdd.row(i) -= factor(1, 0) * qd.row(i + 1) + factor(1, 1) * qdd.row(i + 1);
  }
}

}  // namespace

std::unique_ptr<MotionLaw> cosineLaw(const VectorXd& amplitudes, double period, double duration) {
  checkAmplitudes(amplitudes);
  checkPositive(period, "the period of the cosine law");
  checkPositive(duration, "the duration of the cosine law");
  return std::make_unique<CosineLaw>(amplitudes, period, duration);
}

std::unique_ptr<MotionLaw> sineSweepLaw(const VectorXd& amplitudes, double start_frequency,
                                        double end_frequency, double duration) {
  checkAmplitudes(amplitudes);
  checkFrequency(start_frequency, "the start frequency of the sine sweep");
  checkFrequency(end_frequency, "the end frequency of the sine sweep");
  checkPositive(duration, "the duration of the sine sweep");
  return std::make_unique<SineSweepLaw>(amplitudes, start_frequency, end_frequency, duration);
}

std::unique_ptr<MotionLaw> minimumJerkLaw(const MotionTable& via_points) {
  if (via_points.times.size() < 2) {
    throw MotionError("a minimum-jerk motion needs at least two via points, got " +
                      std::to_string(via_points.times.size()));
  }
  MotionTable points = fromZero(via_points);
  points.velocities.resize(0, 0);
  points.accelerations.resize(0, 0);
  const Spline checked(points);  // refuses bad points
  fillMinimumJerk(points);
  return std::make_unique<SplineLaw>(Spline(std::move(points)));
}

std::unique_ptr<MotionLaw> tableLaw(const MotionTable& table) {
  MotionTable rows = fromZero(table);
  Spline at_rest(rows);  // refuses bad rows
  if (rows.hasVelocities()) return std::make_unique<SplineLaw>(std::move(at_rest));
  const EndSlopes slopes = endSlopes(rows);
  return std::make_unique<SplineLaw>(Spline(std::move(rows), slopes.start, slopes.end));
}

}  // namespace virtual_work_dynamics
