#pragma once

namespace virtual_work_dynamics {
namespace {  // see momentum.h

// Vectors in root axes: one register of four numbers where there are such, else three numbers, as
// compilers take the halves of larger vectors through memory.

#if defined(__AVX__)
/// Three components x, y, z and a fourth number without meaning.
typedef double Vector __attribute__((vector_size(4 * sizeof(double))));

inline Vector vectorOf(double x, double y, double z) {
  return Vector{x, y, z, 0};
}

inline void store(const Vector& v, double* to) {
  for (int i = 0; i < 3; ++i) to[i] = v[i];
}

inline Vector yzx(const Vector& v) {
#if defined(__clang__)
  return __builtin_shufflevector(v, v, 1, 2, 0, 3);
#else
  typedef long long Indices __attribute__((vector_size(4 * sizeof(long long))));
  return __builtin_shuffle(v, Indices{1, 2, 0, 3});
#endif
}
#else
struct Vector {
  double x, y, z;
};

inline Vector vectorOf(double x, double y, double z) {
  return {x, y, z};
}

inline void store(const Vector& v, double* to) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

inline Vector yzx(const Vector& v) {
  return {v.y, v.z, v.x};
}

inline Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(const Vector& a, const Vector& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Vector operator*(double a, const Vector& b) {
  return {a * b.x, a * b.y, a * b.z};
}
inline Vector operator*(const Vector& a, double b) {
  return b * a;
}
inline void operator+=(Vector& a, const Vector& b) {
  a = a + b;
}
inline void operator-=(Vector& a, const Vector& b) {
  a = a - b;
}
#endif

inline Vector vectorOf(const double* v) {
  return vectorOf(v[0], v[1], v[2]);
}

/// Returns a x b, its components in the order z, x, y.
inline Vector crossZxy(const Vector& a, const Vector& b) {
  return a * yzx(b) - yzx(a) * b;
}

}  // namespace
}  // namespace virtual_work_dynamics
