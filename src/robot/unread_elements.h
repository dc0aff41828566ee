#pragma once

#include <tinyxml2.h>

#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Finds elements of a description that change its mechanics but are not read, one doubt for each
/// of the first ones: what closes loops or couples joints, with what to write instead; what is left
/// of xacro or SDF; and names of elements that are written almost like one that is read.
std::vector<Doubt> unreadElements(const tinyxml2::XMLElement& robot);

}  // namespace virtual_work_dynamics
