#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Says why no body has a moment of inertia about its centre of mass, in kg m^2: a negative
/// principal moment or a broken triangle inequality, beyond 1e-9 of the trace; empty when a body
/// can have it.
std::string impossibleInertia(const Matrix3l& inertia);

/// Finds inertias that no body can have and moving leaves without mass, one doubt for each link or
/// moving body. Zero moments are possible: the paper's slender rods have one.
std::vector<Doubt> inertiaDoubts(const std::vector<Link>& links, const std::vector<Joint>& joints);

}  // namespace virtual_work_dynamics
