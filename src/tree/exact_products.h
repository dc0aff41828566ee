#pragma once

#include <cmath>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

// Products of the constants of a plan. They are rounded about once, also where they are not rounded
// again to a shorter type: sums of products in twice the precision of long double (Ogita, Rump and
// Oishi, Accurate sum and dot product, 2005).

/// Returns first + a . b.
template <typename A, typename B>
long double exactDot(long double first, const A& a, const B& b) {
  long double sum = first, rest = 0;
  for (int i = 0; i < 3; ++i) {
    const long double product = a[i] * b[i];
    const long double product_rest = std::fma(a[i], b[i], -product);
    const long double next = sum + product;
    const long double added = next - sum;
    rest += ((sum - (next - added)) + (product - added)) + product_rest;
    sum = next;
  }
  return sum + rest;
}

/// Returns first + A v.
inline Vector3l exactProduct(const Vector3l& first, const Matrix3l& A, const Vector3l& v) {
  return {exactDot(first[0], A.row(0), v), exactDot(first[1], A.row(1), v),
          exactDot(first[2], A.row(2), v)};
}

/// Returns A B.
inline Matrix3l exactProduct(const Matrix3l& A, const Matrix3l& B) {
  Matrix3l product;
  for (int j = 0; j < 3; ++j) {
    product.col(j) = exactProduct(Vector3l::Zero(), A, Vector3l(B.col(j)));
  }
  return product;
}

/// Returns a rotation next to R, which is one except for rounding errors. Its z axis keeps its
/// direction, and so its zeros.
inline Matrix3l orthonormalized(const Matrix3l& R) {
  // 1 - R^T R, to be taken back in first order.
  const auto defect = [&](int i, int j) { return -exactDot(i == j ? -1 : 0, R.col(i), R.col(j)); };
  Matrix3l result;
  result.col(2) = R.col(2) + defect(2, 2) / 2 * R.col(2);
  result.col(1) = R.col(1) + (defect(1, 1) / 2 * R.col(1) + defect(1, 2) * R.col(2));
  result.col(0) =
      R.col(0) + (defect(0, 0) / 2 * R.col(0) + defect(0, 2) * R.col(2) + defect(0, 1) * R.col(1));
  return result;
}

}  // namespace virtual_work_dynamics
