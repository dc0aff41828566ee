#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// A motion given as an exact function of time, 0 <= t <= duration().
class MotionLaw {
 public:
  virtual ~MotionLaw() = default;
  virtual Eigen::Index coordinates() const = 0;
  virtual double duration() const = 0;  ///< s
  /// Computes position, velocity and acceleration at time t (s), exact derivatives of each other.
  /// Does not allocate when `motion` has the right size.
  virtual void evaluate(double t, Motion& motion) const = 0;
};

/// The law q_j = amplitude_j [1 - cos(2 pi t / period)]; with the period 12 s it is the paper's
/// (5.11).
/// @param amplitudes rad or m, one for each coordinate.   @param period s.   @param duration s.
/// @throws MotionError for a period or duration that is not positive, or an amplitude that is not
///   finite.
std::unique_ptr<MotionLaw> cosineLaw(const Eigen::VectorXd& amplitudes, double period,
                                     double duration);

/// A sine sweep: q_j = amplitude_j sin(phi(t)), where phi' runs linearly from 2 pi start_frequency
/// to 2 pi end_frequency over the duration.
/// @param amplitudes rad or m, one for each coordinate.   @param start_frequency,end_frequency Hz.
/// @param duration s.
/// @throws MotionError for a frequency below zero, a duration that is not positive, or an amplitude
///   that is not finite.
std::unique_ptr<MotionLaw> sineSweepLaw(const Eigen::VectorXd& amplitudes, double start_frequency,
                                        double end_frequency, double duration);

/// The motion through via points that minimises the integral of the squared jerk: quintic pieces,
/// four times continuously differentiable at the inner points, at rest at both ends. Only the
/// positions of the points count.
/// @throws MotionError for fewer than two points, times that do not increase, or a position that is
///   not finite.
std::unique_ptr<MotionLaw> minimumJerkLaw(const MotionTable& via_points);

/// The Spline through a table, shifted in time so that the first row is at t = 0. Without
/// velocities it starts and ends with the table's own slopes: those of the polynomials through its
/// first and last five rows, or at rest where such a slope is not larger than three times the
/// difference that a row less makes to it. The spline goes through the rows, their noise included.
/// @throws MotionError as the constructor of Spline.
std::unique_ptr<MotionLaw> tableLaw(const MotionTable& table);

}  // namespace virtual_work_dynamics
