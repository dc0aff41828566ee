#include "motion/root_estimator.h"

#include <array>
#include <cstdlib>

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kCoordinates = RootCoordinates::RowsAtCompileTime;

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
      timeout_ns_(timeout_ns),
      tracks_(kCoordinates, ofPoses(settings)) {}

RootEstimator::Verdict RootEstimator::push(const RootPose& pose) {
  RootMotion motion;
  motion.position = pose.position;
  motion.orientation = pose.orientation;
  motion.velocity = pose.velocity;
  motion.angular_velocity = pose.angular_velocity;
  RootCoordinates coordinates = coordinatesOf(motion);
  const bool first = tracks_.startsWith(pose.stamp_ns);
  if (!first) chooseSign(newest_, coordinates);
  if (first || pose.stamp_ns > last()) newest_ = coordinates;
  return tracks_.push(pose.stamp_ns, coordinates.col(0).data(), coordinates.col(1).data());
}

bool RootEstimator::read(std::int64_t stamp_ns, RootMotion& motion, RootCovariance* covariance) {
  if (!estimate_) {
    if (covariance) covariance->setZero();
    return readAsItCame(stamp_ns, motion);
  }
  if (!tracks_.knows(stamp_ns, timeout_ns_)) return false;
  RootCoordinates coordinates;
  RootCoordinateCovariances each;
  for (std::size_t i = 0; i < kCoordinates; ++i) {
    coordinates.row(static_cast<Eigen::Index>(i)) =
        tracks_.evaluate(i, stamp_ns, covariance ? &each[i] : nullptr).transpose();
  }
  const RootMotion found = rootMotionOf(coordinates);
  if (!found.finite()) return false;
  motion = found;
  if (covariance) *covariance = rootCovarianceOf(found, each);
  foreseen_ = stamp_ns > last();
  return true;
}

void RootEstimator::getStreams(std::vector<RootStream>& streams) const {
  std::array<StreamQuality, 4> quaternion;
  for (std::size_t i = 0; i < quaternion.size(); ++i) quaternion[i] = quality(3 + i);
  streams.clear();
  streams.push_back({"root.position.x", "m", "position noise", quality(0)});
  streams.push_back({"root.position.y", "m", "position noise", quality(1)});
  streams.push_back({"root.position.z", "m", "position noise", quality(2)});
  streams.push_back({"root.orientation", "rad", "noise", turnQuality(quaternion)});
}

// Where nothing is estimated, the newest pose holds, with its rates where they are given.
bool RootEstimator::readAsItCame(std::int64_t stamp_ns, RootMotion& motion) {
  if (empty() || std::abs(stamp_ns - last()) > timeout_ns_) return false;
  RootCoordinates coordinates = newest_;
  if (!coordinates.col(1).allFinite()) coordinates.col(1).setZero();
  coordinates.col(2).setZero();
  motion = rootMotionOf(coordinates);
  motion.angular_acceleration.setZero();
  foreseen_ = false;
  return true;
}

}  // namespace virtual_work_dynamics
