#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "estimator/encoder_stream.h"

namespace virtual_work_dynamics {

/// Weights with which samples make position, velocity and acceleration (rows) at time zero: those
/// of the least-squares polynomial of this order.
/// @param times of the samples, s, relative to the instant.
/// @param velocity_scale s: how much velocities count in the fit (this times the velocity is like a
///   position); 0: columns are positions only, otherwise positions and then velocities.
Eigen::Matrix3Xd polynomialWeights(const Eigen::VectorXd& times, int order,
                                   double velocity_scale = 0);

/// Rows of a recording around one: `window` of them, inside of the recording.
struct WindowRows {
  Eigen::Index first;
  Eigen::Index count;
};
WindowRows windowAround(const EncoderRecording& recording, std::size_t row, int window);

/// Times of these rows relative to the time of `row`, s.
Eigen::VectorXd relativeTimes(const EncoderRecording& recording, const WindowRows& window,
                              std::size_t row);

/// Weighted sums of the positions: 3 x joints.
Eigen::Matrix3Xd weightedPositions(const EncoderRecording& recording, const WindowRows& window,
                                   std::size_t row, const Eigen::Matrix3Xd& weights);

/// Rows 0, 1 and 2 of `sums` as a motion.
Motion motionOf(const Eigen::Matrix3Xd& sums);

}  // namespace virtual_work_dynamics
