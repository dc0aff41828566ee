#pragma once

#include <string>

#include "stability/exact_results.h"

#ifdef VWD_HAS_REAL113

namespace virtual_work_dynamics {

/// How well ClosedLoopDynamics computed one state of a mechanism with closures, or the worst of
/// many.
struct LoopVerdict {
  Errors errors;
  double sensitivity = 0;  ///< like Verdict::sensitivity
  double condition = 0;    ///< condition that it reports
  int rank = 0;            ///< least rank that it reports
  int redundancy = 0;      ///< unknowns less rank
  int redundant_constraints = 0;
  int free_motions = 0;
  int components = 0;       ///< number of efforts and components of reactions
  int open = 0;             ///< number of components that are flagged as not determined
  int holds = 0;            ///< number of forces that can act one way only and were judged
  int apart = 0;            ///< number of counts and flags that differ from the exact ones
  std::string worst_apart;  ///< name of one that differs
  double residual = 0;      ///< residual of completed motions over its limit
  int completed = 0;        ///< number of completed motions
  bool unborne = false;     ///< whether nothing bears a load, so that there are no exact values
  bool clear = true;        ///< whether the exact rank is far from the tolerance
  int states = 0;

  void include(const LoopVerdict& other);
  bool good() const { return errors.over_bound <= 1 && apart == 0 && residual <= 1; }
};

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
