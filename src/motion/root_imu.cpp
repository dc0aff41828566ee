#include "motion/root_imu.h"

#include <array>
#include <limits>

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

}  // namespace

RootImu::RootImu(const EstimatorSettings& settings, std::int64_t timeout_ns,
                 const Eigen::Vector3d& gravity)
    : timeout_ns_(timeout_ns), gravity_(gravity), tracks_(6, ofSamples(settings)) {}

RootImu::Verdict RootImu::push(const ImuSample& sample) {
  std::array<double, 6> values, rates;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto component = static_cast<Eigen::Index>(i);
    values[i] = sample.angular_velocity[component] / kRateUnit;
    values[i + 3] = sample.specific_force[component] / kForceUnit;
  }
  rates.fill(std::numeric_limits<double>::quiet_NaN());
  at_ = sample.at;
  return tracks_.push(sample.stamp_ns, values.data(), rates.data());
}

bool RootImu::read(std::int64_t stamp_ns, RootMotion& motion) {
  if (!tracks_.knows(stamp_ns, timeout_ns_)) return false;
  RootMotion found;
  Eigen::Vector3d force;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto component = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d rate = kRateUnit * tracks_.evaluate(i, stamp_ns);
    found.angular_velocity[component] = rate[0];
    found.angular_acceleration[component] = rate[1];
    force[component] = kForceUnit * tracks_.evaluate(i + 3, stamp_ns)[0];
  }
  const Eigen::Vector3d& w = found.angular_velocity;
  found.acceleration =
      force - found.angular_acceleration.cross(at_) - w.cross(w.cross(at_)) + gravity_;
  if (!found.finite()) return false;
  motion = found;
  foreseen_ = stamp_ns > last();
  return true;
}

}  // namespace virtual_work_dynamics
