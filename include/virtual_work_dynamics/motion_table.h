#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// A motion as a table: row i of each matrix belongs to times[i], column j to joints[j].
struct MotionTable {
  std::vector<std::string> joints;
  std::vector<double> times;      ///< s
  Eigen::MatrixXd positions;      ///< rows x joints, rad or m
  Eigen::MatrixXd velocities;     ///< rows x joints, rad/s or m/s; 0 x 0: not given
  Eigen::MatrixXd accelerations;  ///< rows x joints, rad/s^2 or m/s^2; 0 x 0: not given

  bool hasVelocities() const { return velocities.size() > 0; }
  bool hasAccelerations() const { return accelerations.size() > 0; }
};

}  // namespace virtual_work_dynamics
