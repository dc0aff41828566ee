#pragma once

#include <geometry_msgs/InertiaStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <std_msgs/Bool.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <cstdint>
#include <string_view>

#include "bag/byte_cursor.h"

namespace virtual_work_dynamics {

// Whether bytes are those of a message, by the lengths in them: what a damaged bag says of lengths
// must not become memory. The second argument only says which message is meant.
bool areBytesOf(ByteCursor bytes, const geometry_msgs::InertiaStamped&);
bool areBytesOf(ByteCursor bytes, const geometry_msgs::Vector3Stamped&);
bool areBytesOf(ByteCursor bytes, const geometry_msgs::WrenchStamped&);
bool areBytesOf(ByteCursor bytes, const nav_msgs::Odometry&);
bool areBytesOf(ByteCursor bytes, const sensor_msgs::Imu&);
bool areBytesOf(ByteCursor bytes, const sensor_msgs::MultiDOFJointState&);
bool areBytesOf(ByteCursor bytes, const std_msgs::Bool&);
bool areBytesOf(ByteCursor bytes, const tf2_msgs::TFMessage&);
bool areBytesOf(ByteCursor bytes, const trajectory_msgs::JointTrajectory&);
bool areBytesOf(ByteCursor bytes, const trajectory_msgs::MultiDOFJointTrajectory&);

/// Reads a serialized message. @returns false when the bytes are not such a message.
template <typename Message>
bool readBytes(std::string_view bytes, Message& message) {
  if (!areBytesOf(ByteCursor(bytes), message)) return false;
  // The stream only reads.
  auto* const begin = reinterpret_cast<std::uint8_t*>(const_cast<char*>(bytes.data()));
  ros::serialization::IStream stream(begin, static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
  return true;
}

}  // namespace virtual_work_dynamics
