#pragma once

#include <vector>

#include "loops/kinematics.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// By condition: whether its row of the Jacobian is zero in every position, except for rounding, as
/// those of a planar mechanism across its plane. Such a row holds nothing, and its multiplier is
/// open in every position. Only rows of closures are found, and none beside conditions that drive.
/// Allocates.
std::vector<bool> zeroRows(const Mechanism& mechanism, const LoopKinematics& kinematics);

/// Those of a set, counted from its first condition, ascending.
std::vector<int> zeroRowsOf(const LoopKinematics& kinematics, std::size_t set,
                            const std::vector<bool>& zero);

}  // namespace virtual_work_dynamics
