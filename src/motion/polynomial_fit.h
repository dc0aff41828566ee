#pragma once

#include <Eigen/Core>

namespace virtual_work_dynamics {

/// Least-squares polynomial through samples of position (and velocity) of a scalar at uneven times,
/// reduced to weights: value, first and second derivative at one instant are weighted sums of the
/// samples. The weights depend on the times alone, so one fit serves every joint sampled together.
class PolynomialFit {
 public:
  static constexpr int kMaxWindow = 128;
  static constexpr int kMaxOrder = 6;

  /// Computes the weights. Terms of the polynomial that times almost alike cannot tell apart are
  /// left out. Does not allocate.
  /// @param times window sample times relative to the instant of evaluation, s, strictly
  /// increasing.
  /// @param window number of samples, order + 1 … kMaxWindow.
  /// @param order of the polynomial, 1 … kMaxOrder.
  /// @param velocities true: samples carry velocities too, and are fitted together with positions
  ///   (weighted by the mean spacing of the times, so that both are lengths).
  /// @throws MotionError for arguments outside of these ranges.
  void fit(const double* times, int window, int order, bool velocities);

  /// Value and derivatives at the instant of evaluation. `qd` is ignored (may be null) unless the
  /// fit has velocities. Positions are taken relative to q[0] before summing, for accuracy.
  void evaluate(const double* q, const double* qd, double& value, double& first,
                double& second) const;

 private:
  int window_ = 0;
  bool velocities_ = false;
  // Row d: weights of derivative d; columns: positions, then velocities.
  Eigen::Matrix<double, 3, 2 * kMaxWindow> weights_;
};

}  // namespace virtual_work_dynamics
