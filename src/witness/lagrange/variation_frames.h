#pragma once

#include <array>
#include <cstddef>

#include "witness/lagrange/variation_number.h"

namespace virtual_work_dynamics {

// Poses of links in the root link and their time derivatives as numbers that are differentiated,
// composed down the tree: R_0K = R_0P R_PK and Rdot_0K = Rdot_0P R_PK + R_0P Rdot_PK. No angular
// velocity is propagated.

template <typename T>
using Triple = std::array<T, 3>;
template <typename T>
using Matrix = std::array<std::array<T, 3>, 3>;  // rows

template <typename T, typename U>
auto dot(const Triple<T>& a, const Triple<U>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename T>
Triple<T> column(const Matrix<T>& A, std::size_t j) {
  return {A[0][j], A[1][j], A[2][j]};
}

template <typename T, typename U>
auto operator*(const Matrix<T>& A, const Triple<U>& v) {
  return Triple<decltype(dot(A[0], v))>{dot(A[0], v), dot(A[1], v), dot(A[2], v)};
}

template <typename T, typename U>
auto operator*(const Matrix<T>& A, const Matrix<U>& B) {
  Matrix<decltype(A[0][0] * B[0][0])> C;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      C[i][j] = A[i][0] * B[0][j] + A[i][1] * B[1][j] + A[i][2] * B[2][j];
    }
  }
  return C;
}

/// Adds vectors, and matrices by their rows.
template <typename T, typename U>
auto operator+(const Triple<T>& a, const Triple<U>& b) {
  return Triple<decltype(a[0] + b[0])>{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <typename Real, std::size_t N>
struct Orientation {
  Matrix<PositionNumber<Real, N>> R;
  Matrix<VelocityNumber<Real, N>> Rdot;
};

template <typename Real, std::size_t N>
struct Origin {
  Triple<PositionNumber<Real, N>> o;
  Triple<VelocityNumber<Real, N>> odot;
};

template <typename Real, std::size_t N, std::size_t M>
auto composed(const Orientation<Real, N>& parent, const Orientation<Real, M>& child) {
  return Orientation<Real, std::max(N, M)>{parent.R * child.R,
                                           parent.Rdot * child.R + parent.R * child.Rdot};
}

template <typename Real, std::size_t N>
Orientation<Real, N> composed(const Orientation<Real, N>& parent, const Matrix<Real>& R_PK) {
  return {parent.R * R_PK, parent.Rdot * R_PK};
}

template <typename Real, std::size_t N, std::size_t M, std::size_t K>
auto composed(const Orientation<Real, N>& axes, const Origin<Real, M>& from,
              const Origin<Real, K>& to) {
  return Origin<Real, std::max({N, M, K})>{from.o + axes.R * to.o,
                                           from.odot + (axes.Rdot * to.o + axes.R * to.odot)};
}

template <typename Real, std::size_t N, std::size_t M>
auto composed(const Orientation<Real, N>& axes, const Origin<Real, M>& from,
              const Triple<Real>& to) {
  return Origin<Real, std::max(N, M)>{from.o + axes.R * to, from.odot + axes.Rdot * to};
}

}  // namespace virtual_work_dynamics
