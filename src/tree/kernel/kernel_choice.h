#pragma once

#include "tree/kernel/kernel.h"
#include "virtual_work_dynamics/instruction_set.h"

namespace virtual_work_dynamics {

/// R: float or double. @throws Error when the instruction set is not supported.
template <typename R>
const Kernel<R>& kernelFor(InstructionSet instruction_set);

}  // namespace virtual_work_dynamics
