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

template <typename T>
void addColumns(const RowsShape& shape, const double* A_numbers, const double* u_numbers,
                double* sum_numbers) {
  const T* const A = reinterpret_cast<const T*>(A_numbers);
  const T* const u = reinterpret_cast<const T*>(u_numbers);
  T* const sums = reinterpret_cast<T*>(sum_numbers);
  for (int k = 0; k < shape.coordinate_count; ++k) {
    const int coordinate = shape.coordinates[k];
    const T* const column = A + static_cast<std::size_t>(coordinate) * shape.A_stride;
    const T rate = u[coordinate];
    for (int i = 0; i < shape.rows; ++i) sums[i] = mulAdd(column[i], rate, sums[i]);
  }
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
    for (int i = 0; i < shape.rows; ++i) {
      entries[i] = (row_factors[i] * column.factor) * from[i];
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

template <typename T>
void norms(const RowsShape& shape, int lengths, double length_factor, const double* row_numbers,
           double* to) {
  const T* const rows = reinterpret_cast<const T*>(row_numbers);
  T* const sizes = reinterpret_cast<T*>(to);
  const T along = squaresOf(rows, 0, lengths), about = squaresOf(rows, lengths, shape.rows);
  sizes[0] = squareRoot(largerOf(along, about));
  sizes[1] = squareRoot(largerOf((length_factor * length_factor) * along, about));
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
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
