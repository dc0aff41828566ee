#pragma once

#include <sensor_msgs/MultiDOFJointState.h>

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "motion/turn_estimator.h"
#include "ros/pose_reading.h"
#include "ros/rejection.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// What a message tells of a joint that turns freely: vectors in the axes of the joint's frame on
/// the parent.
struct FreeJointSample {
  std::size_t orientation = 0;  ///< index into Motion::orientations
  TurnSample turn;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of a floating joint, m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s; NaN: not given
};

/// Checks messages that tell the positions of joints that turn freely, by the names of the joints.
/// A transform is the pose of the child link in the joint's frame on the parent: the identity where
/// the joint is at zero. A twist is in the same frame.
class FreeJointConversion {
 public:
  /// @param mechanism must outlive it
  explicit FreeJointConversion(const Mechanism& mechanism) : mechanism_(mechanism) {}

  /// Converts a message; other names than those of joints that turn freely are ignored. Allocates
  /// only for a rejection, once `samples` has room for all joints.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> convert(const sensor_msgs::MultiDOFJointState& message,
                                   std::vector<FreeJointSample>& samples);
  /// Of poses and twists, see PoseReading.
  std::string takeDoubt() { return poses_.takeDoubt(); }

 private:
  const Mechanism& mechanism_;
  PoseReading poses_;
};

/// Whether any name is that of a joint that turns freely.
bool namesFreeJoint(const Mechanism& mechanism, const std::vector<std::string>& names);

}  // namespace virtual_work_dynamics
