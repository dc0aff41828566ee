#pragma once

#include "offline/arguments.h"

namespace virtual_work_dynamics {

/// Refuses a command line that lacks something or whose options contradict each other.
/// @throws UsageError, one line naming the option.
void requireAgreement(const Arguments& arguments);

}  // namespace virtual_work_dynamics
