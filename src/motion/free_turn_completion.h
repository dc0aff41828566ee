#pragma once

#include <string>
#include <vector>

#include "motion/root_completion.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Estimates what is not given of how a joint turns, by the coordinates of its quaternion as of
/// that of a root that moves. @returns what was found; nothing where everything is given.
/// @throws MotionError as completeMotion().
std::vector<RootEstimate> estimateFreeTurns(const Mechanism& mechanism, const MotionTable& motion,
                                            const CompletionSettings& settings, FreeTurns& turns);

/// Puts the turns of a table into its columns of all coordinates, whose angles they replace, and
/// its orientations; those of joints that are not in `turns` are the identity.
/// @param motion with columns of all coordinates, in their order
void placeFreeTurns(const Mechanism& mechanism, MotionTable& motion);

}  // namespace virtual_work_dynamics
