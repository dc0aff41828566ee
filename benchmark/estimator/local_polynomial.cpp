#include "estimator/local_polynomial.h"

#include <algorithm>
#include <cmath>

#include "estimator/polynomial_window.h"
#include "motion/sample_blocks.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kOrder = 5;
constexpr int kHigherOrder = 7;
constexpr int kShortest = 11;
constexpr double kGrowth = 1.2;
constexpr double kLongest = 0.9;        // s
constexpr std::size_t kChoosers = 150;  // rows that a window is chosen by

}  // namespace

LocalPolynomial::LocalPolynomial(const EncoderRecording& recording) : recording_(recording) {
  const std::vector<std::size_t> rows =
      rowsBetween(recording, 0, recording.times.back(), kChoosers);
  Eigen::RowVectorXd variances(kArmJoints);
  for (Eigen::Index j = 0; j < kArmJoints; ++j) variances[j] = noiseVariance(rows, j);
  Eigen::RowVectorXd least = Eigen::RowVectorXd::Constant(kArmJoints, HUGE_VAL);
  const double most =
      std::min(kLongest * recording.spec.rate, 0.5 * static_cast<double>(recording.rows()));
  for (double length = kShortest; length < most; length *= kGrowth) {
    const int window = static_cast<int>(length) | 1;
    const Eigen::RowVectorXd errors = meanSquareErrors(rows, window, variances);
    for (Eigen::Index j = 0; j < kArmJoints; ++j) {
      if (!(errors[j] < least[j])) continue;
      least[j] = errors[j];
      windows_[static_cast<std::size_t>(j)] = window;
    }
  }
}

/// Of a reading, rad^2: from the residuals of the shortest windows, and not below that of rounding.
double LocalPolynomial::noiseVariance(const std::vector<std::size_t>& rows,
                                      Eigen::Index joint) const {
  double squares = 0;
  for (const std::size_t row : rows) {
    const WindowRows around = windowAround(recording_, row, kShortest);
    const Eigen::VectorXd times = relativeTimes(recording_, around, row);
    const Eigen::Matrix3Xd weights = polynomialWeights(times, kOrder);
    const Eigen::Index at = static_cast<Eigen::Index>(row);
    const Eigen::VectorXd relative =
        recording_.positions.col(joint).segment(around.first, around.count).array() -
        recording_.positions(at, joint);
    const double own_weight = weights(0, at - around.first);
    const double residual = weights.row(0).dot(relative);
    squares += residual * residual / (1 - own_weight);
  }
  const double* first = recording_.positions.col(joint).data();
  const double least = leastNoise({first, first + recording_.positions.rows()});
  return std::max(squares / static_cast<double>(rows.size()), least * least);
}

Eigen::RowVectorXd LocalPolynomial::meanSquareErrors(const std::vector<std::size_t>& rows,
                                                     int window,
                                                     const Eigen::RowVectorXd& variances) const {
  Eigen::ArrayXd biases = Eigen::ArrayXd::Zero(kArmJoints);
  Eigen::ArrayXd noises = Eigen::ArrayXd::Zero(kArmJoints);
  for (const std::size_t row : rows) {
    const WindowRows around = windowAround(recording_, row, window);
    const Eigen::VectorXd times = relativeTimes(recording_, around, row);
    const Eigen::Matrix3Xd weights = polynomialWeights(times, kOrder);
    const Eigen::Matrix3Xd difference = polynomialWeights(times, kHigherOrder) - weights;
    const Eigen::ArrayXd bias =
        weightedPositions(recording_, around, row, difference).row(2).transpose();
    biases += bias.square() - variances.transpose().array() * difference.row(2).squaredNorm();
    noises += variances.transpose().array() * weights.row(2).squaredNorm();
  }
  return (biases.max(0) + noises).matrix().transpose();
}

std::vector<Motion> LocalPolynomial::motions(const std::vector<std::size_t>& rows) const {
  std::vector<Motion> motions(rows.size(), Motion(kArmJoints));
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const WindowRows around = windowAround(recording_, rows[i], windows_[j]);
      const Eigen::VectorXd times = relativeTimes(recording_, around, rows[i]);
      const Eigen::Matrix3Xd weights = polynomialWeights(times, kOrder);
      const double here = recording_.positions(static_cast<Eigen::Index>(rows[i]), joint);
      const Eigen::VectorXd relative =
          recording_.positions.col(joint).segment(around.first, around.count).array() - here;
      const Eigen::Vector3d sums = weights * relative;
      motions[i].q[joint] = here + sums[0];
      motions[i].qd[joint] = sums[1];
      motions[i].qdd[joint] = sums[2];
    }
  }
  return motions;
}

}  // namespace virtual_work_dynamics
