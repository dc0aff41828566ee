#include "virtual_work_dynamics/instruction_set.h"

#include <cstdlib>

#include "core/kernel/kernel_choice.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

constexpr InstructionSet kAll[] = {InstructionSet::kAvx512, InstructionSet::kAvx2,
                                   InstructionSet::kBaseline};

bool machineHas(InstructionSet instruction_set) {
#if defined(__x86_64__) || defined(__i386__)
  switch (instruction_set) {
    case InstructionSet::kAvx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             machineHas(InstructionSet::kAvx2);
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case InstructionSet::kBaseline:
      return true;
  }
#endif
  return instruction_set == InstructionSet::kBaseline;
}

}  // namespace

std::string toString(InstructionSet instruction_set) {
  switch (instruction_set) {
    case InstructionSet::kBaseline:
      return "baseline";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kAvx512:
      return "avx512";
  }
  return "";
}

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

bool isSupported(InstructionSet instruction_set) {
  return kernelOrNull<double>(instruction_set) && machineHas(instruction_set);
}

InstructionSet chosenInstructionSet() {
  const char* const wanted = std::getenv(kInstructionSetVariable);
  for (const InstructionSet instruction_set : kAll) {
    if (wanted && *wanted && toString(instruction_set) != wanted) continue;
    if (isSupported(instruction_set)) return instruction_set;
    if (wanted && *wanted) {
      throw Error(std::string(kInstructionSetVariable) + ": this machine or build has no " +
                  wanted);
    }
  }
  throw Error(std::string(kInstructionSetVariable) + ": '" + wanted +
              "' is none of baseline, avx2, avx512");
}

template <typename R>
const Kernel<R>& kernelFor(InstructionSet instruction_set) {
  if (!isSupported(instruction_set)) {
    throw Error("this machine or build has no " + toString(instruction_set) + " instructions");
  }
  return *kernelOrNull<R>(instruction_set);
}

template const Kernel<double>& kernelFor<double>(InstructionSet);
template const Kernel<float>& kernelFor<float>(InstructionSet);

}  // namespace virtual_work_dynamics
