#pragma once

#include <cmath>

namespace virtual_work_dynamics {

/// Cosine and sine of multiplier * q + offset, rad, exact in their last digits for any q: the
/// rounding of the sum itself would turn what the joint carries by as much as the last digit of a
/// large angle.
template <typename Real>
void gearedCosineAndSine(Real multiplier, Real q, Real offset, Real& cosine, Real& sine) {
  const Real product = multiplier * q;
  const Real angle = product + offset;
  const Real back = angle - product;
  const Real rest =
      std::fma(multiplier, q, -product) + ((product - (angle - back)) + (offset - back));
  // At a billion radians even the square of the rest is more than other rounding.
  const Real c = std::cos(angle), s = std::sin(angle);
  const Real half_sine = std::sin(rest / 2), versine = 2 * half_sine * half_sine;
  const Real rest_sine = std::sin(rest);
  cosine = c - (rest_sine * s + versine * c);
  sine = s + (rest_sine * c - versine * s);
}

}  // namespace virtual_work_dynamics
