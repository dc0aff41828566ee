#pragma once

#include <Eigen/Core>
#include <vector>

namespace virtual_work_dynamics {

/// Covariance of a RootMotion: of a small turn of `orientation`, about the axes of the root link
/// (rad), then of the components of `angular_velocity`, `angular_acceleration` and `acceleration`.
using RootCovariance = Eigen::Matrix<double, 12, 12>;
/// Covariance of a FreeTurn: of a small turn of `orientation`, about the axes of the child link
/// (rad), then of the components of `angular_velocity` and `angular_acceleration`.
using TurnCovariance = Eigen::Matrix<double, 9, 9>;
/// Covariance of a Wrench: of the components of force and torque, N and N m.
using WrenchCovariance = Eigen::Matrix<double, 6, 6>;

/// How well a Motion, and the Load with it, are known. Coordinates, joints that turn freely, the
/// root and wrenches are independent of each other.
struct MotionCovariance {
  /// For each generalized coordinate the covariance of (q, qd, qdd), in rad or m, per s and per
  /// s^2. It may be semidefinite or zero.
  std::vector<Eigen::Matrix3d> coordinates;
  /// Of each joint that turns freely, in the order of Motion::orientations, in place of those of
  /// its angles; empty: those of the angles count.
  std::vector<TurnCovariance> turns = {};
  /// Of the root link's motion, where it moves; zero: exact.
  RootCovariance root = RootCovariance::Zero();
  /// Index of the link whose motion, of its origin and axes, `root` is the covariance of. The
  /// motion of a root link that is known by a sensor on another link is as doubtful as the joints
  /// between them, too.
  int root_link = 0;
  /// Of each applied wrench of the scene, in its axes and about its point of action; empty: as
  /// AppliedWrench::deviation says. Those that the scene gives no deviation count as exact.
  std::vector<WrenchCovariance> wrenches = {};
};

}  // namespace virtual_work_dynamics
