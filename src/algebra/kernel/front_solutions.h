#pragma once

#include "algebra/kernel/fronts.h"

namespace virtual_work_dynamics {
namespace {  // see front_kernel.h

/// What a factorization solves.
template <typename T, typename C, int kSums>
struct FrontSolutions : Fronts<T, C, kSums> {
  using Base = Fronts<T, C, kSums>;
  using Front = typename Base::Front;
  using Base::backSubstitute;
  using Base::chunkWith;
  using Base::dot;
  using Base::factorize;
  using Base::kLanes;
  using Base::subtract;

  VWD_INLINE static void reflectVector(const Front& front, int step) {
    const T* const v = front.reflection(step);
    const int from = chunkWith(step), rows = front.rows();
    subtract(front.factors[step] * dot(v, front.z, from, rows), v, front.z, from, rows);
  }
  VWD_INLINE static void applyQ(const Front& front) {
    for (int step = front.state.reflected; step-- > 0;) reflectVector(front, step);
  }
  VWD_INLINE static void applyQTransposed(const Front& front) {
    for (int step = 0; step < front.state.reflected; ++step) reflectVector(front, step);
  }

  static void reflectBack(const FrontsView& view, const FrontsMemory& memory, int f) {
    applyQ(Front(view, memory, f));
  }

  static void leastNorm(const FrontsView& view, const FrontsMemory& memory, const double* b,
                        double* x) {
    const auto small = [&](auto of, const Front& front) VWD_LAMBDA {
      of.leastNorm(front, view.columns + front.shape.columns, b);
      scatter(view, memory, front, x);
    };
    if (Base::asSmall(view, memory, small)) return;
    T* const sums = reinterpret_cast<T*>(memory.numbers) + view.sums;
    for (int j = 0; j < view.column_count; ++j) sums[j] = load<T>(b + j * kLanes);
    for (int f = 0; f < view.front_count; ++f) {
      const Front front(view, memory, f);
      const int* const columns = view.columns + front.shape.columns;
      T* const z = front.z;
      for (int k = 0; k < front.shape.pivots; ++k) {  // R^T y = b
        const T* const entries = front.column(k);
        T sum = sums[columns[k]];
        for (int i = 0; i < k; ++i) sum = subMul(sum, entries[i], z[i]);
        z[k] = sum * front.reciprocals[k];
      }
      for (int j = front.shape.pivots; j < front.shape.width; ++j) {
        const T* const entries = front.column(j);
        T sum = sums[columns[j]];
        for (int i = 0; i < front.shape.pivots; ++i) sum = subMul(sum, entries[i], z[i]);
        sums[columns[j]] = sum;
      }
    }
    for (int f = view.front_count; f-- > 0;) {
      const Front front(view, memory, f);
      for (int i = front.state.steps; i < front.rows(); ++i) front.z[i] = T(0.0);
      applyQ(front);
      scatter(view, memory, front, x);
    }
  }

  /// Hands the rows of a front on to its blocks' entries of x and to its children.
  VWD_INLINE static void scatter(const FrontsView& view, const FrontsMemory& memory,
                                 const Front& front, double* x) {
    const T* z = front.z;
    for (int b = front.shape.blocks_begin; b < front.shape.blocks_end; ++b) {
      const BlockRows& block = view.blocks[b];
      double* const to = x + block.first * kLanes;
      const int* const order = view.row_order + block.order;
      for (int i = 0; i < block.rows; ++i) store(to + order[i] * kLanes, *z++);
      for (int i = block.rows; i < block.height; ++i) store(to + order[i] * kLanes, T(0.0));
    }
    for (int c = front.shape.children_begin; c < front.shape.children_end; ++c) {
      const Front child(view, memory, view.children[c].front);
      for (int i = 0; i < child.remaining(); ++i) child.z[child.shape.pivots + i] = *z++;
    }
  }

  /// Takes the rows of a front from its blocks' entries of r and from its children.
  VWD_INLINE static void gather(const FrontsView& view, const FrontsMemory& memory,
                                const Front& front, const double* r) {
    int row = 0;
    for (int b = front.shape.blocks_begin; b < front.shape.blocks_end; ++b) {
      const BlockRows& block = view.blocks[b];
      const double* const from = r + block.first * kLanes;
      const int* const order = view.row_order + block.order;
      for (int i = 0; i < block.rows; ++i) front.z[row++] = load<T>(from + order[i] * kLanes);
    }
    for (int c = front.shape.children_begin; c < front.shape.children_end; ++c) {
      const Front child(view, memory, view.children[c].front);
      for (int i = 0; i < child.remaining(); ++i) {
        front.z[row++] = child.z[child.shape.pivots + i];
      }
    }
    for (; row < front.rows(); ++row) front.z[row] = T(0.0);
  }

  static void leastSquares(const FrontsView& view, const FrontsMemory& memory, const double* r,
                           double* u) {
    const auto small = [&](auto of, const Front& front) VWD_LAMBDA {
      gather(view, memory, front, r);
      of.leastSquares(front, view.columns + front.shape.columns, u);
    };
    if (Base::asSmall(view, memory, small)) return;
    for (int f = 0; f < view.front_count; ++f) {
      const Front front(view, memory, f);
      gather(view, memory, front, r);
      applyQTransposed(front);
    }
    T* const solution = reinterpret_cast<T*>(memory.numbers) + view.solution;
    for (int f = view.front_count; f-- > 0;) {
      const Front front(view, memory, f);
      backSubstitute(view, front, solution);
      for (int k = 0; k < front.shape.pivots; ++k) {
        const int column = view.columns[front.shape.columns + k];
        store(u + column * kLanes, solution[column]);
      }
    }
  }

  /// Goes from the row's front to the last one that its part reaches.
  static void nullSquare(const FrontsView& view, const FrontsMemory& memory, int f, int row,
                         double* to) {
    T square = T(0.0);
    {
      const Front front(view, memory, f);
      for (int i = 0; i < front.rows(); ++i) front.z[i] = T(0.0);
      front.z[row] = T(1.0);
    }
    for (;;) {
      const Front front(view, memory, f);
      applyQTransposed(front);
      for (int i = front.state.steps; i < front.state.rows; ++i) {
        square = mulAdd(front.z[i], front.z[i], square);
      }
      if (front.shape.parent == f || front.remaining() == 0) break;
      const Front next(view, memory, front.shape.parent);
      for (int i = 0; i < next.rows(); ++i) next.z[i] = T(0.0);
      for (int i = 0; i < front.remaining(); ++i) {
        next.z[front.state.in_parent + i] = front.z[front.shape.pivots + i];
      }
      f = front.shape.parent;
    }
    store(to, square);
  }

  static constexpr FrontFunctions functions() {
    return {factorize, leastNorm, leastSquares, nullSquare, reflectBack};
  }
};

/// Packs of kWidth matrices, and single matrices kRows rows at a time.
template <int kWidth, int kRows>
const FrontKernel* frontKernel() {
  using Lanes = Pack<double, kWidth>;
  static constexpr FrontKernel kKernel = {
      kWidth, FrontSolutions<double, Pack<double, kRows>, kRows>::functions(),
      FrontSolutions<Lanes, Lanes, kRows>::functions()};
  return &kKernel;
}

}  // namespace
}  // namespace virtual_work_dynamics
