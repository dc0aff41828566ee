#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Velocities and accelerations that are given, but go with the slopes of positions and velocities
/// by a factor of more than two or less than a half, as those in other units and of another sign
/// do: one text for each, with the factor. Of rows that are too few or too far apart to tell,
/// nothing is said.
/// @param motion with increasing times.
std::vector<std::string> slopeDoubts(const MotionTable& motion);

}  // namespace virtual_work_dynamics
