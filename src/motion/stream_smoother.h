#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "motion/stream_identification.h"
#include "motion/stream_model.h"

namespace virtual_work_dynamics {

/// Position, velocity and acceleration of a coordinate at an instant, with their covariance.
struct SmoothedSample {
  Eigen::Vector3d motion;      ///< rad, rad/s, rad/s^2 or m …
  Eigen::Matrix3d covariance;  ///< zero unless wanted
};

/// Smooths a recording of one coordinate with all of its samples (fixed interval, without lag):
/// forward by a Kalman filter, back by the adjoint of Bryson and Frazier (1963).
/// @param samples times increasing; nothing is assumed across gaps longer than `longest_gap`, s.
/// @param model of order `order`, 3 … kHighestOrder.   @param interval usual time from sample to
/// sample, s.
/// @param lag s: uses samples up to this time after each one only; infinite: all of them.
/// @param take receives the result of each row, from the last row of each stretch to its first.
void smoothStream(const std::vector<StreamBlock>& samples, const StreamModel& model, int order,
                  double interval, double longest_gap, double lag, bool covariance,
                  const std::function<void(std::size_t row, const SmoothedSample&)>& take);

}  // namespace virtual_work_dynamics
