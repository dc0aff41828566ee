#include "ros/root_conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "base/printable.h"
#include "motion/largest_motion.h"
#include "motion/orientation_length.h"
#include "ros/message_text.h"

namespace virtual_work_dynamics {
namespace {

std::optional<Rejection> readStamp(const std_msgs::Header& header, std::int64_t& stamp_ns) {
  if (header.stamp.isZero()) return Rejection{DropReason::kZeroStamp, "its stamp is zero"};
  stamp_ns = static_cast<std::int64_t>(header.stamp.toNSec());
  return std::nullopt;
}

std::optional<Rejection> readTwist(const geometry_msgs::Twist& message, const std::string& what,
                                   Eigen::Vector3d& linear, Eigen::Vector3d& angular) {
  if (auto rejection = readVector(message.linear, what + ".linear", linear)) return rejection;
  return readVector(message.angular, what + ".angular", angular);
}

Rejection wrongLength(const std::string& whose, std::size_t values, const char* what,
                      std::size_t names) {
  return {DropReason::kArrayLength, whose + " has " + std::to_string(values) + " " + what +
                                        " for " + std::to_string(names) + " names"};
}

}  // namespace

std::optional<Rejection> RootConversion::checkFrame(const std_msgs::Header& header) const {
  if (header.frame_id == inertial_frame_) return std::nullopt;
  return Rejection{DropReason::kUnknownFrame, "its frame " + inQuotes(header.frame_id) +
                                                  " is not the inertial frame " +
                                                  inQuotes(inertial_frame_)};
}

std::optional<Rejection> RootConversion::checkLink(const char* what,
                                                   const std::string& name) const {
  if (name == link_) return std::nullopt;
  return Rejection{DropReason::kUnknownFrame, std::string("its ") + what + " " + inQuotes(name) +
                                                  " is not the root link " + inQuotes(link_)};
}

std::optional<Rejection> RootConversion::columnOf(const std::vector<std::string>& names,
                                                  std::size_t& column) const {
  const auto found = std::find(names.begin(), names.end(), link_);
  if (found == names.end()) {
    return Rejection{DropReason::kUnknownFrame,
                     "it does not name the root link " + inQuotes(link_) +
                         (names.empty() ? ", but nothing" : ", but " + shortList(names))};
  }
  if (std::find(found + 1, names.end(), link_) != names.end()) {
    return Rejection{DropReason::kJointTwice, "it names " + inQuotes(link_) + " twice"};
  }
  column = static_cast<std::size_t>(found - names.begin());
  return std::nullopt;
}

std::optional<Rejection> RootConversion::convert(const nav_msgs::Odometry& message,
                                                 RootPose& pose) {
  poses_.begin();
  if (auto rejection = checkFrame(message.header)) return rejection;
  if (auto rejection = checkLink("child_frame_id", message.child_frame_id)) return rejection;
  if (auto rejection = readStamp(message.header, pose.stamp_ns)) return rejection;
  const geometry_msgs::Pose& from = message.pose.pose;
  if (auto rejection = readVector(from.position, "position", pose.position)) return rejection;
  if (auto rejection = poses_.readOrientation(from.orientation, "orientation", pose.orientation))
    return rejection;
  poses_.takeTwist(message.twist.twist, pose.velocity, pose.angular_velocity);
  pose.velocity = pose.orientation * pose.velocity;
  pose.angular_velocity = pose.orientation * pose.angular_velocity;
  return std::nullopt;
}

std::optional<Rejection> RootConversion::convert(const geometry_msgs::TransformStamped& message,
                                                 RootPose& pose) {
  poses_.begin();
  if (auto rejection = checkFrame(message.header)) return rejection;
  if (auto rejection = checkLink("child_frame_id", message.child_frame_id)) return rejection;
  if (auto rejection = readStamp(message.header, pose.stamp_ns)) return rejection;
  return poses_.readTransform(message.transform, "", pose.position, pose.orientation);
}

std::optional<Rejection> RootConversion::check(geometry_msgs::TransformStamped& message) {
  Eigen::Vector3d position;
  Eigen::Quaterniond orientation;
  geometry_msgs::Transform& transform = message.transform;
  auto rejection = poses_.readTransform(transform, "", position, orientation);
  if (rejection) {
    rejection->text = "of frame " + inQuotes(message.child_frame_id) + ", " + rejection->text;
    return rejection;
  }
  transform.rotation.x = orientation.x();
  transform.rotation.y = orientation.y();
  transform.rotation.z = orientation.z();
  transform.rotation.w = orientation.w();
  return std::nullopt;
}

std::optional<Rejection> RootConversion::convert(const sensor_msgs::MultiDOFJointState& message,
                                                 RootPose& pose) {
  const std::size_t names = message.joint_names.size();
  std::size_t column = 0;
  poses_.begin();
  if (auto rejection = checkFrame(message.header)) return rejection;
  if (auto rejection = columnOf(message.joint_names, column)) return rejection;
  if (message.transforms.size() != names)
    return wrongLength("it", message.transforms.size(), "transforms", names);
  const bool twists = !message.twist.empty();
  if (twists && message.twist.size() != names)
    return wrongLength("it", message.twist.size(), "twists", names);
  if (auto rejection = readStamp(message.header, pose.stamp_ns)) return rejection;
  if (auto rejection =
          poses_.readTransform(message.transforms[column], "", pose.position, pose.orientation))
    return rejection;
  if (twists) poses_.takeTwist(message.twist[column], pose.velocity, pose.angular_velocity);
  return std::nullopt;
}

std::optional<Rejection> RootConversion::convert(
    const trajectory_msgs::MultiDOFJointTrajectory& message, std::int64_t start_ns,
    std::vector<RootPoint>& points) {
  const std::size_t names = message.joint_names.size();
  std::size_t column = 0;
  if (auto rejection = checkFrame(message.header)) return rejection;
  if (auto rejection = columnOf(message.joint_names, column)) return rejection;
  if (message.points.empty()) return Rejection{DropReason::kNoPoints, "it has no points"};
  points.resize(message.points.size());
  std::int64_t previous = -1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const trajectory_msgs::MultiDOFJointTrajectoryPoint& from = message.points[i];
    if (from.transforms.size() != names)
      return wrongLength(pointText(i), from.transforms.size(), "transforms", names);
    if (from.velocities.size() != names)
      return wrongLength(pointText(i), from.velocities.size(), "velocities", names);
    if (from.accelerations.size() != names)
      return wrongLength(pointText(i), from.accelerations.size(), "accelerations", names);
    const std::int64_t time = from.time_from_start.toNSec();
    if (time <= previous || time > kLastStamp - start_ns) {
      return Rejection{DropReason::kTimes,
                       "time_from_start of " + pointText(i) + " is " +
                           numberText(static_cast<double>(time) / 1e9) + " s, " +
                           (time < 0           ? "less than zero"
                            : time <= previous ? "not later than the point before"
                                               : "beyond the last instant of ROS time")};
    }
    previous = time;
    points[i].stamp_ns = start_ns + time;
    if (auto rejection = readPoint(from, column, pointText(i) + " ", points[i].motion))
      return rejection;
  }
  return std::nullopt;
}

std::optional<Rejection> RootConversion::readPoint(
    const trajectory_msgs::MultiDOFJointTrajectoryPoint& from, std::size_t column,
    const std::string& where, RootMotion& motion) {
  if (auto rejection =
          poses_.readTransform(from.transforms[column], where, motion.position, motion.orientation))
    return rejection;
  if (auto rejection = readTwist(from.velocities[column], where + "velocity", motion.velocity,
                                 motion.angular_velocity))
    return rejection;
  return readTwist(from.accelerations[column], where + "acceleration", motion.acceleration,
                   motion.angular_acceleration);
}

}  // namespace virtual_work_dynamics
