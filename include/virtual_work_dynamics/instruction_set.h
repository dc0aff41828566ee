#pragma once

#include <string>

namespace virtual_work_dynamics {

/// Vector instructions of the recursion's builds. The same source compiled for each; builds with
/// fused multiply-add agree bit for bit.
enum class InstructionSet {
  kBaseline,  ///< what the compiler assumes of every machine: 2 doubles or 4 floats
  kAvx2,      ///< AVX2 and FMA: 4 doubles or 8 floats
  kAvx512     ///< AVX-512 F, DQ: 8 doubles or 16 floats
};

/// Name of the environment variable that overrides the choice: baseline, avx2 or avx512.
constexpr char kInstructionSetVariable[] = "VIRTUAL_WORK_DYNAMICS_INSTRUCTION_SET";

/// "baseline", "avx2", "avx512".
std::string toString(InstructionSet instruction_set);

/// Whether this build has it and this machine runs it.
bool isSupported(InstructionSet instruction_set);

/// The environment variable's where that is set, else the best that is supported.
/// @throws Error when the variable names none, or one that is not supported.
InstructionSet chosenInstructionSet();

}  // namespace virtual_work_dynamics
