#pragma once

#include <Eigen/Core>

namespace virtual_work_dynamics {

/// Columns of `samples` filtered forward and back by a Butterworth low-pass filter, so without
/// a shift in phase.
/// @param cutoff over the sampling rate, below 1/2.   @param order even.
Eigen::MatrixXd zeroPhaseLowPass(const Eigen::MatrixXd& samples, double cutoff, int order);

/// Derivative of columns over rows `interval` s apart, by central differences.
Eigen::MatrixXd gradient(const Eigen::MatrixXd& samples, double interval);

}  // namespace virtual_work_dynamics
