#pragma once

#include "base/number.h"
#include "tree/kernel/kernel.h"

namespace virtual_work_dynamics {
namespace {  // see kernel.h

// Sine and cosine of packs. The angle is reduced by a multiple k of pi/2 in three parts (Cody and
// Waite), the first two short enough that k times them is exact, to |r| <= pi/4 and a little; there
// the polynomials have errors below half a unit of the last digit of 1. Coefficients for double:
// S1..S6 and C1..C6 of Sun's fdlibm; for float: of S. Moshier's Cephes library. Beyond `range` the
// C library's functions serve.

template <typename R>
struct SineCosineConstants;

template <>
struct SineCosineConstants<double> {
  static constexpr double range = 1.0e6;               // k < 2^20
  static constexpr double round = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to integer
  static constexpr double two_by_pi = 6.36619772367581382433e-01;
  static constexpr double pi_2_first = 1.57079632673412561417e+00;   // 33 bits
  static constexpr double pi_2_second = 6.07710050630396597660e-11;  // 33 bits
  static constexpr double pi_2_third = 2.02226624879595063154e-21;
};

template <>
struct SineCosineConstants<float> {
  static constexpr float range = 3000.0f;  // k < 2^11
  static constexpr float round = 12582912.0f;
  static constexpr float two_by_pi = 6.36619772367581382433e-01f;
  static constexpr float pi_2_first = 1.5703125f;
  static constexpr float pi_2_second = 4.837512969970703125e-4f;
  static constexpr float pi_2_third = 7.54978995489188216e-8f;
};

/// Sine of the reduced angle r, with z = r^2.
template <int kWidth>
VWD_INLINE Pack<double, kWidth> reducedSine(const Pack<double, kWidth>& r,
                                            const Pack<double, kWidth>& z) {
  using T = Pack<double, kWidth>;
  T p = mulAdd(z, T(1.58969099521155010221e-10), T(-2.50507602534068634195e-08));
  p = mulAdd(z, p, T(2.75573137070700676789e-06));
  p = mulAdd(z, p, T(-1.98412698298579493134e-04));
  p = mulAdd(z, p, T(8.33333333332248946124e-03));
  p = mulAdd(z, p, T(-1.66666666666666324348e-01));
  return mulAdd(z * r, p, r);
}

/// Cosine of the reduced angle.
template <int kWidth>
VWD_INLINE Pack<double, kWidth> reducedCosine(const Pack<double, kWidth>& z) {
  using T = Pack<double, kWidth>;
  T p = mulAdd(z, T(-1.13596475577881948265e-11), T(2.08757232129817482790e-09));
  p = mulAdd(z, p, T(-2.75573143513906633035e-07));
  p = mulAdd(z, p, T(2.48015872894767294178e-05));
  p = mulAdd(z, p, T(-1.38888888888741095749e-03));
  p = mulAdd(z, p, T(4.16666666666666019037e-02));
  const T half = 0.5 * z, one = T(1.0), rounded = one - half;
  return rounded + mulAdd(z * z, p, (one - rounded) - half);
}

template <int kWidth>
VWD_INLINE Pack<float, kWidth> reducedSine(const Pack<float, kWidth>& r,
                                           const Pack<float, kWidth>& z) {
  using T = Pack<float, kWidth>;
  T p = mulAdd(z, T(-1.9515295891e-4f), T(8.3321608736e-3f));
  p = mulAdd(z, p, T(-1.6666654611e-1f));
  return mulAdd(z * r, p, r);
}

template <int kWidth>
VWD_INLINE Pack<float, kWidth> reducedCosine(const Pack<float, kWidth>& z) {
  using T = Pack<float, kWidth>;
  T p = mulAdd(z, T(2.443315711809948e-5f), T(-1.388731625493765e-3f));
  p = mulAdd(z, p, T(4.166664568298827e-2f));
  const T half = 0.5f * z, one = T(1.0f), rounded = one - half;
  return rounded + mulAdd(z * z, p, (one - rounded) - half);
}

/// All bits of a lane set: its angle is within the range of sineCosine().
template <typename R, int kWidth>
struct Lanes {
  using Integer = typename IndexOf<R>::Type;
  using Bits = typename VectorOf<Integer, kWidth>::Type;
  Bits inside = ~Bits{};

  VWD_INLINE bool all() const {
    Integer every = inside[0];
    for (int i = 1; i < kWidth; ++i) every &= inside[i];
    return every != 0;
  }
};

/// Sine and cosine of every lane; wrong in those that are not in `lanes` afterwards.
template <typename R, int kWidth>
VWD_INLINE void sineCosine(const Pack<R, kWidth>& angle, Pack<R, kWidth>& sine,
                           Pack<R, kWidth>& cosine, Lanes<R, kWidth>& lanes) {
  using T = Pack<R, kWidth>;
  using Vector = typename T::Vector;
  using Constants = SineCosineConstants<R>;
  using Integer = typename IndexOf<R>::Type;
  using Bits = typename Lanes<R, kWidth>::Bits;

  const T shifted = mulAdd(angle, T(Constants::two_by_pi), T(Constants::round));
  const T k = shifted - T(Constants::round);
  T r = subMul(angle, k, T(Constants::pi_2_first));
  r = subMul(r, k, T(Constants::pi_2_second));
  r = subMul(r, k, T(Constants::pi_2_third));
  const T z = r * r;
  const Bits s = (Bits)reducedSine(r, z).v, c = (Bits)reducedCosine(z).v;

  // The last bits of `shifted` are those of k: odd quadrants swap, and the signs go round.
  const Bits quadrant = (Bits)shifted.v;
  const Bits odd = (quadrant & 1) != 0;
  constexpr int kToSign = 8 * sizeof(Integer) - 2;
  sine = T((Vector)((odd ? c : s) ^ ((quadrant & 2) << kToSign)));
  cosine = T((Vector)((odd ? s : c) ^ (((quadrant + 1) & 2) << kToSign)));
  lanes.inside &= (angle.v <= Constants::range) & (angle.v >= -Constants::range);
}

/// Puts the lanes right that sineCosine() left wrong, and takes of `rest`, which is to be added to
/// the angle, what a double holds of the sum.
template <typename R, int kWidth>
VWD_INLINE void sineCosineOutside(const Pack<R, kWidth>& angle, Pack<R, kWidth>& rest,
                                  Pack<R, kWidth>& sine, Pack<R, kWidth>& cosine) {
  for (int i = 0; i < kWidth; ++i) {
    const R lane = angle.v[i];
    if (lane <= SineCosineConstants<R>::range && lane >= -SineCosineConstants<R>::range) continue;
    double lane_sine, lane_cosine;
    const double sum = static_cast<double>(lane) + static_cast<double>(rest.v[i]);
    rest.v[i] = static_cast<R>(static_cast<double>(rest.v[i]) - (sum - static_cast<double>(lane)));
    sineCosineBeyond(sum, &lane_sine, &lane_cosine);
    sine.v[i] = static_cast<R>(lane_sine);
    cosine.v[i] = static_cast<R>(lane_cosine);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
