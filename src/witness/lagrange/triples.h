#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "witness/lagrange/variation_frames.h"

namespace virtual_work_dynamics {

// Vectors and matrices of plain numbers.

template <typename Real>
Triple<Real> times(Real factor, const Triple<Real>& v) {
  return {factor * v[0], factor * v[1], factor * v[2]};
}

template <typename Real>
Triple<Real> cross(const Triple<Real>& a, const Triple<Real>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <typename Real>
Eigen::Vector3d toDouble(const Triple<Real>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

template <typename Real>
Triple<Real> tripleOf(const Eigen::Vector3d& v) {
  return {static_cast<Real>(v.x()), static_cast<Real>(v.y()), static_cast<Real>(v.z())};
}

template <typename Real>
Matrix<Real> crossMatrix(const Triple<Real>& v) {
  const Real zero = 0;
  return {{{zero, -v[2], v[1]}, {v[2], zero, -v[0]}, {-v[1], v[0], zero}}};
}

/// The transpose of the rotation that a quaternion of unit length stands for.
template <typename Real>
Matrix<Real> turnedBack(const Eigen::Quaterniond& q) {
  const Real w = q.w(), x = q.x(), y = q.y(), z = q.z();
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
           {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
           {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
}

}  // namespace virtual_work_dynamics
