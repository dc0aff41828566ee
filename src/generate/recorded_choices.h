#pragma once

#include "generate/recorded_number.h"

namespace virtual_work_dynamics {

// Term as a number type of factorizations and of loops' kinematics: what base/number_choices.h asks
// of one, besides recorded_number.h. What decides how a calculation goes on is decided by the
// graph's present values, and required to be so in every motion.

inline Term operator/(const Term& a, const Term& b) {
  return recorded->quotient(a, b);
}
inline Term squareRoot(const Term& a) {
  return recorded->root(a);
}
inline Term awayFrom(const Term& x, const Term& size) {
  return recorded->awayFrom(x, size);
}
inline Term wherePositive(const Term& x, const Term& then, const Term& otherwise) {
  return recorded->positive(x, then, otherwise);
}
inline Term largerOf(const Term& a, const Term& b) {
  return recorded->larger(a, b);
}
inline Term absolute(const Term& a) {
  return largerOf(a, -a);
}
inline int lanesAbove(const Term& a, const Term& b) {
  return recorded->isAbove(a, b) ? 1 : 0;
}

/// Of an angle that rounding takes nothing from; it is never outside, as the code itself looks.
template <typename Lanes>
void sineCosine(const Term& angle, Term& sine, Term& cosine, Lanes& /*all*/) {
  cosine = recorded->part(kCosine, {angle, Term(0)});
  sine = recorded->part(kSine, {angle, Term(0)});
}
inline void sineCosineOutside(const Term& /*angle*/, Term& /*rest*/, Term& /*sine*/,
                              Term& /*cosine*/) {}

}  // namespace virtual_work_dynamics
