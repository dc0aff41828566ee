#pragma once

#include "tree/kernel/vec3_operations.h"
#include "tree/plan_types.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

template <AxisDirection kValue>
struct AxisIs {
  static constexpr AxisDirection value = kValue;
};

// Products with R_PZ of a body. Where the joint's axis lies in a coordinate plane of the parent's
// frame four products remain of nine, and along an axis of it none: Q of canonicalRotation(), whose
// third column is that axis.

template <AxisDirection kAxis, typename S, typename T>
VWD_INLINE Vec3<T> toParent(const Mat3<S>& Q, const Vec3<T>& v) {
  switch (kAxis) {
    case AxisDirection::kNormalToX:
      return {v.x, mulAdd(Q.yy, v.y, Q.yz * v.z), mulAdd(Q.zy, v.y, Q.zz * v.z)};
    case AxisDirection::kNormalToY:
      return {mulAdd(Q.xx, v.x, Q.xz * v.z), v.y, mulAdd(Q.zx, v.x, Q.zz * v.z)};
    case AxisDirection::kNormalToZ:
      return {mulAdd(Q.xy, v.y, Q.xz * v.z), mulAdd(Q.yy, v.y, Q.yz * v.z), -v.x};
    case AxisDirection::kPlusX:
      return {v.z, v.y, -v.x};
    case AxisDirection::kMinusX:
      return {-v.z, v.y, v.x};
    case AxisDirection::kPlusY:
      return {v.x, v.z, -v.y};
    case AxisDirection::kMinusY:
      return {v.x, -v.z, v.y};
    case AxisDirection::kPlusZ:
      return v;
    case AxisDirection::kMinusZ:
      return {v.x, -v.y, -v.z};
    default:
      return times(Q, v);
  }
}

template <AxisDirection kAxis, typename S, typename T>
VWD_INLINE Vec3<T> toChild(const Mat3<S>& Q, const Vec3<T>& v) {
  switch (kAxis) {
    case AxisDirection::kNormalToX:
      return {v.x, mulAdd(Q.yy, v.y, Q.zy * v.z), mulAdd(Q.yz, v.y, Q.zz * v.z)};
    case AxisDirection::kNormalToY:
      return {mulAdd(Q.xx, v.x, Q.zx * v.z), v.y, mulAdd(Q.xz, v.x, Q.zz * v.z)};
    case AxisDirection::kNormalToZ:
      return {-v.z, mulAdd(Q.xy, v.x, Q.yy * v.y), mulAdd(Q.xz, v.x, Q.yz * v.y)};
    case AxisDirection::kPlusX:
      return {-v.z, v.y, v.x};
    case AxisDirection::kMinusX:
      return {v.z, v.y, -v.x};
    case AxisDirection::kPlusY:
      return {v.x, -v.z, v.y};
    case AxisDirection::kMinusY:
      return {v.x, v.z, -v.y};
    case AxisDirection::kPlusZ:
      return v;
    case AxisDirection::kMinusZ:
      return {v.x, -v.y, -v.z};
    default:
      return transposeTimes(Q, v);
  }
}

/// Calls `f` with AxisIs of the axis: one jump for all products of a body.
template <typename F>
VWD_INLINE void forAxis(AxisDirection axis, const F& f) {
  switch (axis) {
    case AxisDirection::kNormalToX:
      return f(AxisIs<AxisDirection::kNormalToX>());
    case AxisDirection::kNormalToY:
      return f(AxisIs<AxisDirection::kNormalToY>());
    case AxisDirection::kNormalToZ:
      return f(AxisIs<AxisDirection::kNormalToZ>());
    case AxisDirection::kPlusX:
      return f(AxisIs<AxisDirection::kPlusX>());
    case AxisDirection::kMinusX:
      return f(AxisIs<AxisDirection::kMinusX>());
    case AxisDirection::kPlusY:
      return f(AxisIs<AxisDirection::kPlusY>());
    case AxisDirection::kMinusY:
      return f(AxisIs<AxisDirection::kMinusY>());
    case AxisDirection::kPlusZ:
      return f(AxisIs<AxisDirection::kPlusZ>());
    case AxisDirection::kMinusZ:
      return f(AxisIs<AxisDirection::kMinusZ>());
    case AxisDirection::kOblique:
      return f(AxisIs<AxisDirection::kOblique>());
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
