#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace virtual_work_dynamics {

// Numbers that carry exact derivatives, for Lagrange's equations (4.1). Each is differentiated
// along the motion and in N directions at once, every one of which has a coordinate s and its
// velocity sd. Values, rates and derivatives are taken where the motion is; N = 0 where no
// direction matters. What depends on positions alone does not depend on sd: that is why there are
// two types.

/// A quantity that depends on positions alone.
template <typename Real, std::size_t N>
struct PositionNumber {
  Real value;
  Real rate;               ///< d/dt along the motion
  std::array<Real, N> ds;  ///< partial derivatives with respect to s
};

/// A quantity that depends on positions and velocities.
template <typename Real, std::size_t N>
struct VelocityNumber {
  Real value;
  Real rate;
  std::array<Real, N> ds;
  std::array<Real, N> dsd;       ///< partial derivatives with respect to sd
  std::array<Real, N> dsd_rate;  ///< their d/dt along the motion
};

// --- derivatives in all directions ---------------------------------------------------------------

/// {f(0), f(1), ...}: written out rather than looped over, so that compilers keep the numbers in
/// registers.
template <typename Real, typename Function, std::size_t... I>
std::array<Real, sizeof...(I)> writtenOut([[maybe_unused]] Function f, std::index_sequence<I...>) {
  return {f(std::integral_constant<std::size_t, I>())...};
}

template <typename Real, std::size_t N>
std::array<Real, N> scaled(Real factor, const std::array<Real, N>& d) {
  return writtenOut<Real>([&](auto i) { return factor * d[i]; }, std::make_index_sequence<N>());
}

/// Derivatives of a sum; one of the two terms may have no directions.
template <typename Real, std::size_t N, std::size_t M>
std::array<Real, std::max(N, M)> added(const std::array<Real, N>& df,
                                       const std::array<Real, M>& dg) {
  static_assert(N == M || N == 0 || M == 0, "the same directions, or none");
  if constexpr (N == 0) {
    return dg;
  } else if constexpr (M == 0) {
    return df;
  } else {
    return writtenOut<Real>([&](auto i) { return df[i] + dg[i]; }, std::make_index_sequence<N>());
  }
}

/// Derivatives of a product: df g + f dg.
template <typename Real, std::size_t N, std::size_t M>
auto ofProduct(const std::array<Real, N>& df, Real g, Real f, const std::array<Real, M>& dg) {
  return added(scaled(g, df), scaled(f, dg));
}

// --- arithmetic ----------------------------------------------------------------------------------

template <typename Real, std::size_t N, std::size_t M>
auto operator+(const PositionNumber<Real, N>& f, const PositionNumber<Real, M>& g) {
  return PositionNumber<Real, std::max(N, M)>{f.value + g.value, f.rate + g.rate,
                                              added(f.ds, g.ds)};
}

template <typename Real, std::size_t N, std::size_t M>
auto operator+(const VelocityNumber<Real, N>& f, const VelocityNumber<Real, M>& g) {
  return VelocityNumber<Real, std::max(N, M)>{f.value + g.value, f.rate + g.rate, added(f.ds, g.ds),
                                              added(f.dsd, g.dsd), added(f.dsd_rate, g.dsd_rate)};
}

template <typename Real, std::size_t N>
PositionNumber<Real, N> operator+(const PositionNumber<Real, N>& f, Real constant) {
  return {f.value + constant, f.rate, f.ds};
}

template <typename Real, std::size_t N>
VelocityNumber<Real, N> operator+(const VelocityNumber<Real, N>& f, Real constant) {
  return {f.value + constant, f.rate, f.ds, f.dsd, f.dsd_rate};
}

template <typename Real, std::size_t N>
PositionNumber<Real, N> operator*(const PositionNumber<Real, N>& f, Real constant) {
  return {f.value * constant, f.rate * constant, scaled(constant, f.ds)};
}

template <typename Real, std::size_t N>
VelocityNumber<Real, N> operator*(const VelocityNumber<Real, N>& f, Real constant) {
  return {f.value * constant, f.rate * constant, scaled(constant, f.ds), scaled(constant, f.dsd),
          scaled(constant, f.dsd_rate)};
}

template <typename Real, std::size_t N, std::size_t M>
auto operator*(const PositionNumber<Real, N>& f, const PositionNumber<Real, M>& g) {
  return PositionNumber<Real, std::max(N, M)>{f.value * g.value,
                                              f.rate * g.value + f.value * g.rate,
                                              ofProduct(f.ds, g.value, f.value, g.ds)};
}

template <typename Real, std::size_t N, std::size_t M>
auto operator*(const PositionNumber<Real, N>& f, const VelocityNumber<Real, M>& g) {
  constexpr std::size_t kDirections = std::max(N, M);
  std::array<Real, kDirections> dsd{}, dsd_rate{};
  if constexpr (M > 0) {
    dsd = scaled(f.value, g.dsd);
    dsd_rate = added(scaled(f.rate, g.dsd), scaled(f.value, g.dsd_rate));
  }
  return VelocityNumber<Real, kDirections>{f.value * g.value, f.rate * g.value + f.value * g.rate,
                                           ofProduct(f.ds, g.value, f.value, g.ds), dsd, dsd_rate};
}

template <typename Real, std::size_t N, std::size_t M>
auto operator*(const VelocityNumber<Real, N>& f, const PositionNumber<Real, M>& g) {
  return g * f;
}

template <typename Real, std::size_t N>
VelocityNumber<Real, N> operator*(const VelocityNumber<Real, N>& f,
                                  const VelocityNumber<Real, N>& g) {
  return {f.value * g.value, f.rate * g.value + f.value * g.rate,
          ofProduct(f.ds, g.value, f.value, g.ds), ofProduct(f.dsd, g.value, f.value, g.dsd),
          added(ofProduct(f.dsd_rate, g.value, f.value, g.dsd_rate),
                ofProduct(f.dsd, g.rate, f.rate, g.dsd))};
}

// --- functions -----------------------------------------------------------------------------------

/// Composes f(x) from the value and derivative of f where x is.
template <typename Real, std::size_t N>
PositionNumber<Real, N> composed(Real f, Real dfdx, const PositionNumber<Real, N>& x) {
  return {f, dfdx * x.rate, scaled(dfdx, x.ds)};
}

}  // namespace virtual_work_dynamics
