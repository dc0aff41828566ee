#pragma once

#include <string>

namespace virtual_work_dynamics {

/// The full name of a private parameter or topic of this node, as a user has to write it elsewhere;
/// "~name" before ros::init().
std::string privateName(const std::string& name);

}  // namespace virtual_work_dynamics
