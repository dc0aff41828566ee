#pragma once

namespace virtual_work_dynamics {

// Vectors and matrices of three for the recursion: plain members of any number type, so that a
// kernel built for another instruction set shares no Eigen type with the rest of the library.

template <typename T>
struct Vec3 {
  T x, y, z;
};

/// Row-major 3 x 3 matrix.
template <typename T>
struct Mat3 {
  T xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

/// Symmetric 3 x 3 matrix.
template <typename T>
struct Sym3 {
  T xx, xy, xz, yy, yz, zz;
};

template <typename T>
inline Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename T>
inline Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename T>
inline Vec3<T> operator*(const T& s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

template <typename T>
inline Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename T>
inline Vec3<T> operator*(const Mat3<T>& A, const Vec3<T>& v) {
  return {A.xx * v.x + A.xy * v.y + A.xz * v.z, A.yx * v.x + A.yy * v.y + A.yz * v.z,
          A.zx * v.x + A.zy * v.y + A.zz * v.z};
}

/// A^T v.
template <typename T>
inline Vec3<T> transposeTimes(const Mat3<T>& A, const Vec3<T>& v) {
  return {A.xx * v.x + A.yx * v.y + A.zx * v.z, A.xy * v.x + A.yy * v.y + A.zy * v.z,
          A.xz * v.x + A.yz * v.y + A.zz * v.z};
}

template <typename T>
inline Vec3<T> columnZ(const Mat3<T>& A) {
  return {A.xz, A.yz, A.zz};
}

template <typename T>
inline Mat3<T> operator*(const Mat3<T>& A, const Mat3<T>& B) {
  return {A.xx * B.xx + A.xy * B.yx + A.xz * B.zx, A.xx * B.xy + A.xy * B.yy + A.xz * B.zy,
          A.xx * B.xz + A.xy * B.yz + A.xz * B.zz, A.yx * B.xx + A.yy * B.yx + A.yz * B.zx,
          A.yx * B.xy + A.yy * B.yy + A.yz * B.zy, A.yx * B.xz + A.yy * B.yz + A.yz * B.zz,
          A.zx * B.xx + A.zy * B.yx + A.zz * B.zx, A.zx * B.xy + A.zy * B.yy + A.zz * B.zy,
          A.zx * B.xz + A.zy * B.yz + A.zz * B.zz};
}

/// A rotation about z by the angle whose cosine and sine are given.
template <typename T>
struct RotationZ {
  T c, s;

  Vec3<T> operator*(const Vec3<T>& v) const { return {c * v.x - s * v.y, s * v.x + c * v.y, v.z}; }
  Vec3<T> transposeTimes(const Vec3<T>& v) const {
    return {c * v.x + s * v.y, c * v.y - s * v.x, v.z};
  }
};

/// A Rz.
template <typename T>
inline Mat3<T> operator*(const Mat3<T>& A, const RotationZ<T>& R) {
  return {A.xx * R.c + A.xy * R.s, A.xy * R.c - A.xx * R.s, A.xz,
          A.yx * R.c + A.yy * R.s, A.yy * R.c - A.yx * R.s, A.yz,
          A.zx * R.c + A.zy * R.s, A.zy * R.c - A.zx * R.s, A.zz};
}

}  // namespace virtual_work_dynamics
