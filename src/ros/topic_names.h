#pragma once

#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// Makes a joint's name part of a ROS graph name: every character outside of [A-Za-z0-9_] becomes
/// `_`, and a leading digit gets a `_` before it.
std::string legalTopicName(const std::string& joint);

/// The legalTopicName() of each reaction's joint or closure.
/// @throws SceneError naming both when two names collide.
std::vector<std::string> reactionTopics(const std::vector<std::string>& reactions);

/// The legalTopicName() of each live wrench.
/// @throws SceneError naming both when two names collide.
std::vector<std::string> wrenchTopics(const std::vector<std::string>& wrenches);

}  // namespace virtual_work_dynamics
