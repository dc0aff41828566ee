#pragma once

#include <vector>

#include "loops/groups.h"
#include "loops/kinematics.h"
#include "scene/couplings.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The length that makes moments comparable with forces where the scene does not give it, m: the
/// size of the loops; without closures, what the couplings say.
double comparedLength(const Mechanism& mechanism, const std::vector<ResolvedCoupling>& couplings,
                      const std::vector<LoopGroup>& groups, const LoopKinematics& kinematics);

}  // namespace virtual_work_dynamics
