#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Takes from a description what a mechanism is made of, and checks that urdfdom can read it.
///
/// urdfdom gets no more than that: what it says about meshes and materials has no part in dynamics
/// and would bury the one thing that counts, and where it refuses, its line names the consequence
/// rather than the cause.
/// @param doubts receives what is questionable: attributes that are not read, angles in degrees.
/// @returns the XML of links, inertials and joints, numbers without blanks around them.
/// @throws UrdfError, one line that begins with the link or joint, the element and the value: a
///   name or value that is missing, given twice, unknown or not a number, or not one tree.
std::string checkedUrdf(const tinyxml2::XMLElement& robot, std::vector<Doubt>& doubts);

}  // namespace virtual_work_dynamics
