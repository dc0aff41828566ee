#pragma once

#include <utility>

namespace virtual_work_dynamics {

/// Computes value, rate and acceleration of f, a function of time in long double that returns a
/// matrix, by central differences of eighth order. For motions of some radians per second both
/// errors of the accelerations, of rounding (1e-19 / h^2) and of the order (h^8), are about 1e-14.
template <typename F>
auto withDerivatives(const F& f, long double t) {
  constexpr long double h = 0.004L;
  constexpr long double kFirst[] = {4.0L / 5, -1.0L / 5, 4.0L / 105, -1.0L / 280};
  constexpr long double kSecond[] = {8.0L / 5, -1.0L / 5, 8.0L / 315, -1.0L / 560};
  struct Result {
    decltype(f(t)) value, rate, acceleration;
  };
  Result result{f(t), f(t), f(t)};
  result.rate *= 0;
  result.acceleration *= -205.0L / 72;
  for (int i = 0; i < 4; ++i) {
    const auto after = f(t + (i + 1) * h), before = f(t - (i + 1) * h);
    result.rate += kFirst[i] * (after - before);
    result.acceleration += kSecond[i] * (after + before);
  }
  result.rate /= h;
  result.acceleration /= h * h;
  return result;
}

}  // namespace virtual_work_dynamics
