#include "estimator/savitzky_golay.h"

#include <algorithm>
#include <cmath>

#include "estimator/polynomial_window.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kOrder = 5;
constexpr double kGrowth = 1.12;
constexpr double kLongest = 0.9;  // s

std::vector<Motion> filter(const EncoderRecording& recording, const std::vector<std::size_t>& rows,
                           int window, bool from_velocities) {
  std::vector<Motion> motions;
  Eigen::Matrix3Xd weights;
  double weights_for = NAN;  // time of the first row of the window, relative to the instant
  for (const std::size_t row : rows) {
    const WindowRows around = windowAround(recording, row, window);
    const Eigen::VectorXd times = relativeTimes(recording, around, row);
    if (!(std::abs(times[0] - weights_for) < 1e-9)) {
      weights = polynomialWeights(times, kOrder);
      weights_for = times[0];
    }
    Eigen::Matrix3Xd sums = weightedPositions(recording, around, row, weights);
    if (from_velocities)
      sums.bottomRows(2) =
          weights.topRows(2) * recording.velocities.middleRows(around.first, around.count);
    motions.push_back(motionOf(sums));
  }
  return motions;
}

}  // namespace

SavitzkyGolay::SavitzkyGolay(const EncoderRecording& recording, const EffortJudge& judge)
    : error_(HUGE_VAL) {
  const double most =
      std::min(kLongest * recording.spec.rate, 0.5 * static_cast<double>(recording.rows()));
  for (double length = 7; length < most; length *= kGrowth) {
    const int window = static_cast<int>(length) | 1;
    for (const bool velocities : {false, true}) {
      if (velocities && !recording.spec.hasVelocities()) continue;
      const double error = judge.error(filter(recording, judge.rows(), window, velocities));
      if (!(error < error_)) continue;
      error_ = error;
      window_ = window;
      from_velocities_ = velocities;
    }
  }
}

std::vector<Motion> SavitzkyGolay::motions(const EncoderRecording& recording,
                                           const std::vector<std::size_t>& rows) const {
  return filter(recording, rows, window_, from_velocities_);
}

std::vector<Motion> nineSamples(const EncoderRecording& recording,
                                const std::vector<std::size_t>& rows) {
  constexpr int kWindow = 9;
  std::vector<Motion> motions;
  for (const std::size_t row : rows) {
    const WindowRows around = windowAround(recording, row, kWindow);
    const Eigen::Map<const Eigen::VectorXd> stamps(recording.stamps.data() + around.first,
                                                   around.count);
    const Eigen::VectorXd times = stamps.array() - recording.stamps[row];
    const bool velocities = recording.spec.hasVelocities();
    const double spacing = (times[kWindow - 1] - times[0]) / (kWindow - 1);
    const Eigen::Matrix3Xd weights = polynomialWeights(times, 3, velocities ? spacing : 0);
    Eigen::Matrix3Xd sums = weightedPositions(recording, around, row, weights);
    if (velocities)
      sums += weights.rightCols(kWindow) * recording.velocities.middleRows(around.first, kWindow);
    motions.push_back(motionOf(sums));
  }
  return motions;
}

}  // namespace virtual_work_dynamics
