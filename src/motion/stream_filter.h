#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace virtual_work_dynamics {

/// Mean and covariance of position, velocity, acceleration … (N of them).
template <int N>
struct StreamState {
  Eigen::Matrix<double, N, 1> x;
  Eigen::Matrix<double, N, N> P;
};

/// What a measurement did to a state: enough to go back over it.
template <int N>
struct StreamUpdate {
  Eigen::Matrix<double, N, 1> gain;
  double scaled = 0;     ///< innovation over its variance
  double precision = 0;  ///< one over the variance of the innovation

  /// Square of the innovation over its variance; 1 in the mean where the model is right.
  double normalizedSquare() const { return scaled * scaled / precision; }
};

/// Weights of the derivatives in a Taylor series over `dt`: 1, dt, dt^2/2 …
template <int N>
std::array<double, N> taylorWeights(double dt) {
  std::array<double, N> weights;
  weights[0] = 1;
  for (std::size_t i = 1; i < N; ++i) weights[i] = weights[i - 1] * dt / static_cast<double>(i);
  return weights;
}

/// Adds what white noise of this density does to a state within `dt`.
template <int N>
void addNoise(double dt, double density, StreamState<N>& state) {
  // Q_ij is the density times the integral of f_(N-1-i) f_(N-1-j) from 0 to dt.
  const std::array<double, N> f = taylorWeights<N>(dt);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j)
      state.P(i, j) += density * dt * f[N - 1 - i] * f[N - 1 - j] / (2 * N - 1 - i - j);
}

/// Takes a state from its time to a time `dt` later: x <- F x, P <- F P F^T + Q.
template <int N>
void predict(double dt, double density, StreamState<N>& state) {
  const std::array<double, N> weights = taylorWeights<N>(dt);
  const double* f = weights.data();
  for (int i = 0; i < N; ++i)
    for (int k = i + 1; k < N; ++k) {
      state.x[i] += f[k - i] * state.x[k];
      state.P.row(i) += f[k - i] * state.P.row(k);
    }
  for (int i = 0; i < N; ++i)
    for (int k = i + 1; k < N; ++k) state.P.col(i) += f[k - i] * state.P.col(k);
  addNoise<N>(dt, density, state);
}

/// Takes in a measurement of derivative `row`, of this residual and variance > 0.
template <int N>
StreamUpdate<N> update(int row, double residual, double variance, StreamState<N>& state) {
  StreamUpdate<N> done;
  const Eigen::Matrix<double, N, 1> column = state.P.col(row);
  done.precision = 1 / (column[row] + variance);
  done.gain = column * done.precision;
  done.scaled = residual * done.precision;
  state.x += done.gain * residual;
  // Joseph's form stays positive where the plain difference P - K S K^T loses its digits: first
  // (I - K H) P, then that times (I - K H)^T, plus K R K^T.
  state.P.noalias() -= done.gain * column.transpose();
  const Eigen::Matrix<double, N, 1> rest = state.P.col(row);
  state.P.noalias() -= rest * done.gain.transpose();
  state.P.noalias() += variance * done.gain * done.gain.transpose();
  // An asymmetry would stay for good, as no measurement takes it away.
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < i; ++k) state.P(k, i) = state.P(i, k);
  return done;
}

/// The adjoint of the samples after an instant: the smoothed state is x + P r, and its covariance
/// P - P Lambda P (Bryson and Frazier 1963). Lambda is computed only where covariance is wanted.
template <int N>
struct StreamAdjoint {
  Eigen::Matrix<double, N, 1> r = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, N> Lambda = Eigen::Matrix<double, N, N>::Zero();

  /// Goes back over a measurement of derivative `row`.
  void backOver(int row, const StreamUpdate<N>& update, bool covariance) {
    if (covariance) {
      const Eigen::Matrix<double, N, 1> product = Lambda * update.gain;
      Lambda.row(row) -= product.transpose();
      Lambda.col(row) -= product;
      Lambda(row, row) += update.gain.dot(product) + update.precision;
    }
    r[row] += update.scaled - update.gain.dot(r);
  }

  /// Goes back by `dt`: r <- F^T r, Lambda <- F^T Lambda F.
  void backBy(double dt, bool covariance) {
    const std::array<double, N> weights = taylorWeights<N>(dt);
    const double* f = weights.data();
    for (int i = N - 1; i > 0; --i)
      for (int k = i - 1; k >= 0; --k) {
        r[i] += f[i - k] * r[k];
        if (covariance) Lambda.row(i) += f[i - k] * Lambda.row(k);
      }
    if (!covariance) return;
    for (int i = N - 1; i > 0; --i)
      for (int k = i - 1; k >= 0; --k) Lambda.col(i) += f[i - k] * Lambda.col(k);
    // As in update(), an asymmetry would stay.
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < i; ++k) Lambda(k, i) = Lambda(i, k);
  }
};

}  // namespace virtual_work_dynamics
