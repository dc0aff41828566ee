#pragma once

#include <Eigen/Core>

#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// A twice continuously differentiable motion through knots. With accelerations and velocities at
/// the knots it consists of quintic Hermite pieces; with velocities alone it is the quintic spline
/// whose accelerations make the third derivative continuous; otherwise it is the cubic spline with
/// the end velocities given by the caller.
class Spline {
 public:
  /// Completes the knots. Allocates.
  /// @param start_velocity,end_velocity rad/s or m/s, used by the cubic spline only; empty: zero.
  /// @throws MotionError for no knots, times that do not increase, shapes that disagree, or values
  ///   that are not finite, naming the knot (counted from 1).
  explicit Spline(MotionTable knots, const Eigen::VectorXd& start_velocity = Eigen::VectorXd(),
                  const Eigen::VectorXd& end_velocity = Eigen::VectorXd());

  Eigen::Index coordinates() const { return knots_.positions.cols(); }
  double startTime() const { return knots_.times.front(); }
  double endTime() const { return knots_.times.back(); }

  /// Computes the motion at time t (s), exact at knots; outside of the knots it rests at the end
  /// positions. Does not allocate when the vectors already have the right size.
  /// @throws MotionError when t is NaN.
  void evaluate(double t, Motion& motion) const;

  /// The knots with the missing velocities and accelerations filled in.
  const MotionTable& knots() const { return knots_; }

 private:
  MotionTable knots_;
};

}  // namespace virtual_work_dynamics
