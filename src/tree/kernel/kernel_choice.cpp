#include "tree/kernel/kernel_choice.h"

#include <string>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

template <typename R>
const Kernel<R>* kernelOrNull(InstructionSet instruction_set) {
  switch (instruction_set) {
    case InstructionSet::kBaseline:
      return baselineKernel<R>();
    case InstructionSet::kAvx2:
      return avx2Kernel<R>();
    case InstructionSet::kAvx512:
      return avx512Kernel<R>();
  }
  return nullptr;
}

}  // namespace

template <typename R>
const Kernel<R>& kernelFor(InstructionSet instruction_set) {
  const Kernel<R>* kernel =
      isSupported(instruction_set) ? kernelOrNull<R>(instruction_set) : nullptr;
  if (!kernel) {
    throw Error("this machine or build has no " + toString(instruction_set) + " instructions");
  }
  return *kernel;
}

template const Kernel<double>& kernelFor<double>(InstructionSet);
template const Kernel<float>& kernelFor<float>(InstructionSet);

}  // namespace virtual_work_dynamics
