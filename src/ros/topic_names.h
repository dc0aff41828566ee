#pragma once

#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// A joint's name as part of a ROS graph name: every character outside of [A-Za-z0-9_] becomes `_`,
/// a leading digit gets a `_` before it.
std::string legalTopicName(const std::string& joint);

/// legalTopicName() of each. @throws SceneError naming both joints when two of them collide.
std::vector<std::string> legalTopicNames(const std::vector<std::string>& joints);

}  // namespace virtual_work_dynamics
