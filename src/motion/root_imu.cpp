#include "motion/root_imu.h"

#include <array>
#include <limits>

#include "base/cross_matrix.h"

namespace virtual_work_dynamics {
namespace {

// A track takes steps for jumps that the position of no joint makes, by sizes in rad or m. Rates
// and accelerations, which are larger and rougher, are tracked in these units.
constexpr double kRateUnit = 100;    // rad/s
constexpr double kForceUnit = 1000;  // m/s^2

// What is known beforehand of the samples. Their stamps are taken for exact, as those of poses.
EstimatorSettings ofSamples(EstimatorSettings settings) {
  settings.noise = NoiseSettings();
  settings.noise.stamp_noise = 0;
  return settings;
}

// Of the components of angular velocity and specific force in their units, with their derivatives.
struct SampleCovariances {
  std::array<Eigen::Matrix3d, 3> rate, force;
};

// What holds before the timeout is the unit's own.
EstimatorSettings ofOrientation(EstimatorSettings settings, std::int64_t timeout_ns) {
  settings.hold_after = static_cast<double>(timeout_ns) / 1e9;
  return settings;
}

// The orientation counts as exact: efforts and reactions in the axes of links do not depend on it.
RootCovariance covarianceOf(const SampleCovariances& of, const Eigen::Vector3d& w,
                            const Eigen::Vector3d& at, const Eigen::Quaterniond& orientation) {
  Eigen::Matrix<double, 9, 9> measured = Eigen::Matrix<double, 9, 9>::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto component = static_cast<std::size_t>(i);
    const Eigen::Matrix3d rate = kRateUnit * kRateUnit * of.rate[component];
    measured(i, i) = rate(0, 0);
    measured(3 + i, 3 + i) = rate(1, 1);
    measured(i, 3 + i) = measured(3 + i, i) = rate(0, 1);
    measured(6 + i, 6 + i) = kForceUnit * kForceUnit * of.force[component](0, 0);
  }
  // The acceleration is f - e x at - w x (w x at).
  Eigen::Matrix<double, 9, 9> by = Eigen::Matrix<double, 9, 9>::Identity();
  by.block<3, 3>(6, 0) = crossMatrix(w.cross(at)) + crossMatrix(w) * crossMatrix(at);
  by.block<3, 3>(6, 3) = crossMatrix(at);
  const Eigen::Matrix3d R = orientation.toRotationMatrix();
  for (Eigen::Index i = 0; i < 9; i += 3) by.middleRows<3>(i) = (R * by.middleRows<3>(i)).eval();
  RootCovariance covariance = RootCovariance::Zero();
  covariance.bottomRightCorner<9, 9>() = by * measured * by.transpose();
  return covariance;
}

}  // namespace

RootImu::RootImu(const EstimatorSettings& settings, std::int64_t timeout_ns,
                 const Eigen::Vector3d& gravity, bool oriented)
    : timeout_ns_(timeout_ns), gravity_(gravity), tracks_(6, ofSamples(settings)) {
  if (oriented) turn_.emplace(ofOrientation(settings, timeout_ns));
}

RootImu::Verdict RootImu::push(const ImuSample& sample) {
  std::array<double, 6> values, rates;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto component = static_cast<Eigen::Index>(i);
    values[i] = sample.angular_velocity[component] / kRateUnit;
    values[i + 3] = sample.specific_force[component] / kForceUnit;
  }
  rates.fill(std::numeric_limits<double>::quiet_NaN());
  // Of another unit, nothing is known of what it measured before.
  if (sample.link != link_ || sample.at != at_) {
    tracks_.restart();
    if (turn_) turn_->restart();
  }
  link_ = sample.link;
  at_ = sample.at;
  if (turn_) {
    TurnSample turn;
    turn.stamp_ns = sample.stamp_ns;
    turn.orientation = sample.orientation;
    turn_->push(turn);
  }
  return tracks_.push(sample.stamp_ns, values.data(), rates.data());
}

bool RootImu::read(std::int64_t stamp_ns, RootMotion& motion, RootCovariance* covariance) {
  if (!tracks_.knows(stamp_ns, timeout_ns_)) return false;
  FreeTurn turn;
  if (turn_ && !turn_->read(stamp_ns, turn, nullptr)) return false;
  RootMotion found;
  Eigen::Vector3d force;
  SampleCovariances of;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto component = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d rate =
        kRateUnit * tracks_.evaluate(i, stamp_ns, covariance ? &of.rate[i] : nullptr);
    found.angular_velocity[component] = rate[0];
    found.angular_acceleration[component] = rate[1];
    force[component] =
        kForceUnit * tracks_.evaluate(i + 3, stamp_ns, covariance ? &of.force[i] : nullptr)[0];
  }
  const Eigen::Vector3d w = found.angular_velocity;
  force -= found.angular_acceleration.cross(at_) + w.cross(w.cross(at_));
  found.orientation = turn.orientation;
  found.angular_velocity = turn.orientation * w;
  found.angular_acceleration = turn.orientation * found.angular_acceleration;
  found.acceleration = turn.orientation * force + gravity_;
  if (!found.finite()) return false;
  motion = found;
  if (covariance) *covariance = covarianceOf(of, w, at_, turn.orientation);
  foreseen_ = stamp_ns > last();
  return true;
}

void RootImu::getStreams(std::vector<RootStream>& streams) const {
  constexpr std::array<const char*, 6> kNames = {
      "root.angular_velocity.x", "root.angular_velocity.y", "root.angular_velocity.z",
      "root.specific_force.x",   "root.specific_force.y",   "root.specific_force.z"};
  streams.clear();
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const bool rate = i < 3;
    streams.push_back({kNames[i], rate ? "rad/s" : "m/s^2", "noise", tracks_.quality(i)});
    streams.back().quality.position_noise *= rate ? kRateUnit : kForceUnit;
  }
  if (turn_) streams.push_back({"root.orientation", "rad", "noise", turn_->quality()});
}

}  // namespace virtual_work_dynamics
