#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stability/exact_results.h"
#include "stability/loop_verdict.h"
#include "stability/sweeps.h"
#include "stability/worst_certificates.h"

namespace virtual_work_dynamics {

#ifdef VWD_HAS_REAL113

/// The errors of one path in some states.
struct PathVerdict {
  std::string path, precision;
  Errors errors;
};

/// The errors of all paths in some states.
struct Verdict {
  std::vector<PathVerdict> paths;  ///< empty where float cannot hold the numbers of the states
  double sensitivity = 0;          ///< largest relative change of results by one ulp of the motion
  std::optional<Errors> kdl;       ///< errors of KDL's efforts
  /// Certificates of single samples by the chosen instruction set, where numbers are double.
  std::optional<WorstCertificates> certificates;
  std::optional<LoopVerdict> loops;  ///< for mechanisms with closures, which have one path only

  void include(const Verdict& other);
  /// The largest Errors::over_subtree_bound of all paths of a precision.
  double overSubtreeBound(const std::string& precision) const;
};

/// The number type of the input.
enum class InputNumbers { kDouble, kFloat };

/// Computes `count` random states in every way that takes such numbers, and by KDL if they are
/// double. Closed loops are computed on double alone.
Verdict measureStates(const StabilityCase& stability_case, InputNumbers numbers, std::uint32_t seed,
                      int count);

#endif  // VWD_HAS_REAL113

}  // namespace virtual_work_dynamics
