#pragma once

#include <string>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Reads a robot description: any tree of revolute, continuous, prismatic and fixed joints, mimic
/// joints included. Orientations are taken from the text's `rpy` in long double.
/// @param urdf the XML text.
/// @throws UrdfError, one line naming the link or joint: broken XML, negative or non-finite mass,
///   non-finite inertia, zero axis, floating or planar joint, mimic cycle, reserved name.
///   What is doubtful but computable ends up in Mechanism::doubts().
Mechanism readUrdf(const std::string& urdf);

/// The same from a file. @throws FileError when it cannot be read, UrdfError as above.
Mechanism readUrdfFile(const std::string& path);

}  // namespace virtual_work_dynamics
