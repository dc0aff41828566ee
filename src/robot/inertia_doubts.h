#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Finds inertias that no body can have and moving leaves without mass, one doubt for each link or
/// moving body. Impossible are a negative principal moment and a broken triangle inequality, both
/// beyond 1e-9 of the trace. Zero moments are possible: the paper's slender rods have one.
std::vector<Doubt> inertiaDoubts(const std::vector<Link>& links, const std::vector<Joint>& joints);

}  // namespace virtual_work_dynamics
