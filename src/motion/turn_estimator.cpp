#include "motion/turn_estimator.h"

#include <array>
#include <cmath>

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kNumbers = 4;
constexpr std::size_t kFirst = 3;  // of a quaternion, in RootCoordinates

// What is known beforehand of orientations; see RootEstimator.
EstimatorSettings ofOrientations(EstimatorSettings settings) {
  const bool use_velocity = settings.noise.use_velocity;
  settings.noise = NoiseSettings();
  settings.noise.use_velocity = use_velocity;
  settings.noise.stamp_noise = 0;
  return settings;
}

FreeTurn inChildAxes(const RootMotion& motion) {
  const Eigen::Quaterniond back = motion.orientation.conjugate();
  return {motion.orientation, back * motion.angular_velocity, back * motion.angular_acceleration};
}

}  // namespace

TurnEstimator::TurnEstimator(const EstimatorSettings& settings)
    : estimate_(settings.estimate),
      timeout_ns_(std::llround(settings.hold_after * 1e9)),
      tracks_(kNumbers, ofOrientations(settings)) {}

TurnEstimator::Verdict TurnEstimator::push(const TurnSample& sample) {
  RootMotion motion;
  motion.orientation = sample.orientation;
  motion.angular_velocity = sample.angular_velocity;
  RootCoordinates coordinates = coordinatesOf(motion);
  const bool first = tracks_.startsWith(sample.stamp_ns);
  if (!first) chooseSign(newest_, coordinates);
  if (first || sample.stamp_ns > tracks_.last()) newest_ = coordinates;
  return tracks_.push(sample.stamp_ns, coordinates.col(0).data() + kFirst,
                      coordinates.col(1).data() + kFirst);
}

bool TurnEstimator::read(std::int64_t stamp_ns, FreeTurn& turn, TurnCovariance* covariance) const {
  if (covariance) covariance->setZero();
  if (!estimate_) {
    if (empty()) return false;
    turn = newest();
    return true;
  }
  if (!tracks_.knows(stamp_ns, timeout_ns_)) return false;
  RootCoordinates coordinates = RootCoordinates::Zero();
  RootCoordinateCovariances each;
  for (std::size_t i = 0; i < kNumbers; ++i) {
    coordinates.row(static_cast<Eigen::Index>(kFirst + i)) =
        tracks_.evaluate(i, stamp_ns, covariance ? &each[kFirst + i] : nullptr).transpose();
  }
  const RootMotion found = rootMotionOf(coordinates);
  if (!found.finite()) return false;
  turn = inChildAxes(found);
  if (covariance) *covariance = inBodyAxes(turn, turnCovarianceOf(found, each));
  return true;
}

FreeTurn TurnEstimator::heldAt(std::int64_t stamp_ns) const {
  RootCoordinates coordinates = RootCoordinates::Zero();
  for (std::size_t i = 0; i < kNumbers; ++i)
    coordinates(static_cast<Eigen::Index>(kFirst + i), 0) = tracks_.before(i, stamp_ns);
  return inChildAxes(rootMotionOf(coordinates));
}

// Where nothing is estimated, it holds with its rates as far as these are given.
FreeTurn TurnEstimator::newest() const {
  RootCoordinates coordinates = newest_;
  if (!coordinates.col(1).tail<4>().allFinite()) coordinates.col(1).setZero();
  coordinates.col(2).setZero();
  FreeTurn turn = inChildAxes(rootMotionOf(coordinates));
  turn.angular_acceleration.setZero();
  return turn;
}

StreamQuality TurnEstimator::quality() const {
  std::array<StreamQuality, kNumbers> numbers;
  for (std::size_t i = 0; i < kNumbers; ++i) numbers[i] = tracks_.quality(i);
  return turnQuality(numbers);
}

}  // namespace virtual_work_dynamics
