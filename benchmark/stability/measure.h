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

/// What one path did in some states.
struct PathVerdict {
  std::string path, precision;
  Errors errors;
};

/// What all of them did.
struct Verdict {
  std::vector<PathVerdict> paths;  ///< none where the states are no numbers of float
  double sensitivity = 0;          ///< see README
  std::optional<Errors> kdl;       ///< of KDL's efforts
  /// Of one sample by the chosen instruction set, where numbers are double.
  std::optional<WorstCertificates> certificates;
  std::optional<LoopVerdict> loops;  ///< of mechanisms with closures, which have one path only

  void include(const Verdict& other);
  /// Largest error of all paths of a precision over the narrower bound.
  double overSubtreeBound(const std::string& precision) const;
};

/// Numbers of the input.
enum class InputNumbers { kDouble, kFloat };

/// Computes `count` random states in every way that takes such numbers, and by KDL if they are
/// double. Closed loops are computed on double alone.
Verdict measureStates(const StabilityCase& stability_case, InputNumbers numbers, std::uint32_t seed,
                      int count);

#endif  // VWD_HAS_REAL113

}  // namespace virtual_work_dynamics
