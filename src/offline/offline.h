#pragma once

#include "offline/arguments.h"

namespace virtual_work_dynamics {

/// Does what the command line asks for: reads and checks all of the input, then computes row by
/// row. Results go to the output, warnings and notes to standard error, one line each.
/// @throws Error, also UsageError; no output file is left behind then.
void runOffline(Arguments arguments);

}  // namespace virtual_work_dynamics
