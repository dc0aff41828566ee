#include "motion/polynomial_fit.h"

#include <cmath>
#include <string>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kMaxTerms = PolynomialFit::kMaxOrder + 1;
constexpr int kMaxRows = 2 * PolynomialFit::kMaxWindow;
/// Least part of a polynomial that must be orthogonal to its predecessors: with less, too few
/// digits are left to fit anything.
constexpr double kDependent = 1e-10;

/// Polynomials that are orthonormal over the samples: each is x times its predecessor, less the
/// part that is not orthogonal (Brubeck, Nakatsukasa and Trefethen 2021, "Vandermonde with
/// Arnoldi"). Powers of x, and combinations of them chosen beforehand, lose digits that these keep.
struct OrthonormalBasis {
  /// Column k has polynomial k at the samples, then its derivative times `slope_scale` there.
  Eigen::Matrix<double, kMaxRows, kMaxTerms> samples;
  /// Column k has value, first and second derivative of polynomial k at the instant.
  Eigen::Matrix<double, 3, kMaxTerms> instant;

  void subtract(double factor, int from, int what, int rows) {
    samples.col(from).head(rows) -= factor * samples.col(what).head(rows);
    instant.col(from) -= factor * instant.col(what);
  }

  /// Makes column k orthogonal to its predecessors and of length one, or zero if almost nothing is
  /// left of it.
  void orthonormalize(int k, int rows) {
    const double length = samples.col(k).head(rows).norm();
    // The second pass removes what rounding left behind in the first.
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < k; ++j)
        subtract(samples.col(j).head(rows).dot(samples.col(k).head(rows)), k, j, rows);
    const double left = samples.col(k).head(rows).norm();
    const double scale = left > kDependent * length ? 1 / left : 0;
    samples.col(k).head(rows) *= scale;
    instant.col(k) *= scale;
  }
};

void checkArguments(const double* times, int window, int order) {
  if (order < 1 || order > PolynomialFit::kMaxOrder)
    throw MotionError("polynomial fit: order is " + std::to_string(order) + ", must be from 1 to " +
                      std::to_string(PolynomialFit::kMaxOrder));
  if (window < order + 1 || window > PolynomialFit::kMaxWindow)
    throw MotionError("polynomial fit: window is " + std::to_string(window) +
                      ", must be from order + 1 = " + std::to_string(order + 1) + " to " +
                      std::to_string(PolynomialFit::kMaxWindow));
  for (int i = 0; i < window; ++i) {
    if (!std::isfinite(times[i]))
      throw MotionError("polynomial fit: time of sample " + std::to_string(i + 1) +
                        " is not finite");
    if (i > 0 && !(times[i] > times[i - 1]))
      throw MotionError("polynomial fit: time of sample " + std::to_string(i + 1) +
                        " is not later than the one before");
  }
}

}  // namespace

void PolynomialFit::fit(const double* times, int window, int order, bool velocities) {
  checkArguments(times, window, order);
  const int terms = order + 1;
  const int rows = velocities ? 2 * window : window;

  // Times are mapped to x in [-1, 1]; a velocity row is the mean spacing times the velocity, a
  // length.
  const double half = 0.5 * (times[window - 1] - times[0]);
  const double centre = times[0] + half;
  const double spacing = 2 * half / (window - 1);
  const double slope_scale = spacing / half;
  const double x_instant = -centre / half;

  OrthonormalBasis basis;
  basis.samples.col(0).head(window).setOnes();
  basis.samples.col(0).tail(kMaxRows - window).setZero();
  basis.instant.col(0) << 1, 0, 0;
  basis.orthonormalize(0, rows);
  for (int k = 1; k < terms; ++k) {
    const auto last = basis.samples.col(k - 1);
    auto next = basis.samples.col(k);
    for (int i = 0; i < window; ++i) {
      const double x = (times[i] - centre) / half;
      next[i] = x * last[i];
      if (velocities) next[window + i] = slope_scale * last[i] + x * last[window + i];
    }
    const Eigen::Vector3d at = basis.instant.col(k - 1);
    basis.instant.col(k) << x_instant * at[0], at[0] + x_instant * at[1],
        2 * at[1] + x_instant * at[2];
    basis.orthonormalize(k, rows);
  }
  basis.instant.row(1) /= half;
  basis.instant.row(2) /= half * half;

  for (int i = 0; i < rows; ++i) {
    Eigen::Vector3d weight = Eigen::Vector3d::Zero();
    for (int k = 0; k < terms; ++k) weight += basis.samples(i, k) * basis.instant.col(k);
    weights_.col(i) = i < window ? weight : weight * spacing;
  }
  window_ = window;
  velocities_ = velocities;
}

void PolynomialFit::evaluate(const double* q, const double* qd, double& value, double& first,
                             double& second) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 1; i < window_; ++i) sum += weights_.col(i) * (q[i] - q[0]);
  if (velocities_)
    for (int i = 0; i < window_; ++i) sum += weights_.col(window_ + i) * qd[i];
  value = q[0] + sum[0];
  first = sum[1];
  second = sum[2];
}

}  // namespace virtual_work_dynamics
