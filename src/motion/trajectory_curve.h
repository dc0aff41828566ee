#pragma once

#include <Eigen/Core>

#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/spline.h"

namespace virtual_work_dynamics {

/// The motion between the points of a trajectory, as joint_trajectory_controller makes it: quintic
/// pieces between points with positions, velocities and accelerations, cubic pieces between points
/// with positions and velocities, whose acceleration jumps from piece to piece. Only between points
/// with positions alone, where the controller goes straight and would have to change velocities at
/// once, it is the cubic Spline, whose accelerations are finite and continuous.
class TrajectoryCurve {
 public:
  /// Allocates.
  /// @param start_velocity,end_velocity rad/s or m/s, used with positions alone; empty: zero.
  /// @throws MotionError as the constructor of Spline.
  explicit TrajectoryCurve(MotionTable points,
                           const Eigen::VectorXd& start_velocity = Eigen::VectorXd(),
                           const Eigen::VectorXd& end_velocity = Eigen::VectorXd());

  double startTime() const { return spline_.startTime(); }
  double endTime() const { return spline_.endTime(); }

  /// Computes the motion at time t (s). Where the acceleration jumps, at an inner point of cubic
  /// pieces, it is that of the piece which begins there. Outside of the points the motion rests.
  /// Does not allocate when the vectors already have the right size.
  /// @throws MotionError when t is NaN.
  void evaluate(double t, Motion& motion) const;

 private:
  void evaluateCubic(double t, Motion& motion) const;

  bool cubic_pieces_;
  Spline spline_;
};

}  // namespace virtual_work_dynamics
