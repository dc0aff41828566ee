#pragma once

#include "algebra/kernel/front_kernel.h"
#include "base/number_choices.h"

namespace virtual_work_dynamics {
namespace {  // see front_kernel.h

// Squares of lengths below this are too close to underflow for a reflection.
constexpr double kLeastSquare = 1e-280;

// Chunks that begin at entry kRowChunk - i have zeros in their first i rows, or a one in row i
// only.
static_assert(kRowChunk == 4, "as these tables");
constexpr double kStep[] = {0, 0, 0, 0, 1, 1, 1, 1};
constexpr double kUnit[] = {0, 0, 0, 0, 1, 0, 0, 0};

/// A front of one matrix whose rows are one chunk and whose columns are all pivots: loops have
/// constant lengths, and columns stay in registers. What it computes agrees with Fronts bit for
/// bit.
/// @param C a chunk of a column
/// @param kWidth number of columns
template <typename Front, typename T, typename C, int kWidth>
struct SmallFront {
  VWD_INLINE static void clear(const Front& front) {
    for (int j = 0; j < kWidth; ++j) store(front.column(j), C(0.0));
  }
  VWD_INLINE static T dot(const C& a, const C& b) { return sumOfLanes(a * b); }

  /// Eliminates from column `kFrom` on.
  template <int kFrom>
  VWD_INLINE static bool eliminate(const Front& front, C (&columns)[kWidth]) {
    if constexpr (kFrom < kWidth) {
      const C below = load<C>(kStep + kRowChunk - kFrom) * columns[kFrom];
      const T square = dot(below, below);
      if (lanesAbove(square, T(kLeastSquare)) == 0) return false;
      const T head = columns[kFrom].v[kFrom];
      if (kFrom + 1 == kWidth && front.isAlone(kFrom)) {
        store(front.column(kFrom), columns[kFrom]);
        front.reciprocals[kFrom] = T(1.0) / head;
        front.stairs[kFrom] = kFrom;
        return true;
      }
      const T diagonal = awayFrom(head, squareRoot(square));
      const T factor = T(1.0) / subMul(square, diagonal, head);
      const C v = subMul(below, C(diagonal), load<C>(kUnit + kRowChunk - kFrom));
      for (int j = kFrom + 1; j < kWidth; ++j) {
        columns[j] = subMul(columns[j], C(factor * dot(v, columns[j])), v);
      }
      store(front.column(kFrom), columns[kFrom]);
      front.column(kFrom)[kFrom] = diagonal;
      store(front.reflection(kFrom), v);
      front.factors[kFrom] = factor;
      front.reciprocals[kFrom] = T(1.0) / diagonal;
      front.stairs[kFrom] = kFrom;
      return eliminate<kFrom + 1>(front, columns);
    }
    return true;
  }

  /// See Fronts::eliminate().
  VWD_INLINE static Factorized eliminate(const Front& front) {
    if (kWidth > front.state.rows) return Factorized::kDependent;
    C columns[kWidth];
    for (int j = 0; j < kWidth; ++j) columns[j] = load<C>(front.column(j));
    front.state.steps = kWidth;
    front.state.reflected = kWidth - (front.isAlone(kWidth - 1) ? 1 : 0);
    return eliminate<0>(front, columns) ? Factorized::kWhole : Factorized::kDependent;
  }

  /// See Fronts::estimateCondition().
  VWD_INLINE static T estimateCondition(const Front& front, const T& square) {
    T z[kWidth], before = T(0.0), after = T(0.0);
    for (int k = 0; k < kWidth; ++k) {
      const T* const entries = front.column(k);
      T sum = T(0.0);
      for (int i = 0; i < k; ++i) sum = mulAdd(entries[i], z[i], sum);
      z[k] = (awayFrom(sum, T(1.0)) - sum) * front.reciprocals[k];
      before = mulAdd(z[k], z[k], before);
    }
    backSubstitute(front, z);
    for (int k = 0; k < kWidth; ++k) after = mulAdd(z[k], z[k], after);
    return wherePositive(before, squareRoot(square * after / before), T(1.0));
  }

  /// Solves R u = z in place.
  VWD_INLINE static void backSubstitute(const Front& front, T (&z)[kWidth]) {
    for (int k = kWidth; k-- > 0;) {
      const T* const entries = front.column(k);
      z[k] = z[k] * front.reciprocals[k];
      for (int i = 0; i < k; ++i) z[i] = subMul(z[i], z[k], entries[i]);
    }
  }

  VWD_INLINE static void reflect(const Front& front, int step, C& z) {
    const C v = load<C>(front.reflection(step));
    z = subMul(z, C(front.factors[step] * dot(v, z)), v);
  }

  /// See FrontSolutions::leastNorm(): sets z from the entries of b.
  VWD_INLINE static void leastNorm(const Front& front, const int* columns, const double* b) {
    T y[kRowChunk] = {};
    for (int k = 0; k < kWidth; ++k) {  // R^T y = b
      const T* const entries = front.column(k);
      T sum = b[columns[k]];
      for (int i = 0; i < k; ++i) sum = subMul(sum, entries[i], y[i]);
      y[k] = sum * front.reciprocals[k];
    }
    C z = load<C>(y);
    if (!front.isAlone(kWidth - 1)) reflect(front, kWidth - 1, z);
    for (int step = kWidth - 1; step-- > 0;) reflect(front, step, z);
    store(front.z, z);
  }

  /// See FrontSolutions::leastSquares(): finds u from z.
  VWD_INLINE static void leastSquares(const Front& front, const int* columns, double* u) {
    C chunk = load<C>(front.z);
    for (int step = 0; step + 1 < kWidth; ++step) reflect(front, step, chunk);
    if (!front.isAlone(kWidth - 1)) reflect(front, kWidth - 1, chunk);
    T z[kWidth];
    for (int k = 0; k < kWidth; ++k) z[k] = chunk.v[k];
    backSubstitute(front, z);
    for (int k = 0; k < kWidth; ++k) u[columns[k]] = z[k];
  }
};

}  // namespace
}  // namespace virtual_work_dynamics
