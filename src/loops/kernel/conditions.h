#pragma once

#include "base/number_choices.h"
#include "loops/kernel/loop_kernel.h"

namespace virtual_work_dynamics {
namespace {  // see loop_kernel.h

// What is done with the conditions of a set of any kind. Most sets have the five rows of a revolute
// or prismatic closure, so that these have loops of constant length.

constexpr int kRowsOfPin = 5;

template <int kRows, typename T>
VWD_INLINE void addRates(const RowsShape& shape, int rows, const T* A, const T* qd, const T* qdd,
                         T* rates, T* accelerations) {
  const int count = kRows > 0 ? kRows : rows;
  for (int k = 0; k < shape.coordinate_count; ++k) {
    const int coordinate = shape.coordinates[k];
    const T* const column = A + static_cast<std::size_t>(coordinate) * shape.A_stride;
    const T rate = qd[coordinate], acceleration = qdd[coordinate];
    for (int i = 0; i < count; ++i) {
      rates[i] = mulAdd(column[i], rate, rates[i]);
      accelerations[i] = mulAdd(column[i], acceleration, accelerations[i]);
    }
  }
}

template <typename T>
void addMotion(const RowsShape& shape, const double* A_numbers, const double* qd_numbers,
               const double* qdd_numbers, double* rate_numbers, double* acceleration_numbers) {
  const T* const A = reinterpret_cast<const T*>(A_numbers);
  const T* const qd = reinterpret_cast<const T*>(qd_numbers);
  const T* const qdd = reinterpret_cast<const T*>(qdd_numbers);
  T* const rates = reinterpret_cast<T*>(rate_numbers);
  T* const accelerations = reinterpret_cast<T*>(acceleration_numbers);
  if (shape.rows != kRowsOfPin) {
    return addRates<0>(shape, shape.rows, A, qd, qdd, rates, accelerations);
  }
  T v[kRowsOfPin], a[kRowsOfPin];
  for (int i = 0; i < kRowsOfPin; ++i) {
    v[i] = rates[i];
    a[i] = accelerations[i];
  }
  addRates<kRowsOfPin>(shape, kRowsOfPin, A, qd, qdd, v, a);
  for (int i = 0; i < kRowsOfPin; ++i) {
    rates[i] = v[i];
    accelerations[i] = a[i];
  }
}

template <int kRows, typename T>
VWD_INLINE void addProducts(const RowsShape& shape, int rows, const T* A, const T* u, T* sums) {
  const int count = kRows > 0 ? kRows : rows;
  for (int k = 0; k < shape.coordinate_count; ++k) {
    const int coordinate = shape.coordinates[k];
    const T* const column = A + static_cast<std::size_t>(coordinate) * shape.A_stride;
    const T rate = u[coordinate];
    for (int i = 0; i < count; ++i) sums[i] = mulAdd(column[i], rate, sums[i]);
  }
}

template <typename T>
void addColumns(const RowsShape& shape, const double* A_numbers, const double* u_numbers,
                double* sum_numbers) {
  const T* const A = reinterpret_cast<const T*>(A_numbers);
  const T* const u = reinterpret_cast<const T*>(u_numbers);
  T* const sums = reinterpret_cast<T*>(sum_numbers);
  if (shape.rows != kRowsOfPin) return addProducts<0>(shape, shape.rows, A, u, sums);
  T own[kRowsOfPin];
  for (int i = 0; i < kRowsOfPin; ++i) own[i] = sums[i];
  addProducts<kRowsOfPin>(shape, kRowsOfPin, A, u, own);
  for (int i = 0; i < kRowsOfPin; ++i) sums[i] = own[i];
}

constexpr int kSeveral = 4, kRowsOfBall = 3;
/// Calls several(i) with the first of kSeveral rows, the last ones a second time where they do not
/// come out even, or one(i) with every row where there are fewer.
template <typename Several, typename One>
VWD_INLINE void forRows(int rows, const Several& several, const One& one) {
  int i = 0;
  if (rows < kSeveral) {
    for (; i < rows; ++i) one(i);
    return;
  }
  for (; i + kSeveral <= rows; i += kSeveral) several(i);
  if (i < rows) several(rows - kSeveral);
}

template <typename T>
void scaleColumns(const RowsShape& shape, const ScaledColumns& scaled, const double* row_factors,
                  const double* A_numbers, double* to_numbers) {
  const T* const A = reinterpret_cast<const T*>(A_numbers);
  T* const to = reinterpret_cast<T*>(to_numbers);
  for (int k = 0; k < scaled.count; ++k) {
    const ScaledColumn& column = scaled.columns[k];
    const T* const from = A + static_cast<std::size_t>(column.coordinate) * shape.A_stride;
    T* const entries = to + column.place * scaled.height;
    const auto one = [&](int i)
                         VWD_LAMBDA { entries[i] = (row_factors[i] * column.factor) * from[i]; };
    if constexpr (LanesOf<T>::value == 1) {
      using Rows = Pack<double, kSeveral>;
      const Rows factor(column.factor);
      if (shape.rows == kRowsOfBall) {  // without the count, the loop is unrolled
        for (int i = 0; i < kRowsOfBall; ++i) one(i);
        continue;
      }
      const auto several = [&](int i) VWD_LAMBDA {
        store(entries + i, (load<Rows>(row_factors + i) * factor) * load<Rows>(from + i));
      };
      forRows(shape.rows, several, one);
    } else {
      for (int i = 0; i < shape.rows; ++i) one(i);
    }
  }
}

/// Sums of squares of rows [begin, end).
template <typename T>
VWD_INLINE T squaresOf(const T* rows, int begin, int end) {
  T sum = T(0.0);
  for (int i = begin; i < end; ++i) sum = mulAdd(rows[i], rows[i], sum);
  return sum;
}

/// The largest of 1 and the absolute entries of rates over their scales.
template <typename T>
VWD_INLINE T largestRate(const double* scales, int count, const T* rates) {
  T largest = T(1.0);
  for (int i = 0; i < count; ++i) {
    largest = largerOf(absolute(rates[i]) / T(scales[i]), largest);
  }
  return largest;
}

template <typename T>
void findResiduals(const ResidualsView& view, const ResidualNumbers& numbers) {
  const T rate = largestRate(view.scales, view.coordinates, reinterpret_cast<const T*>(numbers.qd));
  const T acceleration =
      largerOf(rate * rate,
               largestRate(view.scales, view.coordinates, reinterpret_cast<const T*>(numbers.qdd)));
  const T shares[] = {T(1.0), T(1.0) / rate, T(1.0) / acceleration};
  for (int level = 0; level < 3; ++level) {
    const T* rows = reinterpret_cast<const T*>(numbers.conditions[level]);
    T* const plain = reinterpret_cast<T*>(numbers.plain);
    T* const relative = reinterpret_cast<T*>(numbers.relative);
    for (int c = 0; c < view.closures; ++c) {
      const T along = squaresOf(rows, 0, view.lengths[c]);
      const T about = squaresOf(rows, view.lengths[c], view.rows[c].rows);
      plain[3 * c + level] = squareRoot(largerOf(along, about));
      relative[3 * c + level] =
          squareRoot(largerOf((view.share * view.share) * along, about)) * shares[level];
      rows += view.rows[c].rows;
    }
  }
}

template <typename T>
void sumWrenches(const ClosureShape& shape, const double* units, const double* x_numbers,
                 const double* wrench_numbers, double* to) {
  const T* const x = reinterpret_cast<const T*>(x_numbers);
  const T* const wrenches = reinterpret_cast<const T*>(wrench_numbers);
  T* const sum = reinterpret_cast<T*>(to);
  for (int j = 0; j < kWrenchNumbers; ++j) sum[j] = T(0.0);
  for (int i = 0; i < shape.demand_count; ++i) {
    const int part = shape.demands[i].kind == DemandShape::Kind::kNormal ? 3 : 0;
    const T multiplier = units[i] * x[i];
    const T* const unit = wrenches + i * kWrenchNumbers + part;
    for (int j = 0; j < 3; ++j) sum[part + j] = mulAdd(multiplier, unit[j], sum[part + j]);
    for (int j = 3; shape.teeth && j < kWrenchNumbers; ++j) sum[j] = multiplier * unit[j];
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
