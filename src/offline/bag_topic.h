#pragma once

#include <string>
#include <vector>

#include "offline/motion_source.h"

namespace virtual_work_dynamics {

/// The parts of a recording in the order in which they were recorded.
/// @throws FileError when one of them is not a bag.
std::vector<std::string> bagParts(const MotionSource& source);

/// The topic of joint states that is read from bags: the one asked for, the only one, the usual one
/// of the source, or /joint_states.
/// @throws FileError, one line, when that does not exist or is not of joint states, or when there
///   are several and none is asked for.
std::string jointStateTopic(const MotionSource& source);

}  // namespace virtual_work_dynamics
