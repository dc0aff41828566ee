#pragma once

#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/root_motion.h"

namespace virtual_work_dynamics {

/// A wrench in root axes, in inertial axes; the moment stays about its point.
inline Wrench inInertialAxes(const RootMotion& root, const Wrench& wrench) {
  return {root.orientation * wrench.force, root.orientation * wrench.torque};
}

/// A pose in the root link, in the inertial frame.
inline Pose inInertialFrame(const RootMotion& root, const Pose& pose) {
  return {root.position + root.orientation * pose.position, root.orientation * pose.orientation};
}

/// The velocity of a frame relative to the root link, in its axes: against the inertial frame, in
/// inertial axes. @param pose of the frame in the root link
inline Twist inInertialFrame(const RootMotion& root, const Pose& pose, const Twist& twist) {
  const Eigen::Vector3d arm = root.orientation * pose.position;
  return {root.velocity + root.angular_velocity.cross(arm) + root.orientation * twist.linear,
          root.angular_velocity + root.orientation * twist.angular};
}

}  // namespace virtual_work_dynamics
