#pragma once

#include <Eigen/Core>

#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

/// Motion of a mechanism at one instant. Each vector has one entry for each generalized coordinate,
/// in the order of Mechanism::coordinates(); the root link rests unless the scene says that it
/// moves.
struct Motion {
  Motion() = default;

  /// All zero, for `coordinates` generalized coordinates. Allocates.
  explicit Motion(Eigen::Index coordinates)
      : q(Eigen::VectorXd::Zero(coordinates)),
        qd(Eigen::VectorXd::Zero(coordinates)),
        qdd(Eigen::VectorXd::Zero(coordinates)) {}

  bool finite() const {
    return q.allFinite() && qd.allFinite() && qdd.allFinite() && root.finite();
  }

  Eigen::VectorXd q;    ///< positions, rad or m
  Eigen::VectorXd qd;   ///< velocities, rad/s or m/s
  Eigen::VectorXd qdd;  ///< accelerations, rad/s^2 or m/s^2
  RootMotion root;
};

}  // namespace virtual_work_dynamics
