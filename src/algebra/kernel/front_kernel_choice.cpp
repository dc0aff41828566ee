#include "algebra/kernel/front_kernel.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

const FrontKernel* kernelOrNull(InstructionSet instruction_set) {
  switch (instruction_set) {
    case InstructionSet::kBaseline:
      return baselineFronts();
    case InstructionSet::kAvx2:
      return avx2Fronts();
    case InstructionSet::kAvx512:
      return avx512Fronts();
  }
  return nullptr;
}

}  // namespace

const FrontKernel& frontKernelFor(InstructionSet instruction_set) {
  const FrontKernel* kernel =
      isSupported(instruction_set) ? kernelOrNull(instruction_set) : nullptr;
  if (!kernel) {
    throw Error("this machine or build has no " + toString(instruction_set) + " instructions");
  }
  return *kernel;
}

}  // namespace virtual_work_dynamics
