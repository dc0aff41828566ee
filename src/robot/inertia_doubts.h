#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Inertias that no body can have, one doubt for each link or moving body: a negative principal
/// moment or a broken triangle inequality (both beyond 1e-9 of the trace), and moving leaves
/// without mass. Zero moments are legal: the paper's slender rods have one.
std::vector<Doubt> inertiaDoubts(const std::vector<Link>& links, const std::vector<Joint>& joints);

}  // namespace virtual_work_dynamics
