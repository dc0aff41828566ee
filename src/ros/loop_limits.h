#pragma once

#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Limits for samples of closed loops; beyond them there is a WARN.
struct LoopLimits {
  double tolerance = 1e-6;              ///< of relative residuals
  double condition = kCloseToSingular;  ///< of LoopResults::closure_conditions
};

}  // namespace virtual_work_dynamics
