#pragma once

#include <Eigen/Core>
#include <vector>

#include "generate/recorded_number.h"
#include "tree/vec3.h"

namespace virtual_work_dynamics {

using TermVector = Vec3<Term>;
using Terms = std::vector<Term>;

/// Terms as kernels see numbers, of which they have the size.
inline double* numbersOf(Terms& terms) {
  return reinterpret_cast<double*>(terms.data());
}
inline const double* numbersOf(const Terms& terms) {
  return reinterpret_cast<const double*>(terms.data());
}

// Products and sums that the package does not fuse, in the order of Eigen's.
inline Term plainDot(const TermVector& a, const TermVector& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
inline TermVector plainCross(const TermVector& a, const TermVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline TermVector times(const Term& s, const TermVector& v) {
  return {s * v.x, s * v.y, s * v.z};
}
inline TermVector over(const TermVector& v, const Term& s) {
  return {v.x / s, v.y / s, v.z / s};
}
inline TermVector plainTurned(const Term* R, const Eigen::Vector3d& v) {
  const auto part = [&](int i, int j) { return R[i + 3 * j] * Term(v[j]); };
  return {(part(0, 0) + part(0, 1)) + part(0, 2), (part(1, 0) + part(1, 1)) + part(1, 2),
          part(2, 0) + (part(2, 1) + part(2, 2))};
}

}  // namespace virtual_work_dynamics
