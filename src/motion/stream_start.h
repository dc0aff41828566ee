#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "motion/stream_filter.h"
#include "motion/stream_model.h"

namespace virtual_work_dynamics {

/// Most samples that a filter is started from.
constexpr int kMostStarting = 64;

/// Samples that a filter of this model is started from: those of two time constants.
inline int startingSamples(const StreamModel& model, int order, double interval) {
  const double samples = 2 * timeConstant(model, order, interval) / interval;
  // Also where `samples` is not a number.
  return samples > order ? static_cast<int>(std::min(samples, kMostStarting + 0.0)) : order;
}

/// The polynomial c_0 t + c_1 t^2 + … that is closest to some values (least squares). Does not
/// allocate.
class StartFit {
 public:
  /// @param rows number of values, below kMostStarting   @param terms at most `rows`
  StartFit(int rows, int terms);

  void set(int row, double t, double value);
  /// Finds the coefficients, when all rows are set.
  void solve();
  double coefficient(int term) const { return coefficients_[term]; }
  /// Variance of a coefficient, in that of the values.
  double spread(int term) const { return inverse_.row(term).squaredNorm(); }

 private:
  static constexpr int kTerms = kHighestOrder - 1;
  template <int kRows>
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kRows>;
  template <int kRows>
  using Columns =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kRows, kTerms>;

  Columns<kMostStarting> powers_;
  Vector<kMostStarting> values_;
  Vector<kTerms> coefficients_;
  Columns<kTerms> inverse_;  // of R
};

/// The state at the first of some samples, position relative to it. Its derivatives are those of
/// the polynomial of order N - 1 through the samples (least squares), with all that the white noise
/// can do within many time constants as their deviations. A start from zero would need deviations
/// as large as the derivatives themselves, in which samples that are exact lose all of their
/// digits.
/// @param sample sample(i) gives the time and the position of the i-th sample, relative to the
/// first
/// @param count 1 … kMostStarting samples
template <int N, typename Sample>
StreamState<N> firstState(const StreamModel& model, double interval, int count,
                          const Sample& sample) {
  // So many that little is known, but not so many that what the velocity's deviation makes of the
  // next position loses its digits when it falls to that of the samples.
  constexpr double kManyTimeConstants = 100;
  constexpr double kLargest = 1e10;
  const double longest =
      std::pow(kLargest * model.position_variance / (model.density * interval * interval),
               1.0 / (2 * N - 3));
  const double time =
      std::min(kManyTimeConstants * std::max(timeConstant(model, N, interval), interval), longest);
  StreamState<N> state;
  state.x.setZero();
  state.P.setZero();
  state.P(0, 0) = model.position_variance;
  for (int i = 1; i < N; ++i) state.P(i, i) = model.density * std::pow(time, 2 * (N - i) - 1);
  const int rows = std::min(count, kMostStarting) - 1;
  if (rows < 1) return state;
  // The polynomial goes through the first sample: its other coefficients are fitted to the rest.
  const int terms = std::min(rows, N - 1);
  StartFit fit(rows, terms);
  const double span = sample(rows).first;
  for (int row = 0; row < rows; ++row) {
    const auto [t, q] = sample(row + 1);
    fit.set(row, t / span, q);
  }
  fit.solve();
  constexpr double kMargin = 100;  // in variances: the samples are taken in once more
  const double variance = model.variance(fit.coefficient(0) / span);
  state.P(0, 0) = variance;
  double scale = 1;
  for (int i = 0; i < terms; ++i) {
    scale *= (i + 1) / span;  // derivative i + 1 of (t / span)^(i + 1)
    state.x[i + 1] = fit.coefficient(i) * scale;
    state.P(i + 1, i + 1) += kMargin * variance * fit.spread(i) * scale * scale;
  }
  return state;
}

}  // namespace virtual_work_dynamics
