#pragma once

#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "motion/root_estimator.h"
#include "motion/root_trajectory.h"
#include "ros/pose_reading.h"
#include "ros/rejection.h"

namespace virtual_work_dynamics {

/// Checks messages that tell how the root link moves, as PoseReading does, and turns their vectors
/// into inertial axes. Each function allocates only for a
/// rejection, except for the points of a trajectory, and returns why the message is to be dropped,
/// or nothing.
class RootConversion {
 public:
  /// @param inertial_frame frame_id of the frame that motions are against
  /// @param link what messages call the root link
  RootConversion(std::string inertial_frame, std::string link)
      : inertial_frame_(std::move(inertial_frame)), link_(std::move(link)) {}

  const std::string& link() const { return link_; }
  const std::string& inertialFrame() const { return inertial_frame_; }

  /// A pose in header.frame_id, and its twist in the axes of child_frame_id.
  std::optional<Rejection> convert(const nav_msgs::Odometry& message, RootPose& pose);
  /// Poses, and twists if there are any, in header.frame_id.
  std::optional<Rejection> convert(const sensor_msgs::MultiDOFJointState& message, RootPose& pose);
  /// Poses, velocities and accelerations in header.frame_id.
  /// @param start_ns instant from which `time_from_start` counts, ns.
  std::optional<Rejection> convert(const trajectory_msgs::MultiDOFJointTrajectory& message,
                                   std::int64_t start_ns, std::vector<RootPoint>& points);
  /// A transform from header.frame_id to child_frame_id, without rates.
  std::optional<Rejection> convert(const geometry_msgs::TransformStamped& message, RootPose& pose);

  /// Checks the numbers of a transform between any two frames, and scales its quaternion to 1.
  std::optional<Rejection> check(geometry_msgs::TransformStamped& message);

  /// Of poses and twists, see PoseReading.
  std::string takeDoubt() { return poses_.takeDoubt(); }
  bool twistLeftOut() const { return poses_.twistLeftOut(); }

 private:
  std::optional<Rejection> checkFrame(const std_msgs::Header& header) const;
  std::optional<Rejection> checkLink(const char* what, const std::string& name) const;
  std::optional<Rejection> columnOf(const std::vector<std::string>& names,
                                    std::size_t& column) const;
  std::optional<Rejection> readPoint(const trajectory_msgs::MultiDOFJointTrajectoryPoint& from,
                                     std::size_t column, const std::string& where,
                                     RootMotion& motion);

  const std::string inertial_frame_, link_;
  PoseReading poses_;
};

}  // namespace virtual_work_dynamics
