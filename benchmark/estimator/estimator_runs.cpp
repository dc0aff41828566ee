#include "estimator/estimator_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <utility>

namespace virtual_work_dynamics {
namespace {

constexpr std::array<int, kArmJoints> kCoordinates{0, 1, 2, 3, 4, 5};
constexpr double kEpoch = 1.7e9;  // s, which stamps of a real clock are near

/// Stamps in ns and rows side by side, as a driver sends them.
class Messages {
 public:
  explicit Messages(const EncoderRecording& recording)
      : positions_(recording.positions.transpose()), velocities_(recording.velocities.transpose()) {
    for (const double stamp : recording.stamps)
      stamps_.push_back(static_cast<std::int64_t>(kEpoch) * 1000000000 + std::llround(1e9 * stamp));
  }

  std::int64_t stamp(std::size_t row) const { return stamps_[row]; }
  void push(std::size_t row, MotionEstimator& estimator) const {
    const auto column = static_cast<Eigen::Index>(row);
    estimator.push(stamps_[row], kCoordinates.data(), positions_.col(column).data(),
                   velocities_.size() > 0 ? velocities_.col(column).data() : nullptr, kArmJoints);
  }

 private:
  std::vector<std::int64_t> stamps_;
  Eigen::MatrixXd positions_;
  Eigen::MatrixXd velocities_;
};

}  // namespace

EstimatedRows complete(const Mechanism& mechanism, const EncoderRecording& recording,
                       const std::vector<std::size_t>& rows, const CompletionSettings& settings) {
  MotionTable table;
  table.joints = mechanism.coordinateNames();
  table.times = recording.stamps;
  table.positions = recording.positions;
  table.velocities = recording.velocities;
  CompletionSettings with_covariances = settings;
  with_covariances.covariances = true;
  CompletionReport report;
  table = completeMotion(mechanism, std::move(table), with_covariances, &report);
  EstimatedRows estimated;
  estimated.qualities = report.qualities;
  for (const std::size_t row : rows) {
    const auto at = static_cast<Eigen::Index>(row);
    Motion motion(kArmJoints);
    motion.q = table.positions.row(at);
    motion.qd = table.velocities.row(at);
    motion.qdd = table.accelerations.row(at);
    estimated.motions.push_back(motion);
    MotionCovariance covariance;
    const auto first = table.covariances.begin() + static_cast<std::ptrdiff_t>(row * kArmJoints);
    covariance.coordinates.assign(first, first + kArmJoints);
    estimated.covariances.push_back(covariance);
  }
  return estimated;
}

EstimatedRows estimate(const Mechanism& mechanism, const EncoderRecording& recording,
                       const std::vector<std::size_t>& rows, const EstimatorSettings& settings) {
  MotionEstimator estimator(mechanism, settings);
  const Messages messages(recording);
  EstimatedRows estimated;
  estimated.motions.resize(rows.size());
  estimated.covariances.resize(rows.size());
  Motion motion(kArmJoints);
  MotionCovariance covariance;
  covariance.coordinates.resize(kArmJoints);
  std::size_t next = 0;
  for (std::size_t row = 0; row < recording.rows() && next < rows.size(); ++row) {
    messages.push(row, estimator);
    // Only instants near to a wanted row are worth evaluating.
    const std::int64_t before =
        rows[next] > 0 ? messages.stamp(rows[next] - 1) : messages.stamp(0) - 1;
    const double newest = 1e-9 * static_cast<double>(messages.stamp(row) - before);
    if (newest < settings.lag) {
      estimator.skip();
      continue;
    }
    while (estimator.ready()) {
      const std::int64_t instant = estimator.evaluate(motion, &covariance);
      while (next < rows.size() && messages.stamp(rows[next]) < instant) ++next;
      if (next == rows.size() || messages.stamp(rows[next]) != instant) continue;
      estimated.motions[next] = motion;
      estimated.covariances[next] = covariance;
      ++next;
    }
  }
  for (int joint = 0; joint < kArmJoints; ++joint)
    estimated.qualities.push_back(estimator.quality(joint));
  for (const Motion& given : estimated.motions) estimated.missing += given.q.size() == 0 ? 1 : 0;
  return estimated;
}

double timePerSample(const Mechanism& mechanism, const EncoderRecording& recording,
                     const EstimatorSettings& settings) {
  constexpr int kRounds = 5;
  const Messages messages(recording);
  const auto warm = static_cast<std::size_t>(recording.spec.rate);
  double least = HUGE_VAL;
  for (int round = 0; round < kRounds; ++round) {
    MotionEstimator estimator(mechanism, settings);
    Motion motion(kArmJoints);
    std::clock_t start = 0;
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      if (row == warm) start = std::clock();
      messages.push(row, estimator);
      while (estimator.ready()) estimator.evaluate(motion);
    }
    const double time = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    least = std::min(least, 1e9 * time / static_cast<double>(recording.rows() - warm));
  }
  return least;
}

}  // namespace virtual_work_dynamics
