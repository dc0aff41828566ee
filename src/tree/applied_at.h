#pragma once

#include "tree/plan_types.h"

namespace virtual_work_dynamics {

/// Returns A v.
template <typename R, typename T>
Vec3<T> appliedTimes(const Mat3<R>& A, const Vec3<T>& v) {
  return {A.xx * v.x + A.xy * v.y + A.xz * v.z, A.yx * v.x + A.yy * v.y + A.yz * v.z,
          A.zx * v.x + A.zy * v.y + A.zz * v.z};
}

/// An applied wrench as the kernels read it: in Z axes and about O_k where `given` is in link axes.
template <typename R, typename T>
PlainWrench<T> appliedAt(const AppliedOutside<R>& where, const PlainWrench<T>& given) {
  if (where.in_root_axes) return given;
  const Vec3<T> force = appliedTimes(where.R_ZL, given.force);
  const Vec3<T> torque = appliedTimes(where.R_ZL, given.torque);
  const Vec3<R>& p = where.p_ZoA_Z;
  return {force,
          {torque.x + (p.y * force.z - p.z * force.y), torque.y + (p.z * force.x - p.x * force.z),
           torque.z + (p.x * force.y - p.y * force.x)}};
}

}  // namespace virtual_work_dynamics
