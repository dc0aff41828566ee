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
  /// Position, velocity and acceleration at t (s), exact derivatives of each other. Does not
  /// allocate when `motion` has the right size.
  virtual void evaluate(double t, Motion& motion) const = 0;
};

/// q_j = amplitude_j [1 - cos(2 pi t / period)], the paper's (5.11) with period 12 s.
/// @throws MotionError for a period or duration that is not positive.
std::unique_ptr<MotionLaw> cosineLaw(const Eigen::VectorXd& amplitudes, double period,
                                     double duration);

/// q_j = amplitude_j sin(phi(t)), phi' running linearly from 2 pi start to 2 pi end (Hz) over the
/// duration: a sine sweep. @throws MotionError for frequencies below zero or duration not positive.
std::unique_ptr<MotionLaw> sineSweepLaw(const Eigen::VectorXd& amplitudes, double start_frequency,
                                        double end_frequency, double duration);

/// The motion through via points (positions only; the first and last at rest) that minimises the
/// integral of the squared jerk: quintic pieces, four times continuously differentiable at the
/// inner points. @throws MotionError for fewer than two points or times that do not increase.
std::unique_ptr<MotionLaw> minimumJerkLaw(const MotionTable& via_points);

/// A table played back: the Spline through it, its first row at t = 0.
/// @throws MotionError as Spline.
std::unique_ptr<MotionLaw> tableLaw(const MotionTable& table);

}  // namespace virtual_work_dynamics
