#pragma once

#include <ostream>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Prints closures and springs, what is actuated, degrees of freedom, redundant constraints, and
/// what is not determined, as computed in the assembled position.
void printLoops(std::ostream& out, const Mechanism& mechanism, const Scene& scene,
                const Dynamics& dynamics);

/// Prints what a sample costs, as far as that can be counted.
void printCost(std::ostream& out, const Scene& scene, const Dynamics& dynamics);

}  // namespace virtual_work_dynamics
