#include "loops/kernel/loop_kernel.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

const LoopKernel* kernelOrNull(InstructionSet instruction_set) {
  switch (instruction_set) {
    case InstructionSet::kBaseline:
      return baselineLoops();
    case InstructionSet::kAvx2:
      return avx2Loops();
    case InstructionSet::kAvx512:
      return avx512Loops();
  }
  return nullptr;
}

}  // namespace

const LoopKernel& loopKernelFor(InstructionSet instruction_set) {
  const LoopKernel* kernel = isSupported(instruction_set) ? kernelOrNull(instruction_set) : nullptr;
  if (!kernel) {
    throw Error("this machine or build has no " + toString(instruction_set) + " instructions");
  }
  return *kernel;
}

}  // namespace virtual_work_dynamics
