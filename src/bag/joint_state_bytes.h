#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace virtual_work_dynamics {

/// A joint state as its message has it. Its memory is used again by readJointState().
struct JointStateContent {
  std::int64_t stamp_ns = 0;
  std::vector<std::string> names;
  std::vector<double> positions, velocities, efforts;
};

// Type and version of sensor_msgs/JointState, as connections say them.
constexpr std::string_view kJointStateType = "sensor_msgs/JointState";
constexpr std::string_view kJointStateMd5 = "3066dcd76a6cfaef579bd0f34173e9fd";

/// Reads a serialized sensor_msgs/JointState: the header's seq, stamp and frame, then the lists
/// name, position, velocity and effort, each behind its length (http://wiki.ros.org/msg).
/// @returns false when the bytes are not such a message.
bool readJointState(std::string_view bytes, JointStateContent& content);

}  // namespace virtual_work_dynamics
