#pragma once

#include <Eigen/Core>

namespace virtual_work_dynamics {

/// Least-squares polynomial through samples of position (and velocity) of a scalar at uneven times,
/// reduced to weights: value, first and second derivative at one instant are weighted sums of the
/// samples. The weights depend on the times alone, so that one fit serves all joints that are
/// sampled together.
class PolynomialFit {
 public:
  static constexpr int kMaxWindow = 128;
  static constexpr int kMaxOrder = 6;

  /// Computes the weights. Leaves out terms of the polynomial that cannot be told apart because
  /// times are almost equal. Does not allocate.
  /// @param times sample times relative to the instant of evaluation, `window` of them, s, strictly
  ///   increasing.
  /// @param window number of samples, order + 1 … kMaxWindow.
  /// @param order order of the polynomial, 1 … kMaxOrder.
  /// @param velocities whether samples carry velocities too, which are then fitted together with
  ///   the positions (weighted by the mean spacing of the times, so that both are lengths).
  /// @throws MotionError for arguments outside of these ranges.
  void fit(const double* times, int window, int order, bool velocities);

  /// Computes value and derivatives at the instant of evaluation. `qd` is ignored (and may be null)
  /// unless the fit has velocities. Positions are taken relative to q[0] before summing, for
  /// accuracy.
  void evaluate(const double* q, const double* qd, double& value, double& first,
                double& second) const;

 private:
  int window_ = 0;
  bool velocities_ = false;
  // Row d has the weights of derivative d, for the positions and then the velocities.
  Eigen::Matrix<double, 3, 2 * kMaxWindow> weights_;
};

}  // namespace virtual_work_dynamics
