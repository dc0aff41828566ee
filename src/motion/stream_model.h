#pragma once

#include <cmath>

namespace virtual_work_dynamics {

/// The highest order of a motion, see StreamModel.
constexpr int kHighestOrder = 6;

/// What is assumed of the samples of one coordinate: their noises, and how fast the motion changes.
/// The derivative of order N of the position is white noise (N = 4: "white snap"): the motion is a
/// polynomial of order N - 1 that this noise bends all the time.
struct StreamModel {
  double density = 1;             ///< of the derivative of order N, (rad/s^N)^2 s or (m/s^N)^2 s
  double position_variance = 1;   ///< of a sample, rad^2 or m^2
  double velocity_variance = -1;  ///< (rad/s)^2 or (m/s)^2; negative: velocities are not used
  double stamp_variance = 0;      ///< s^2: a stamp that errs by dt is a position that errs by qd dt

  bool usesVelocities() const { return velocity_variance > 0; }
  /// Variance of a position sample of a joint that moves at qd.
  double variance(double qd) const { return position_variance + qd * qd * stamp_variance; }
};

/// Time constant of a model, s: what swings by one radian in this time comes out of the smoother
/// with half its amplitude. `interval` is the time from sample to sample, s.
inline double timeConstant(const StreamModel& model, int order, double interval) {
  return std::pow(model.position_variance * interval / model.density, 0.5 / order);
}

/// The density that gives a model this time constant.
inline double densityFor(double time_constant, double position_variance, int order,
                         double interval) {
  return position_variance * interval / std::pow(time_constant, 2 * order);
}

/// The bandwidth, Hz, that belongs to a time constant, s; and the other way round.
inline double bandwidthOf(double time_constant) {
  constexpr double kTwoPi = 6.283185307179586;
  return 1 / (kTwoPi * time_constant);
}

}  // namespace virtual_work_dynamics
