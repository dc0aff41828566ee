#pragma once

#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// What samples of closed loops are to keep within; beyond is a WARN.
struct LoopLimits {
  double tolerance = 1e-6;              ///< of the loops, relative
  double condition = kCloseToSingular;  ///< of LoopResults::closure_conditions
};

}  // namespace virtual_work_dynamics
