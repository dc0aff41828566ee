#pragma once

#include <Eigen/Core>
#include <vector>

namespace virtual_work_dynamics {

/// How well a Motion is known. Coordinates are independent of each other.
struct MotionCovariance {
  /// For each generalized coordinate the covariance of (q, qd, qdd), in rad or m, per s and per
  /// s^2. It may be semidefinite or zero.
  std::vector<Eigen::Matrix3d> coordinates;
};

}  // namespace virtual_work_dynamics
