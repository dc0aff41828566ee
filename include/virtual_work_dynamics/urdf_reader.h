#pragma once

#include <string>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Reads a robot description: any tree of revolute, continuous, prismatic and fixed joints, mimic
/// joints included. Orientations are computed from the text's `rpy` in long double. What is
/// doubtful but computable ends up in Mechanism::doubts(): impossible inertias, numbers that are
/// hardly in SI units, elements that change the mechanics but are not read. Geometry is not looked
/// at.
/// @param urdf the XML text.
/// @throws UrdfError, one line that begins with the link or joint: broken XML, a xacro file that
/// was
///   not expanded, an unknown or doubled name, negative or non-finite mass, non-finite inertia,
///   zero axis, mimic cycle, reserved name.
Mechanism readUrdf(const std::string& urdf);

/// Reads a robot description from a file, as readUrdf() does from text.
/// @throws FileError when the file cannot be read, UrdfError as readUrdf().
Mechanism readUrdfFile(const std::string& path);

}  // namespace virtual_work_dynamics
