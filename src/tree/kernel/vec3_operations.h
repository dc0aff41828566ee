#pragma once

#include <cstddef>

#include "base/number.h"
#include "tree/vec3.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

// S: a constant of the plan, T: a number of the samples (a vector of samples, or the same as S).

/// Returns the vector whose components lie `stride` numbers apart.
template <typename T, typename R>
VWD_INLINE Vec3<T> loadVector(const R* from, std::size_t stride) {
  return {load<T>(from), load<T>(from + stride), load<T>(from + 2 * stride)};
}

template <typename T>
VWD_INLINE Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename T>
VWD_INLINE Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename S, typename T>
VWD_INLINE Vec3<T> scaled(const S& s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

/// Returns a . b.
template <typename S, typename T>
VWD_INLINE T dot(const S& ax, const S& ay, const S& az, const Vec3<T>& b) {
  return mulAdd(ax, b.x, mulAdd(ay, b.y, az * b.z));
}

/// Returns sum + a . b.
template <typename S, typename T>
VWD_INLINE T addDot(const T& sum, const S& ax, const S& ay, const S& az, const Vec3<T>& b) {
  return mulAdd(ax, b.x, mulAdd(ay, b.y, mulAdd(az, b.z, sum)));
}

/// Returns A v.
template <typename S, typename T>
VWD_INLINE Vec3<T> times(const Mat3<S>& A, const Vec3<T>& v) {
  return {dot(A.xx, A.xy, A.xz, v), dot(A.yx, A.yy, A.yz, v), dot(A.zx, A.zy, A.zz, v)};
}

/// Returns A v for a constant v.
template <typename S, typename T>
VWD_INLINE Vec3<T> columnTimes(const Mat3<T>& A, const Vec3<S>& v) {
  return {mulAdd(A.xx, v.x, mulAdd(A.xy, v.y, A.xz * v.z)),
          mulAdd(A.yx, v.x, mulAdd(A.yy, v.y, A.yz * v.z)),
          mulAdd(A.zx, v.x, mulAdd(A.zy, v.y, A.zz * v.z))};
}

/// Returns A^T v.
template <typename S, typename T>
VWD_INLINE Vec3<T> transposeTimes(const Mat3<S>& A, const Vec3<T>& v) {
  return {dot(A.xx, A.yx, A.zx, v), dot(A.xy, A.yy, A.zy, v), dot(A.xz, A.yz, A.zz, v)};
}

/// Returns sum + a x b.
template <typename S, typename T>
VWD_INLINE Vec3<T> addCross(const Vec3<T>& sum, const Vec3<S>& a, const Vec3<T>& b) {
  return {subMul(mulAdd(a.y, b.z, sum.x), a.z, b.y), subMul(mulAdd(a.z, b.x, sum.y), a.x, b.z),
          subMul(mulAdd(a.x, b.y, sum.z), a.y, b.x)};
}

/// A rotation about z.
template <typename T>
struct RotationZ {
  T c, s;  ///< cosine and sine of the angle
};

/// Returns Rz v; v may be a constant.
template <typename T, typename V>
VWD_INLINE Vec3<T> times(const RotationZ<T>& R, const Vec3<V>& v) {
  return {subMul(R.c * v.x, R.s, v.y), mulAdd(R.s, v.x, R.c * v.y), T(v.z)};
}

/// Returns Rz^T v.
template <typename T, typename V>
VWD_INLINE Vec3<T> transposeTimes(const RotationZ<T>& R, const Vec3<V>& v) {
  return {mulAdd(R.c, v.x, R.s * v.y), subMul(R.c * v.y, R.s, v.x), T(v.z)};
}

/// Returns A Rz.
template <typename T>
VWD_INLINE Mat3<T> times(const Mat3<T>& A, const RotationZ<T>& R) {
  return {mulAdd(A.xx, R.c, A.xy * R.s), subMul(A.xy * R.c, A.xx, R.s), A.xz,
          mulAdd(A.yx, R.c, A.yy * R.s), subMul(A.yy * R.c, A.yx, R.s), A.yz,
          mulAdd(A.zx, R.c, A.zy * R.s), subMul(A.zy * R.c, A.zx, R.s), A.zz};
}

}  // namespace
}  // namespace virtual_work_dynamics
