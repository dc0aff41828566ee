#include "virtual_work_dynamics/instruction_set.h"

#include <cstdlib>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

constexpr InstructionSet kAll[] = {InstructionSet::kAvx512, InstructionSet::kAvx2,
                                   InstructionSet::kBaseline};

// VWD_VECTOR_KERNELS is defined when this build has kernels for AVX2 and AVX-512.
bool machineHas(InstructionSet instruction_set) {
#if defined(VWD_VECTOR_KERNELS)
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

bool isSupported(InstructionSet instruction_set) {
  return machineHas(instruction_set);
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
  throw Error(std::string(kInstructionSetVariable) + ": " + inQuotes(wanted) +
              " is not one of baseline, avx2, avx512");
}

}  // namespace virtual_work_dynamics
