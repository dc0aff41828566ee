#pragma once

#include "base/number.h"

namespace virtual_work_dynamics {
namespace {  // see tree/kernel/kernel.h

// What number types of factorizations need besides the operations of number.h: division, roots, and
// decisions, which every lane of a pack takes for itself.

template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> operator/(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b) {
  return a.v / b.v;
}

VWD_INLINE double squareRoot(const double& x) {
  return __builtin_sqrt(x);
}
#if defined(__AVX512F__)
VWD_INLINE Pack<double, 8> squareRoot(const Pack<double, 8>& x) {
  return Pack<double, 8>(_mm512_maskz_sqrt_pd(0xff, x.v));  // of all lanes: see GCC bug 105593
}
#elif defined(__AVX2__)
VWD_INLINE Pack<double, 4> squareRoot(const Pack<double, 4>& x) {
  return Pack<double, 4>(_mm256_sqrt_pd(x.v));
}
#else
template <int kWidth>
VWD_INLINE Pack<double, kWidth> squareRoot(const Pack<double, kWidth>& x) {
  Pack<double, kWidth> root;
  for (int i = 0; i < kWidth; ++i) root.v[i] = __builtin_sqrt(x.v[i]);
  return root;
}
#endif

/// Returns `size`, with the sign turned where x is not negative.
VWD_INLINE double awayFrom(const double& x, const double& size) {
  return x < 0 ? size : -size;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> awayFrom(const Pack<R, kWidth>& x, const Pack<R, kWidth>& size) {
  return Pack<R, kWidth>(x.v < Pack<R, kWidth>(R(0)).v ? size.v : -size.v);
}

/// Returns `then` where x is positive, else `otherwise`.
VWD_INLINE double wherePositive(const double& x, const double& then, const double& otherwise) {
  return x > 0 ? then : otherwise;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> wherePositive(const Pack<R, kWidth>& x, const Pack<R, kWidth>& then,
                                         const Pack<R, kWidth>& otherwise) {
  return Pack<R, kWidth>(x.v > Pack<R, kWidth>(R(0)).v ? then.v : otherwise.v);
}

/// Returns the larger of a and b; b where one of them is not a number.
VWD_INLINE double largerOf(const double& a, const double& b) {
  return a > b ? a : b;
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> largerOf(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b) {
  return Pack<R, kWidth>(a.v > b.v ? a.v : b.v);
}

VWD_INLINE double absolute(const double& x) {
  return __builtin_fabs(x);
}
template <typename R, int kWidth>
VWD_INLINE Pack<R, kWidth> absolute(const Pack<R, kWidth>& x) {
  return largerOf(x, -x);
}

/// How many lanes of a are larger than those of b, and how many lanes there are.
VWD_INLINE int lanesAbove(const double& a, const double& b) {
  return a > b ? 1 : 0;
}
template <typename R, int kWidth>
VWD_INLINE int lanesAbove(const Pack<R, kWidth>& a, const Pack<R, kWidth>& b) {
  const auto above = a.v > b.v;
  int count = 0;
  for (int i = 0; i < kWidth; ++i) count -= static_cast<int>(above[i]);
  return count;
}
template <typename T>
struct LanesOf {
  static constexpr int value = 1;
};
template <typename R, int kWidth>
struct LanesOf<Pack<R, kWidth>> {
  static constexpr int value = kWidth;
};

/// Returns the sum of the lanes.
VWD_INLINE double sumOfLanes(const Pack<double, 2>& x) {
  return x.v[0] + x.v[1];
}
#if defined(__AVX2__)
VWD_INLINE double sumOfLanes(const Pack<double, 4>& x) {
  const __m128d halves = _mm_add_pd(_mm256_castpd256_pd128(x.v), _mm256_extractf128_pd(x.v, 1));
  return halves[0] + halves[1];
}
#endif

}  // namespace
}  // namespace virtual_work_dynamics
