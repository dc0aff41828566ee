#pragma once

#include "offline/arguments.h"

namespace virtual_work_dynamics {

/// Computes the joint states and trajectories of a bag as inverse_dynamics_node does, and writes
/// its topics into another bag, a message at a time. Notes and warnings go to standard error.
/// @param arguments whose output is a bag
/// @throws UsageError or Error, one line; no output stays behind then.
void runToBag(Arguments arguments);

}  // namespace virtual_work_dynamics
