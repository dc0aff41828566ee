#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// What `<limit effort="…">` of a description says of each coordinate, N m or N; infinite where it
/// gives no positive number. Nothing is computed from it.
/// @param urdf the text that the mechanism was read from
std::vector<double> effortLimits(const std::string& urdf, const Mechanism& mechanism);

}  // namespace virtual_work_dynamics
