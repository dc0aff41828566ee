#pragma once

#include <string>

#include "stability/exact_results.h"

#ifdef VWD_HAS_REAL113

namespace virtual_work_dynamics {

/// What ClosedLoopDynamics made of one state of a mechanism with closures, or the worst of many.
struct LoopVerdict {
  Errors errors;
  double sensitivity = 0;  ///< as Verdict's
  double condition = 0;    ///< that it reports
  int rank = 0;            ///< likewise; the least
  int redundancy = 0;      ///< unknowns less rank
  int redundant_constraints = 0;
  int free_motions = 0;
  int components = 0;       ///< of efforts and reactions
  int open = 0;             ///< of these, flagged as not determined
  int apart = 0;            ///< counts and flags that are not the exact ones
  std::string worst_apart;  ///< one of them
  double residual = 0;      ///< of completed motions, over its limit
  int completed = 0;        ///< motions
  int states = 0;

  void include(const LoopVerdict& other);
  bool good() const { return errors.over_bound <= 1 && apart == 0 && residual <= 1; }
};

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
