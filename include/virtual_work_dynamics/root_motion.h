#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace virtual_work_dynamics {

/// Motion of the root link against an inertial frame at one instant: vectors of its origin, in
/// inertial axes. At rest, with the axes of the inertial frame, unless something else is said. Only
/// scenes in which the root moves (Scene::root_moves) look at it.
struct RootMotion {
  bool finite() const {
    return position.allFinite() && orientation.coeffs().allFinite() && velocity.allFinite() &&
           angular_velocity.allFinite() && acceleration.allFinite() &&
           angular_acceleration.allFinite();
  }

  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< m; no result depends on it
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< R_I0, of unit length
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();              ///< m/s; no result depends on it
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      ///< rad/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          ///< without gravity, m/s^2
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< rad/s^2
};

/// What the dynamics need of the motion of a root link: how its points accelerate, less gravity, in
/// its own axes. (2.5) and (2.7) start from it.
struct RootState {
  /// @param gravity in inertial axes, m/s^2
  /// @param rests whether velocities and accelerations count as zero; the orientation does not
  RootState(const RootMotion& motion, const Eigen::Vector3d& gravity, bool rests);

  static constexpr int kNumbers = 9;
  /// The numbers of the three vectors, one after the other.
  const double* data() const { return angular_velocity.data(); }

  Eigen::Vector3d angular_velocity;      ///< omega, rad/s
  Eigen::Vector3d angular_acceleration;  ///< epsilon, rad/s^2
  Eigen::Vector3d acceleration;          ///< gamma - g of the origin, m/s^2
};

}  // namespace virtual_work_dynamics
