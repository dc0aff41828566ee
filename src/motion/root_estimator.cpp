#include "motion/root_estimator.h"

#include <algorithm>
#include <cmath>

#include "motion/sample_blocks.h"

namespace virtual_work_dynamics {
namespace {

constexpr Eigen::Index kCoordinates = RootCoordinates::RowsAtCompileTime;
/// Poses one after the other that are behind the newest one before time is taken to have gone back.
constexpr int kPatience = 10;

// What is known beforehand of the coordinates of poses.
EstimatorSettings ofPoses(EstimatorSettings settings) {
  const bool use_velocity = settings.noise.use_velocity;
  settings.noise = NoiseSettings();
  settings.noise.use_velocity = use_velocity;
  settings.noise.stamp_noise = 0;
  return settings;
}

}  // namespace

RootEstimator::RootEstimator(const EstimatorSettings& settings, std::int64_t timeout_ns)
    : estimate_(settings.estimate),
      max_gap_ns_(std::llround(std::min(settings.max_gap, 4e9) * 1e9)),
      timeout_ns_(timeout_ns) {
  Joint coordinate;
  coordinate.type = JointType::kPrismatic;  // has no turns to be put back
  tracks_.reserve(static_cast<std::size_t>(kCoordinates));
  for (Eigen::Index i = 0; i < kCoordinates; ++i)
    tracks_.emplace_back(coordinate, ofPoses(settings));
}

void RootEstimator::clear() {
  for (CoordinateTrack& track : tracks_) track.clear();
  behind_ = 0;
}

RootEstimator::Verdict RootEstimator::push(const RootPose& pose) {
  RootMotion motion;
  motion.position = pose.position;
  motion.orientation = pose.orientation;
  motion.velocity = pose.velocity;
  motion.angular_velocity = pose.angular_velocity;
  RootCoordinates coordinates = coordinatesOf(motion);
  if (empty()) return take(pose, coordinates);
  const std::int64_t ahead = pose.stamp_ns - last();
  const bool again = -ahead > max_gap_ns_ || behind_ >= kPatience;
  if (again) clear();
  if (!again) chooseSign(newest_, coordinates);
  const Verdict verdict = take(pose, coordinates);
  if (again) return Verdict::kRestartedBack;
  if (ahead > 0) interval_ = static_cast<double>(ahead) / 1e9;
  behind_ = ahead < 0 ? behind_ + 1 : 0;
  return verdict;
}

RootEstimator::Verdict RootEstimator::take(const RootPose& pose,
                                           const RootCoordinates& coordinates) {
  const bool newest = empty() || pose.stamp_ns > last();
  Verdict verdict = Verdict::kAccepted;
  for (Eigen::Index i = 0; i < kCoordinates; ++i) {
    CoordinateTrack& track = tracks_[static_cast<std::size_t>(i)];
    switch (track.push(pose.stamp_ns, coordinates(i, 0), coordinates(i, 1))) {
      case CoordinateTrack::Verdict::kTaken:
        break;
      case CoordinateTrack::Verdict::kInserted:
        verdict = Verdict::kReordered;
        break;
      case CoordinateTrack::Verdict::kTooLate:
        verdict = Verdict::kTooLate;
        break;
      case CoordinateTrack::Verdict::kEqualStamp:
        verdict = Verdict::kEqualStamp;
        break;
      case CoordinateTrack::Verdict::kAfterGap:
        verdict = Verdict::kAfterGap;
        break;
    }
  }
  if (newest) newest_ = coordinates;
  tracks_.front().nextInstant(std::numeric_limits<std::int64_t>::min(), 0, first_);
  return verdict;
}

bool RootEstimator::read(std::int64_t stamp_ns, RootMotion& motion) {
  if (empty()) return false;
  if (!estimate_) return readAsItCame(stamp_ns, motion);
  if (stamp_ns < first_) return false;
  const auto known = [&](const CoordinateTrack& track) {
    return track.covers(stamp_ns, timeout_ns_);
  };
  if (!std::all_of(tracks_.begin(), tracks_.end(), known)) return false;
  RootCoordinates coordinates;
  for (Eigen::Index i = 0; i < kCoordinates; ++i) {
    coordinates.row(i) =
        tracks_[static_cast<std::size_t>(i)].evaluate(stamp_ns, nullptr).transpose();
  }
  const RootMotion found = rootMotionOf(coordinates);
  if (!found.finite()) return false;
  motion = found;
  foreseen_ = stamp_ns > last();
  return true;
}

// Where nothing is estimated, the newest pose holds, with its rates where they are given.
bool RootEstimator::readAsItCame(std::int64_t stamp_ns, RootMotion& motion) {
  if (std::abs(stamp_ns - last()) > timeout_ns_) return false;
  RootCoordinates coordinates = newest_;
  if (!coordinates.col(1).allFinite()) coordinates.col(1).setZero();
  coordinates.col(2).setZero();
  motion = rootMotionOf(coordinates);
  motion.angular_acceleration.setZero();
  foreseen_ = false;
  return true;
}

}  // namespace virtual_work_dynamics
