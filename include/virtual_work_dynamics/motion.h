#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

/// Motion of a mechanism at one instant. Each vector has one entry for each generalized coordinate,
/// in the order of Mechanism::coordinates(); the root link rests unless the scene says that it
/// moves.
struct Motion {
  Motion() = default;

  /// All zero, for `coordinates` generalized coordinates and so many orientations. Allocates.
  explicit Motion(Eigen::Index coordinates, std::size_t orientation_count = 0)
      : q(Eigen::VectorXd::Zero(coordinates)),
        qd(Eigen::VectorXd::Zero(coordinates)),
        qdd(Eigen::VectorXd::Zero(coordinates)),
        orientations(orientation_count, Eigen::Quaterniond::Identity()) {}

  bool finite() const {
    return q.allFinite() && qd.allFinite() && qdd.allFinite() && root.finite() &&
           std::all_of(orientations.begin(), orientations.end(),
                       [](const Eigen::Quaterniond& q_PK) { return q_PK.coeffs().allFinite(); });
  }

  Eigen::VectorXd q;    ///< positions, rad or m
  Eigen::VectorXd qd;   ///< velocities, rad/s or m/s
  Eigen::VectorXd qdd;  ///< accelerations, rad/s^2 or m/s^2
  /// Empty: all are the identity. Of each joint that turns freely, Mechanism::freeJoint(): R_PK of
  /// its child link where its three angles are zero, in the joint's frame on the parent, of unit
  /// length. The angles turn on from there, about x, then y, then z of the child. With angles of
  /// zero, see setFreeTurn(), their velocities are the components of the relative angular velocity
  /// in child axes.
  std::vector<Eigen::Quaterniond> orientations;
  RootMotion root;
};

}  // namespace virtual_work_dynamics
