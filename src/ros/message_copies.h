#pragma once

#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Wrench.h>
#include <ros/time.h>

#include <cstdint>

#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

inline ros::Time timeOf(std::int64_t stamp_ns) {
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  return stamp;
}

// The following functions copy results into existing messages.

template <typename Message>
void copyVector(const Eigen::Vector3d& from, Message& to) {
  to.x = from.x();
  to.y = from.y();
  to.z = from.z();
}

inline void copyWrench(const Wrench& from, geometry_msgs::Wrench& to) {
  copyVector(from.force, to.force);
  copyVector(from.torque, to.torque);
}

inline void copyPose(const Pose& from, geometry_msgs::Transform& to) {
  copyVector(from.position, to.translation);
  to.rotation.x = from.orientation.x();
  to.rotation.y = from.orientation.y();
  to.rotation.z = from.orientation.z();
  to.rotation.w = from.orientation.w();
}

inline void copyTwist(const Twist& from, geometry_msgs::Twist& to) {
  copyVector(from.linear, to.linear);
  copyVector(from.angular, to.angular);
}

}  // namespace virtual_work_dynamics
