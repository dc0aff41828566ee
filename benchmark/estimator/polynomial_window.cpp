#include "estimator/polynomial_window.h"

#include <Eigen/Dense>
#include <algorithm>

namespace virtual_work_dynamics {

Eigen::Matrix3Xd polynomialWeights(const Eigen::VectorXd& times, int order, double velocity_scale) {
  const Eigen::Index count = times.size();
  const bool velocities = velocity_scale > 0;
  const double half = times.cwiseAbs().maxCoeff();
  Eigen::MatrixXd powers(velocities ? 2 * count : count, order + 1);
  powers.col(0).setZero();
  powers.col(0).head(count).setOnes();
  for (int k = 1; k <= order; ++k) {
    powers.col(k).head(count) = powers.col(k - 1).head(count).cwiseProduct(times / half);
    if (velocities)
      powers.col(k).tail(count) = velocity_scale * k / half * powers.col(k - 1).head(count);
  }
  Eigen::MatrixXd first = Eigen::MatrixXd::Zero(order + 1, 3);
  first(0, 0) = 1;
  first(1, 1) = 1 / half;
  first(2, 2) = 2 / (half * half);
  const Eigen::MatrixXd normal = powers.transpose() * powers;
  Eigen::Matrix3Xd weights = normal.ldlt().solve(first).transpose() * powers.transpose();
  if (velocities) weights.rightCols(count) *= velocity_scale;
  return weights;
}

WindowRows windowAround(const EncoderRecording& recording, std::size_t row, int window) {
  const Eigen::Index rows = recording.positions.rows();
  const Eigen::Index count = std::min<Eigen::Index>(window, rows);
  const Eigen::Index first = static_cast<Eigen::Index>(row) - count / 2;
  return {std::clamp<Eigen::Index>(first, 0, rows - count), count};
}

Eigen::VectorXd relativeTimes(const EncoderRecording& recording, const WindowRows& window,
                              std::size_t row) {
  const Eigen::Map<const Eigen::VectorXd> times(recording.times.data(),
                                                static_cast<Eigen::Index>(recording.rows()));
  return times.segment(window.first, window.count).array() - recording.times[row];
}

Eigen::Matrix3Xd weightedPositions(const EncoderRecording& recording, const WindowRows& window,
                                   std::size_t row, const Eigen::Matrix3Xd& weights) {
  const Eigen::RowVectorXd here = recording.positions.row(static_cast<Eigen::Index>(row));
  const Eigen::MatrixXd relative =
      recording.positions.middleRows(window.first, window.count).rowwise() - here;
  Eigen::Matrix3Xd sums = weights.leftCols(window.count) * relative;
  sums.row(0) += here;
  return sums;
}

Motion motionOf(const Eigen::Matrix3Xd& sums) {
  Motion motion(sums.cols());
  motion.q = sums.row(0);
  motion.qd = sums.row(1);
  motion.qdd = sums.row(2);
  return motion;
}

}  // namespace virtual_work_dynamics
