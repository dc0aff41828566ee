#pragma once

#include <string>
#include <vector>

#include "offline/joint_renaming.h"

namespace virtual_work_dynamics {

constexpr double kDegree = 3.14159265358979323846 / 180;  ///< rad

/// Where a motion is read from.
struct MotionSource {
  std::vector<std::string> files;  ///< one, or the parts of a recording that rosbag split
  std::string topic;               ///< of joint states, in a bag; empty: the only one
  std::string usual_topic = "/joint_states";  ///< the one that is preferred among several
  JointRenaming rename;                       ///< of its joints
  bool degrees = false;                       ///< whether angles are in degrees
  bool efforts = false;                       ///< whether its efforts are read by another way, too
  std::vector<std::string> left_out;          ///< joints that are not taken from a bag

  bool empty() const { return files.empty(); }
  /// Name for messages.
  std::string name() const {
    if (files.empty()) return "";
    return files.size() == 1 ? files[0] : files.front() + " … " + files.back();
  }
};

}  // namespace virtual_work_dynamics
