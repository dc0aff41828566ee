#pragma once

namespace virtual_work_dynamics {

// Vectors and matrices of three for the recursion: plain members of any number type, so that a
// kernel built for another instruction set shares no Eigen type with the rest of the library.
// What is done with them is in kernel/vec3_operations.h.

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

/// Force and moment in whatever axes the holder says.
template <typename T>
struct PlainWrench {
  Vec3<T> force;
  Vec3<T> torque;
};

}  // namespace virtual_work_dynamics
