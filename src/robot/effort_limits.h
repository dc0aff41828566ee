#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Joint::effort_limit of each coordinate, N m or N; infinite where there is none.
std::vector<double> effortLimits(const Mechanism& mechanism);

}  // namespace virtual_work_dynamics
