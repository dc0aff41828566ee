#pragma once

#include <string>

namespace virtual_work_dynamics {

/// Vector instructions that the recursion is built for. One source is compiled for each of them;
/// builds with fused multiply-add agree bit for bit.
enum class InstructionSet {
  kBaseline,  ///< what the compiler assumes of every machine: 2 doubles or 4 floats
  kAvx2,      ///< AVX2 and FMA: 4 doubles or 8 floats
  kAvx512     ///< AVX-512 F, DQ: 8 doubles or 16 floats
};

/// Name of the environment variable that overrides the choice of instructions by one of the names
/// of toString().
constexpr char kInstructionSetVariable[] = "VIRTUAL_WORK_DYNAMICS_INSTRUCTION_SET";

/// The name of an instruction set: "baseline", "avx2" or "avx512".
std::string toString(InstructionSet instruction_set);

/// Whether this build has a kernel of these instructions and this machine runs them.
bool isSupported(InstructionSet instruction_set);

/// The instruction set that kInstructionSetVariable names; the best supported one when it is not
/// set.
/// @throws Error when the variable holds another word, or names one that is not supported.
InstructionSet chosenInstructionSet();

}  // namespace virtual_work_dynamics
