#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Actuators that withTransmissions() has added, whose motion is that of the joints that they move:
/// a motion that gives all joints needs not give them.
class FollowingMotors {
 public:
  FollowingMotors() = default;
  /// Those that are not given though all joints that they move are.
  /// @param scene as withTransmissions() has made it
  /// @param given by coordinate
  FollowingMotors(const Mechanism& mechanism, const Scene& scene, const std::vector<bool>& given);

  bool any() const { return !motors_.empty(); }
  /// Whether each coordinate follows.
  const std::vector<bool>& coordinates() const { return coordinates_; }
  std::vector<std::string> names() const;

  /// Sets the positions of these.
  void placeIn(Eigen::VectorXd& q) const;
  /// Sets the motion of these. Does not allocate.
  void set(Motion& motion) const;
  /// Sets the columns, and covariances if there are any, of a table of all coordinates with
  /// velocities and accelerations.
  void set(MotionTable& table) const;
  /// Sets the covariances of these, from those of the joints. Does not allocate.
  void set(MotionCovariance& covariance) const;
  /// Makes these count for nothing in a fit of the others: they are no measurements of their own.
  /// Does not allocate.
  void loosen(MotionCovariance& covariance) const;

 private:
  struct Term {
    Eigen::Index joint;
    double ratio;  // what the motor moves by
  };
  struct Motor {
    std::string name;
    Eigen::Index coordinate;
    double offset;
    std::vector<Term> terms;
  };
  std::vector<Motor> motors_;
  std::vector<bool> coordinates_;
};

}  // namespace virtual_work_dynamics
