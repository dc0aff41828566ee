#pragma once

#include "algebra/kernel/small_front.h"

namespace virtual_work_dynamics {
namespace {  // see front_kernel.h

// Remainders of columns after the reflections of a front count as rounding up to this fraction of
// the longest column.
constexpr double kRoundingFraction = 16 * 2.220446049250313e-16;
/// The numbers of one factorization: T is a number of the matrix, C a chunk of a column, which is
/// several rows of one matrix, or one row of several.
/// @param kSums how many rows at a time one matrix has: with several, too, sums are made of as many
///   parts, so that both agree bit for bit
template <typename T, typename C, int kSums>
struct Fronts {
  static constexpr int kLanes = LanesOf<T>::value;
  static constexpr int kChunk = static_cast<int>(sizeof(C) / sizeof(T));

  VWD_INLINE static T total(const T& x) { return x; }
  template <typename Chunk>
  VWD_INLINE static T total(const Chunk& x) {
    return sumOfLanes(x);
  }
  VWD_INLINE static C chunk(const T* from) {
    if constexpr (kChunk > 1) {
      return load<C>(from);
    } else {
      return *from;
    }
  }
  VWD_INLINE static void put(T* to, const C& value) {
    if constexpr (kChunk > 1) {
      store(to, value);
    } else {
      *to = value;
    }
  }

  /// One front with its numbers.
  struct Front {
    const FrontShape& shape;
    FrontState& state;
    int* stairs;
    T *entries, *reflections, *factors, *reciprocals, *z;

    VWD_INLINE Front(const FrontsView& view, const FrontsMemory& memory, int f)
        : shape(view.fronts[f]), state(memory.states[f]), stairs(memory.stairs + shape.stairs) {
      T* const numbers = reinterpret_cast<T*>(memory.numbers);
      entries = numbers + shape.entries;
      reflections = numbers + shape.reflections;
      factors = numbers + shape.factors;
      reciprocals = numbers + shape.reciprocals;
      z = numbers + shape.z;
    }
    VWD_INLINE T* column(int j) const { return entries + j * shape.most_rows; }
    VWD_INLINE T* reflection(int step) const { return reflections + step * shape.most_rows; }
    /// Rows that are computed with; the last ones may be empty.
    VWD_INLINE int rows() const { return kChunk > 1 ? shape.most_rows : state.rows; }
    VWD_INLINE int remaining() const { return state.steps - shape.pivots; }
    /// Whether a step has one row only, which is one of R as it is.
    VWD_INLINE bool isAlone(int step) const { return step + 1 == state.rows; }
  };

  /// The first row of the chunk that has a row.
  VWD_INLINE static int chunkWith(int row) { return row / kChunk * kChunk; }

  VWD_INLINE static T dot(const T* a, const T* b, int from, int rows) {
    if constexpr (kChunk > 1) {
      C sum = chunk(a + from) * chunk(b + from);
      for (int i = from + kChunk; i < rows; i += kChunk) {
        sum = mulAdd(chunk(a + i), chunk(b + i), sum);
      }
      return total(sum);
    } else {
      const T zero(0.0);
      T sums[kSums];
      for (T& sum : sums) sum = zero;
      const int first_end = from / kSums * kSums + kSums;
      int i = from;
      for (; i < rows && i < first_end; ++i) sums[i % kSums] = a[i] * b[i];
      for (; i < rows; ++i) sums[i % kSums] = mulAdd(a[i], b[i], sums[i % kSums]);
      if constexpr (kSums == 2) return sums[0] + sums[1];
      return (sums[0] + sums[2 % kSums]) + (sums[1] + sums[3 % kSums]);
    }
  }
  VWD_INLINE static void subtract(const T& factor, const T* what, T* of, int from, int rows) {
    const C times(factor);
    for (int i = from; i < rows; i += kChunk) {
      put(of + i, subMul(chunk(of + i), times, chunk(what + i)));
    }
  }

  VWD_INLINE static void clear(const Front& front) {
    if (asSmall(front, [&](auto of) VWD_LAMBDA { of.clear(front); })) return;
    const int size = front.shape.most_rows * front.shape.width;
    const C zero(0.0);
    for (int i = 0; i < size; i += kChunk) put(front.entries + i, zero);
  }

  /// Takes in the entries of blocks and of earlier fronts.
  static void assemble(const FrontsView& view, const FrontsMemory& memory,
                       const double* const* entries, const Front& front, T* lengths) {
    const FrontShape& shape = front.shape;
    clear(front);
    int row = 0;
    for (int b = shape.blocks_begin; b < shape.blocks_end; ++b) {
      const BlockRows& block = view.blocks[b];
      for (int k = block.columns_begin; k < block.columns_end; ++k) {
        const BlockColumn& column = view.block_columns[k];
        const double* const from = entries[block.block] + column.from * block.height * kLanes;
        const int* const order = view.row_order + block.order;
        T* const to = front.column(column.to) + row;
        T sum = lengths[column.column];
        for (int i = 0; i < block.rows; ++i) {
          const T value = load<T>(from + order[i] * kLanes);
          to[i] = value;
          sum = mulAdd(value, value, sum);
        }
        lengths[column.column] = sum;
      }
      row += block.rows;
    }
    for (int c = shape.children_begin; c < shape.children_end; ++c) {
      const Front child(view, memory, view.children[c].front);
      const int* const places = view.places + view.children[c].places;
      child.state.in_parent = row;
      for (int step = child.shape.pivots; step < child.state.steps; ++step, ++row) {
        for (int j = child.stairs[step]; j < child.shape.width; ++j) {
          front.column(places[j - child.shape.pivots])[row] = child.column(j)[step];
        }
      }
    }
    front.state.rows = row;
    front.state.steps = front.state.reflected = 0;
  }

