#include "virtual_work_dynamics/motion_completion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "motion/largest_motion.h"
#include "motion/recording.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/unwrap.h"

namespace virtual_work_dynamics {
namespace {

void checkShapes(const Mechanism& mechanism, const MotionTable& motion, bool other_columns) {
  for (const std::string& name : motion.joints) {
    if (mechanism.coordinateIndex(name) < 0 && !other_columns) {
      throw MotionError("motion: " + inQuotes(name) +
                        " is not a generalized coordinate of the robot" +
                        nameHelp(name, mechanism.coordinateNames()));
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

// Values beyond any robot's would leave noises, and so results, that are not numbers.
void checkValues(const MotionTable& motion) {
  for (std::size_t row = 0; row < motion.times.size(); ++row) {
    if (std::abs(motion.times[row]) <= kLargestMotion) continue;
    throw MotionError("motion: the time of row " + std::to_string(row + 1) + " is " +
                      numberText(motion.times[row]) + ", too large to estimate anything from");
  }
  const std::array<std::pair<const char*, const Eigen::MatrixXd*>, 2> matrices{
      {{"position", &motion.positions}, {"velocity", &motion.velocities}}};
  for (const auto& [name, matrix] : matrices) {
    for (Eigen::Index column = 0; column < matrix->cols(); ++column) {
      for (Eigen::Index row = 0; row < matrix->rows(); ++row) {
        const double value = (*matrix)(row, column);
        if (std::abs(value) <= kLargestMotion) continue;
        throw MotionError(std::string("motion: the ") + name + " of '" +
                          motion.joints[static_cast<std::size_t>(column)] + "' in row " +
                          std::to_string(row + 1) + " is " + numberText(value) +
                          ", too large to estimate anything from");
      }
    }
  }
}

std::vector<RecordedStream> streamsOf(const MotionTable& motion) {
  std::vector<RecordedStream> streams(motion.joints.size());
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double* from = motion.positions.col(column).data();
    streams[i].positions.assign(from, from + motion.positions.rows());
    if (!motion.hasVelocities()) continue;
    from = motion.velocities.col(column).data();
    streams[i].velocities.assign(from, from + motion.positions.rows());
  }
  return streams;
}

bool leftOut(const RecordedStream& stream, std::size_t row) {
  return std::binary_search(stream.left_out.begin(), stream.left_out.end(), row);
}

/// The covariance of a recorded position with the rates that are estimated beside it. Errors of
/// estimates are orthogonal to what is measured, so that this position's error varies with theirs
/// as the estimated position's does.
Eigen::Matrix3d withRecorded(const RecordedStream& stream, const SmoothedSample& sample) {
  Eigen::Matrix3d covariance = sample.covariance;
  if (!stream.still)
    covariance(0, 0) = std::max(covariance(0, 0), stream.model.variance(sample.motion[1]));
  return covariance;
}

std::size_t gapsOf(const Recording& recording) {
  const std::vector<double>& times = recording.times();
  std::size_t gaps = 0;
  for (std::size_t row = 1; row < times.size(); ++row)
    gaps += times[row] - times[row - 1] > recording.longestGap() ? 1 : 0;
  return gaps;
}

// The rows within reach of what a joint is smoothed with, seen from an end, a gap or a jump.
std::vector<bool> rowsNearEnds(const Recording& recording, std::size_t joint) {
  // Most of the weight of a smoother lies within three time constants.
  constexpr double kReach = 3 / 6.283185307179586;
  const double reach = kReach / recording.quality(joint).bandwidth;
  const std::vector<double>& times = recording.times();
  const std::vector<std::size_t>& jumps = recording.stream(joint).jumps;
  std::vector<bool> near(times.size(), false);
  std::size_t first = 0;
  for (std::size_t row = 1; row <= times.size(); ++row) {
    if (row < times.size() && times[row] - times[row - 1] <= recording.longestGap() &&
        !std::binary_search(jumps.begin(), jumps.end(), row))
      continue;
    for (std::size_t i = first; i < row; ++i)
      near[i] = !(times[i] >= times[first] + reach && times[i] <= times[row - 1] - reach);
    first = row;
  }
  return near;
}

/// Rows whose estimates have rows on one side only, as those near an end, a gap or a jump do: by
/// how exact they are, as how far a smoother reaches says little of a slow motion without noise.
class OneSided {
 public:
  explicit OneSided(std::size_t rows) : rows_(rows, false) {}

  /// @param estimates of a joint, and their variances, by row.
  /// @param near rows within reach of an end. Where most are, the middle of all is no measure.
  template <typename Estimates>
  void add(const Estimates& estimates, const std::vector<double>& variances,
           const std::vector<bool>& near) {
    constexpr double kInexact = 2e-3;     // of the motion, where nothing better is known
    constexpr double kLessExact = 2;      // times the standard deviation in the middle of all rows
    constexpr double kNoticeable = 1e-4;  // of the motion: less of a deviation leaves no doubt
    std::vector<double> known;
    for (const double variance : variances)
      if (std::isfinite(variance)) known.push_back(variance);
    if (known.empty()) return;
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    const double square = estimates.array().square().mean();
    const double most =
        std::max(kLessExact * kLessExact * *middle, kNoticeable * kNoticeable * square);
    const auto count = static_cast<std::size_t>(std::count(near.begin(), near.end(), true));
    const double most_near =
        2 * count > near.size() ? std::min(most, kInexact * kInexact * square) : most;
    for (std::size_t row = 0; row < rows_.size(); ++row)
      if (!(variances[row] <= (near[row] ? most_near : most))) rows_[row] = true;
  }

  void report(CompletionReport& report) && {
    report.one_sided = static_cast<std::size_t>(std::count(rows_.begin(), rows_.end(), true));
    report.one_sided_rows = std::move(rows_);
  }

 private:
  std::vector<bool> rows_;
};

// Powers of times that are ages apart overflow.
void checkEstimates(const MotionTable& motion) {
  for (Eigen::Index row = 0; row < motion.velocities.rows(); ++row) {
    if (motion.positions.row(row).allFinite() && motion.velocities.row(row).allFinite() &&
        motion.accelerations.row(row).allFinite())
      continue;
    throw MotionError("motion: what is estimated in row " + std::to_string(row + 1) +
                      " is not finite; times reach from " + numberText(motion.times.front()) +
                      " to " + numberText(motion.times.back()) + " s");
  }
}

}  // namespace

std::size_t firstTimeThatDoesNotIncrease(const std::vector<double>& times) {
  for (std::size_t row = 1; row < times.size(); ++row) {
    if (!(times[row] > times[row - 1])) return row;
  }
  return times.size();
}

MotionTable completeMotion(const Mechanism& mechanism, MotionTable motion,
                           const CompletionSettings& settings, CompletionReport* report) {
  if (report != nullptr) *report = CompletionReport();
  checkShapes(mechanism, motion, settings.other_columns);
  unwrapPositions(mechanism, motion);
  const bool complete = motion.hasVelocities() && motion.hasAccelerations();
  if (complete || motion.positions.size() == 0) return motion;
  checkRows(motion);
  checkValues(motion);
  Recording recording(motion.times, streamsOf(motion), settings);
  const std::size_t steps = motion.joints.size() * (Recording::kModels + 1);
  std::size_t done = 0;
  const auto did = [&](std::size_t more) {
    done += more;
    if (settings.progress) settings.progress(done, steps);
  };
  recording.identify(did);
  const bool given = motion.hasAccelerations();
  motion.velocities.resize(motion.positions.rows(), motion.positions.cols());
  if (!given) motion.accelerations.resize(motion.positions.rows(), motion.positions.cols());
  const std::size_t joints = motion.joints.size();
  if (settings.covariances)
    motion.covariances.assign(motion.times.size() * joints, Eigen::Matrix3d::Zero());
  OneSided one_sided(motion.times.size());
  std::vector<double> variances(report == nullptr ? 0 : motion.times.size());
  for (std::size_t joint = 0; joint < joints; ++joint) {
    const auto column = static_cast<Eigen::Index>(joint);
    const RecordedStream& stream = recording.stream(joint);
    const auto take = [&](std::size_t row, const SmoothedSample& sample) {
      const auto at = static_cast<Eigen::Index>(row);
      motion.velocities(at, column) = sample.motion[1];
      const bool keep = given || (settings.keep_positions && !leftOut(stream, row));
      if (settings.covariances)
        motion.covariances[row * joints + joint] =
            keep ? withRecorded(stream, sample) : sample.covariance;
      if (report != nullptr) variances[row] = sample.covariance(given ? 1 : 2, given ? 1 : 2);
      if (given) return;
      if (!keep) motion.positions(at, column) = sample.motion[0];
      motion.accelerations(at, column) = sample.motion[2];
    };
    recording.smooth(joint, settings.covariances || report != nullptr, take);
    if (report != nullptr && !stream.still)
      one_sided.add(given ? motion.velocities.col(column) : motion.accelerations.col(column),
                    variances, rowsNearEnds(recording, joint));
    did(1);
  }
  checkEstimates(motion);
  if (report != nullptr) {
    *report = CompletionReport();
    report->estimated = true;
    report->even_clock = recording.evenClock();
    for (std::size_t joint = 0; joint < joints; ++joint) {
      report->qualities.push_back(recording.quality(joint));
      const RecordedStream& stream = recording.stream(joint);
      report->still.push_back(stream.still);
      report->jumps.push_back(stream.jumps);
      report->left_out.push_back(stream.left_out);
    }
    report->gaps = gapsOf(recording);
    std::move(one_sided).report(*report);
  }
  return motion;
}

}  // namespace virtual_work_dynamics
