#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stability/exact_results.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

#ifdef VWD_HAS_REAL113

namespace virtual_work_dynamics {

/// One of the ways in which the package computes.
struct Path {
  std::string name;       ///< "single_<instruction set>", "block_<layout>_<instruction set>"
  std::string precision;  ///< "double", "float", "long_double"
  PrecisionLimits limits;
  std::function<std::vector<StateResults>(const std::vector<Motion>&)> compute;
};

template <typename Real>
PrecisionLimits limitsOf();

/// Name of the path of one sample of double.
std::string singlePathName(InstructionSet instruction_set);

/// Everything that a state has: efforts, and the reactions of ground and all joints in both axes.
Request everything(const Mechanism& mechanism);

/// All ways on numbers of double and longer.
std::vector<Path> doublePaths(const Mechanism& mechanism, const Scene& scene);
/// All ways on float.
std::vector<Path> floatPaths(const Mechanism& mechanism, const Scene& scene);
/// One sample of double, by the instructions that the machine is best at.
Path singlePath(const Mechanism& mechanism, const Scene& scene, InstructionSet instruction_set);

/// The same mechanism with multipliers and offsets of mimic joints that are numbers of float: at
/// large angles their rounding is an error of the input, not of the computation.
Mechanism withFloatGears(const Mechanism& mechanism);
Motion roundedToFloat(const Motion& motion);

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