  /// Copies what a column has from row `step` on into the reflection of that step.
  /// @returns its squared length
  VWD_INLINE static T startReflection(const Front& front, int step, int column, int rows) {
    const T* const from = front.column(column);
    if (front.isAlone(step)) return from[step] * from[step];
    T* const v = front.reflection(step);
    int i = chunkWith(step);
    if constexpr (kChunk > 1) {
      C sum(0.0);
      for (int above = 0; above < i; above += kChunk) put(v + above, sum);
      const C first = load<C>(kStep + kRowChunk - (step - i)) * chunk(from + i);
      put(v + i, first);
      sum = first * first;
      for (i += kChunk; i < rows; i += kChunk) {
        const C part = chunk(from + i);
        put(v + i, part);
        sum = mulAdd(part, part, sum);
      }
      return total(sum);
    } else {
      for (; i < rows; ++i) v[i] = from[i];
      return dot(v, v, step, rows);
    }
  }

  /// Reflects with 1 - factor v v^T, which makes of the column that startReflection() was told its
  /// length in row `step`. Rows above are those of R already.
  VWD_INLINE static void reflect(const Front& front, int step, int column, const T& square,
                                 int rows) {
    front.stairs[step] = column;
    ++front.state.steps;
    if (front.isAlone(step)) return;
    ++front.state.reflected;
    T* const head = front.column(column) + step;
    T* const v = front.reflection(step);
    const int from = chunkWith(step);
    const T diagonal = awayFrom(*head, squareRoot(square));
    const T factor = T(1.0) / subMul(square, diagonal, *head);
    if constexpr (kChunk > 1) {
      put(v + from,
          subMul(chunk(v + from), C(diagonal), load<C>(kUnit + kRowChunk - (step - from))));
    } else {
      v[step] = *head - diagonal;
    }
    *head = diagonal;
    front.factors[step] = factor;
    for (int j = column + 1; j < front.shape.width; ++j) {
      T* const other = front.column(j);
      subtract(factor * dot(v, other, from, rows), v, other, from, rows);
    }
  }

  VWD_INLINE static Factorized eliminate(const Front& front, int rows) {
    const FrontShape& shape = front.shape;
    if (shape.pivots > front.state.rows) return Factorized::kDependent;
    for (int step = 0; step < shape.pivots; ++step) {
      const T square = startReflection(front, step, step, rows);
      if (lanesAbove(square, T(kLeastSquare)) < kLanes) return Factorized::kDependent;
      reflect(front, step, step, square, rows);
      front.reciprocals[step] = T(1.0) / front.column(step)[step];
    }
    return compress(front, rows);
  }

  /// Reflects the rows below the pivots into as few rows as their entries allow; the other rows
  /// then have no entries. Where they are no more than the columns, reflections could only find
  /// that they depend on each other, which later fronts do as well: they are handed on as they are.
  VWD_INLINE static Factorized compress(const Front& front, int rows) {
    const FrontShape& shape = front.shape;
    if (shape.width == shape.pivots) return Factorized::kWhole;
    if (front.state.rows <= shape.width) {
      while (front.state.steps < front.state.rows) front.stairs[front.state.steps++] = shape.pivots;
      return Factorized::kWhole;
    }
    T longest = T(0.0);
    for (int j = shape.pivots; j < shape.width; ++j) {
      longest = largerOf(dot(front.column(j), front.column(j), 0, rows), longest);
    }
    const T nothing = largerOf(kRoundingFraction * kRoundingFraction * longest, T(kLeastSquare));
    for (int j = shape.pivots; j < shape.width && front.state.steps < front.state.rows; ++j) {
      const T square = startReflection(front, front.state.steps, j, rows);
      const int above = lanesAbove(square, nothing);
      if (above == 0) continue;
      if (above < kLanes) return Factorized::kDivided;
      reflect(front, front.state.steps, j, square, rows);
    }
    return Factorized::kWhole;
  }

