#pragma once

#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// Makes a joint's name part of a ROS graph name: every character outside of [A-Za-z0-9_] becomes
/// `_`, and a leading digit gets a `_` before it.
std::string legalTopicName(const std::string& joint);

/// The legalTopicName() of each joint. @throws SceneError naming both joints when two names
/// collide.
std::vector<std::string> legalTopicNames(const std::vector<std::string>& joints);

}  // namespace virtual_work_dynamics
