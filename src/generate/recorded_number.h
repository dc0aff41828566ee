#pragma once

#include "generate/expression_graph.h"

namespace virtual_work_dynamics {

// Term as a number type of the recursion: what base/number.h asks of one. Operations go to the
// graph that the thread records into.

/// The graph that the operations of this thread go to.
inline thread_local ExpressionGraph* recorded = nullptr;

inline Term operator+(const Term& a, const Term& b) {
  return recorded->sum(a, b);
}
inline Term operator-(const Term& a, const Term& b) {
  return recorded->difference(a, b);
}
inline Term operator-(const Term& a) {
  return recorded->negated(a);
}
inline Term operator*(const Term& a, const Term& b) {
  return recorded->product(a, b);
}
inline Term operator*(double a, const Term& b) {
  return Term(a) * b;
}
inline Term operator*(const Term& a, double b) {
  return a * Term(b);
}

inline Term mulAdd(const Term& a, const Term& b, const Term& c) {
  return recorded->fused(a, b, c, false, false);
}
inline Term mulAdd(const double& a, const Term& b, const Term& c) {
  return mulAdd(Term(a), b, c);
}
inline Term mulAdd(const Term& a, const double& b, const Term& c) {
  return mulAdd(a, Term(b), c);
}
inline Term subMul(const Term& c, const Term& a, const Term& b) {
  return recorded->fused(a, b, c, true, false);
}
inline Term subMul(const Term& c, const double& a, const Term& b) {
  return subMul(c, Term(a), b);
}
inline Term subMul(const Term& c, const Term& a, const double& b) {
  return subMul(c, a, Term(b));
}
inline Term mulSub(const Term& a, const Term& b, const Term& c) {
  return recorded->fused(a, b, c, false, true);
}
inline Term minusMulSub(const Term& a, const Term& b, const Term& c) {
  return recorded->fused(a, b, c, true, true);
}
inline Term productRest(double a, const Term& b, const Term& product) {
  return recorded->productRest(Term(a), b, product);
}
inline Term heldWithinOne(const Term& a) {
  return recorded->held(a);
}

}  // namespace virtual_work_dynamics
