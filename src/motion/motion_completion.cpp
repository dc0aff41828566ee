#include "virtual_work_dynamics/motion_completion.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "motion/polynomial_fit.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/unwrap.h"

namespace virtual_work_dynamics {
namespace {

void checkShapes(const Mechanism& mechanism, const MotionTable& motion) {
  for (const std::string& name : motion.joints) {
    const auto& known = mechanism.coordinateNames();
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw MotionError("motion: '" + name + "' is not a generalized coordinate of the robot");
    }
  }
  const auto rows = static_cast<Eigen::Index>(motion.times.size());
  const auto columns = static_cast<Eigen::Index>(motion.joints.size());
  const std::array<std::pair<const char*, const Eigen::MatrixXd*>, 3> matrices{
      {{"positions", &motion.positions},
       {"velocities", &motion.velocities},
       {"accelerations", &motion.accelerations}}};
  for (const auto& [name, matrix] : matrices) {
    const bool may_lack = matrix != &motion.positions && matrix->size() == 0;
    if (may_lack || (matrix->rows() == rows && matrix->cols() == columns)) continue;
    throw MotionError(std::string("motion: ") + name + " are " + std::to_string(matrix->rows()) +
                      " x " + std::to_string(matrix->cols()) + ", expected " +
                      std::to_string(rows) + " rows x " + std::to_string(columns) + " joints");
  }
}

void checkRows(const MotionTable& motion) {
  const std::size_t needed = motion.hasAccelerations() ? 2 : 3;
  const std::size_t rows = motion.times.size();
  if (rows < needed) {
    throw MotionError(std::string("motion: ") +
                      (motion.hasAccelerations() ? "velocities" : "accelerations") +
                      " are not given, and estimating them takes " + std::to_string(needed) +
                      " rows or more, not " + std::to_string(rows));
  }
  const std::size_t row = firstTimeThatDoesNotIncrease(motion.times);
  if (row < rows) {
    throw MotionError("motion: the time of row " + std::to_string(row + 1) +
                      " is not later than that of the row before");
  }
}

// Fits the rows around a row and gives the derivatives there.
class CentredFit {
 public:
  explicit CentredFit(const MotionTable& given)
      : given_(given), rows_(static_cast<Eigen::Index>(given.times.size())) {
    const EstimatorSettings settings;
    window_ = std::min(settings.window, static_cast<int>(rows_));
    order_ = std::min(settings.order, window_ - 1);
    times_.resize(static_cast<std::size_t>(window_));
  }

  // Fits the window around a row, in which evaluate() then gives derivatives.
  void moveTo(Eigen::Index row) {
    start_ = std::clamp<Eigen::Index>(row - window_ / 2, 0, rows_ - window_);
    for (std::size_t i = 0; i < times_.size(); ++i) {
      times_[i] = given_.times[static_cast<std::size_t>(start_) + i] -
                  given_.times[static_cast<std::size_t>(row)];
    }
    fit_.fit(times_.data(), window_, order_, given_.hasVelocities());
  }

  void evaluate(Eigen::Index column, double& velocity, double& acceleration) const {
    const double* q = given_.positions.col(column).data() + start_;
    const double* qd =
        given_.hasVelocities() ? given_.velocities.col(column).data() + start_ : nullptr;
    double position = 0;
    fit_.evaluate(q, qd, position, velocity, acceleration);
  }

 private:
  const MotionTable& given_;
  Eigen::Index rows_;
  int window_ = 0;
  int order_ = 0;
  Eigen::Index start_ = 0;
  std::vector<double> times_;
  PolynomialFit fit_;
};

}  // namespace

std::size_t firstTimeThatDoesNotIncrease(const std::vector<double>& times) {
  for (std::size_t row = 1; row < times.size(); ++row) {
    if (!(times[row] > times[row - 1])) return row;
  }
  return times.size();
}

MotionTable completeMotion(const Mechanism& mechanism, MotionTable motion) {
  checkShapes(mechanism, motion);
  unwrapPositions(mechanism, motion);
  const bool complete = motion.hasVelocities() && motion.hasAccelerations();
  if (complete || motion.positions.size() == 0) return motion;
  checkRows(motion);
  CentredFit fit(motion);
  Eigen::MatrixXd velocities(motion.positions.rows(), motion.positions.cols());
  Eigen::MatrixXd accelerations(motion.positions.rows(), motion.positions.cols());
  for (Eigen::Index row = 0; row < motion.positions.rows(); ++row) {
    fit.moveTo(row);
    for (Eigen::Index column = 0; column < motion.positions.cols(); ++column) {
      fit.evaluate(column, velocities(row, column), accelerations(row, column));
    }
  }
  if (!motion.hasVelocities()) motion.velocities = std::move(velocities);
  if (!motion.hasAccelerations()) motion.accelerations = std::move(accelerations);
  return motion;
}

}  // namespace virtual_work_dynamics
