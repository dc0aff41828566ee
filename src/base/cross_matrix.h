#pragma once

#include <Eigen/Core>

namespace virtual_work_dynamics {

/// The matrix whose product with a vector x is v x x.
inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

}  // namespace virtual_work_dynamics
