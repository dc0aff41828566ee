#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// How the child link of a joint that turns freely does so, relative to the parent link.
struct FreeTurn {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< R_PK, in the joint's frame
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();       ///< omega, child axes, rad/s
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< epsilon, child axes, rad/s^2
};

/// Sets the motion of a joint that turns freely: its orientation, and angles of zero with the rates
/// that turn it so, (2.5) and (2.7) for three successive turns about x, y and z:
///     qd = omega, qdd = epsilon - (omega_y omega_z, -omega_x omega_z, omega_x omega_y).
/// No orientation is singular. Does not allocate.
/// @param orientation of the joint, an index into Motion::orientations
void setFreeTurn(const Mechanism& mechanism, std::size_t orientation, const FreeTurn& turn,
                 Motion& motion);

/// The motion of such a joint, whatever its angles are. Does not allocate.
FreeTurn freeTurnOf(const Mechanism& mechanism, std::size_t orientation, const Motion& motion);

/// Turns all joints that turn freely on by their angles, which become zero: the same motion, as far
/// from where the angles are singular as can be. Does not allocate.
void foldFreeTurns(const Mechanism& mechanism, Motion& motion);

}  // namespace virtual_work_dynamics