  static Factorized factorize(const FrontsView& view, const double* const* entries, double size,
                              const FrontsMemory& memory, double* condition) {
    T* const lengths = reinterpret_cast<T*>(memory.numbers) + view.lengths;
    for (int j = 0; j < view.column_count; ++j) lengths[j] = T(0.0);
    for (int f = 0; f < view.front_count; ++f) {
      const Front front(view, memory, f);
      assemble(view, memory, entries, front, lengths);
      const Factorized done = eliminateBySize(front);
      if (done != Factorized::kWhole) return done;
    }
    T longest = T(size * size), estimate;
    for (int j = 0; j < view.column_count; ++j) longest = largerOf(lengths[j], longest);
    const auto small = [&](auto of, const Front& front)
                           VWD_LAMBDA { estimate = of.estimateCondition(front, longest); };
    if (!asSmall(view, memory, small)) estimate = estimateCondition(view, memory, longest);
    store(condition, estimate);
    return Factorized::kWhole;
  }

  template <int kWidth>
  using Small = SmallFront<Front, T, C, kWidth>;

  /// Calls use(SmallFront, front) where the only front is one.
  template <typename Use>
  VWD_INLINE static bool asSmall(const FrontsView& view, const FrontsMemory& memory,
                                 const Use& use) {
    if (kChunk != kRowChunk || view.front_count != 1) return false;
    const Front front(view, memory, 0);
    return asSmall(front, [&](auto of) VWD_LAMBDA { use(of, front); });
  }
  template <typename Use>
  VWD_INLINE static bool asSmall(const Front& front, const Use& use) {
    if constexpr (kChunk == kRowChunk) {
      const FrontShape& shape = front.shape;
      if (shape.most_rows != kRowChunk || shape.pivots != shape.width) return false;
      if (shape.width == 1) {
        use(Small<1>());
      } else if (shape.width == 2) {
        use(Small<2>());
      } else if (shape.width == 3) {
        use(Small<3>());
      } else if (shape.width == 4) {
        use(Small<4>());
      } else {
        return false;
      }
      return true;
    }
    return false;
  }

  /// Small fronts have loops of constant length.
  VWD_INLINE static Factorized eliminateBySize(const Front& front) {
    Factorized done;
    if (asSmall(front, [&](auto of) VWD_LAMBDA { done = of.eliminate(front); })) return done;
    if (kChunk > 1) {
      if (front.rows() == kRowChunk) return eliminate(front, kRowChunk);
      if (front.rows() == 2 * kRowChunk) return eliminate(front, 2 * kRowChunk);
    }
    return eliminate(front, front.rows());
  }

  /// Estimates |R^-1| by |R^-1 (R^-T d)| / |R^-T d|, where d = +-1 with the signs that make each
  /// entry of R^-T d large as it is computed; returns it times the root of a square.
  static T estimateCondition(const FrontsView& view, const FrontsMemory& memory, const T& square) {
    T* const numbers = reinterpret_cast<T*>(memory.numbers);
    T* const sums = numbers + view.sums;
    T* const solution = numbers + view.solution;
    for (int j = 0; j < view.column_count; ++j) sums[j] = T(0.0);
    T before = T(0.0), after = T(0.0);
    for (int f = 0; f < view.front_count; ++f) {
      const Front front(view, memory, f);
      const int* const columns = view.columns + front.shape.columns;
      T* const z = front.z;
      for (int k = 0; k < front.shape.pivots; ++k) {
        const T* const entries = front.column(k);
        T sum = sums[columns[k]];
        for (int i = 0; i < k; ++i) sum = mulAdd(entries[i], z[i], sum);
        z[k] = (awayFrom(sum, T(1.0)) - sum) * front.reciprocals[k];
        before = mulAdd(z[k], z[k], before);
      }
      for (int j = front.shape.pivots; j < front.shape.width; ++j) {
        const T* const entries = front.column(j);
        T sum = sums[columns[j]];
        for (int i = 0; i < front.shape.pivots; ++i) sum = mulAdd(entries[i], z[i], sum);
        sums[columns[j]] = sum;
      }
    }
    for (int f = view.front_count; f-- > 0;) backSubstitute(view, Front(view, memory, f), solution);
    for (int f = 0; f < view.front_count; ++f) {
      const FrontShape& shape = view.fronts[f];
      for (int k = 0; k < shape.pivots; ++k) {
        const T value = solution[view.columns[shape.columns + k]];
        after = mulAdd(value, value, after);
      }
    }
    return wherePositive(before, squareRoot(square * after / before), T(1.0));
  }

  /// Solves the part of R u = z that belongs to a front; called from the last front to the first.
  VWD_INLINE static void backSubstitute(const FrontsView& view, const Front& front, T* solution) {
    const int* const columns = view.columns + front.shape.columns;
    T* const z = front.z;
    for (int j = front.shape.pivots; j < front.shape.width; ++j) {
      const T value = solution[columns[j]];
      const T* const entries = front.column(j);
      for (int k = 0; k < front.shape.pivots; ++k) z[k] = subMul(z[k], value, entries[k]);
    }
    for (int k = front.shape.pivots; k-- > 0;) {
      const T* const entries = front.column(k);
      const T value = z[k] * front.reciprocals[k];
      solution[columns[k]] = value;
      for (int i = 0; i < k; ++i) z[i] = subMul(z[i], value, entries[i]);
    }
  }
};

}  // namespace
}  // namespace virtual_work_dynamics
