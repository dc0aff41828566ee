#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace virtual_work_dynamics {

/// Force and moment that the parent exerts on the child; the moment is about the joint origin O_k.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N m
};

/// Pose of a joint frame (the child link's frame) in the root link.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< R_0K
};

/// Velocity of a joint frame in root axes.
struct Twist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< velocity of the point O_k, m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s
};

/// Six flags of a wrench: fx fy fz tx ty tz.
using Determined = std::array<bool, 6>;

/// How far a motion violates the conditions of one closure: the larger one of two norms, of the
/// conditions that are lengths and of those that are directions.
struct ClosureResidual {
  double position = 0;      ///< m or rad
  double velocity = 0;      ///< m/s or rad/s
  double acceleration = 0;  ///< m/s^2 or rad/s^2
};

/// How much rigid-body mechanics determines at one position, by the null space of [S^T A^T].
struct Determinacy {
  int rank = 0;                   ///< rank of [S^T A^T]
  int redundant_constraints = 0;  ///< conditions less the rank of A
  int redundancy = 0;             ///< unknowns less rank: redundant constraints and over-actuation
  int free_motions = 0;           ///< motions that no actuated joint and no closure holds
  double gap = 0;                 ///< least entry that counts for the rank over the largest other
  double condition = 0;           ///< estimated condition of the determined part
};

/// Condition above which a position counts as close to singular: an error of 1e-4 rad may then
/// change a force by 100 %.
constexpr double kCloseToSingular = 1e4;

}  // namespace virtual_work_dynamics
