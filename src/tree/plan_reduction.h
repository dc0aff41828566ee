#pragma once

#include <string>
#include <vector>

#include "tree/plan.h"

namespace virtual_work_dynamics {

/// Leaves out of a plan with all bodies, outputs and applied wrenches what matters to no output,
/// and settles how the sweeps go through the rest. `names`: joints of the bodies, for
/// Plan::left_out; `gamma_root`: -g.
void reducePlan(Plan<long double>& plan, const std::vector<std::string>& names,
                const Vec3<long double>& gamma_root);

}  // namespace virtual_work_dynamics
