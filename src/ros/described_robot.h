#pragma once

#include <optional>

#include "virtual_work_dynamics/mechanism.h"

namespace ros {
class NodeHandle;
}

namespace virtual_work_dynamics {

/// The parameter that has the text of a description.
constexpr char kRobotDescription[] = "robot_description";

/// The robot of robot_description, which is searched upwards from the private namespace, for a node
/// that can do without it: nothing when there is none, or, with a warning, when it is broken.
/// @param private_node the handle NodeHandle("~").
std::optional<Mechanism> describedRobot(const ros::NodeHandle& private_node);

}  // namespace virtual_work_dynamics
