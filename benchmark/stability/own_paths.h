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

/// The name of the path of singlePath().
std::string singlePathName(InstructionSet instruction_set);

/// A request for everything: efforts, and the reactions of ground and all joints in both axes.
Request everything(const Mechanism& mechanism);

/// All paths that compute in double or in a longer type.
std::vector<Path> doublePaths(const Mechanism& mechanism, const Scene& scene);
/// All paths that compute in float.
std::vector<Path> floatPaths(const Mechanism& mechanism, const Scene& scene);
/// The path that computes one sample in double by a kernel of the given instructions.
Path singlePath(const Mechanism& mechanism, const Scene& scene, InstructionSet instruction_set);

/// The mechanism with multipliers and offsets of mimic joints rounded to float: at large angles
/// their rounding would be an error of the input, not of the computation.
Mechanism withFloatGears(const Mechanism& mechanism);
Motion roundedToFloat(const Motion& motion);

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
