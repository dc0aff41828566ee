#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

/// How a joint that turns freely does so in the rows of a table, as it is given.
struct FreeTurns {
  std::string joint;
  std::vector<FreeTurn> rows;
  std::vector<std::string> lack;  ///< members of FreeTurn that were not given
  double orientation_error = 0;   ///< how far the lengths of given orientations were off 1
  std::vector<TurnCovariance> covariances;  ///< by row; empty: not known
};

/// A motion as a table: row i of each matrix belongs to times[i], column j to joints[j]. Wrenches
/// that are applied while it goes on may stand beside it.
struct MotionTable {
  std::vector<std::string> joints;
  std::vector<double> times;      ///< s
  Eigen::MatrixXd positions;      ///< rows x joints, rad or m
  Eigen::MatrixXd velocities;     ///< rows x joints, rad/s or m/s; 0 x 0: not given
  Eigen::MatrixXd accelerations;  ///< rows x joints, rad/s^2 or m/s^2; 0 x 0: not given
  /// Covariances of (q, qd, qdd), see MotionCovariance: rows x joints, row after row; empty: not
  /// known.
  std::vector<Eigen::Matrix3d> covariances;

  std::vector<FreeTurns> turns;  ///< as read; completeFreeTurns() makes a motion of them
  /// rows x 4 n: Motion::orientations as x y z w of each; 0 x 0 where the robot has none.
  Eigen::MatrixXd orientations;

  std::vector<RootMotion> roots;        ///< by row: how the root link moves; empty: not given
  std::vector<std::string> roots_lack;  ///< members of RootMotion that `roots` were not given
  double orientation_error = 0;         ///< how far the lengths of given orientations were off 1
  std::vector<RootCovariance> root_covariances;  ///< by row; empty: not known

  std::vector<std::string> wrenches;  ///< names of applied wrenches
  Eigen::MatrixXd wrench_values;      ///< rows x 6 wrenches: fx fy fz tx ty tz of each, N and N m

  bool hasVelocities() const { return velocities.size() > 0; }
  bool hasAccelerations() const { return accelerations.size() > 0; }
  /// Whether the covariances of joints are known.
  bool hasCovariances() const { return !covariances.empty(); }
};

}  // namespace virtual_work_dynamics
