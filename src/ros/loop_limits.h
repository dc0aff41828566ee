#pragma once

#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// What samples of closed loops are to keep within; beyond is a WARN.
struct LoopLimits {
  double tolerance = 1e-6;              ///< of the loops, relative
  double condition = kCloseToSingular;  ///< of ClosedLoopDynamics::closureConditions()
};

}  // namespace virtual_work_dynamics
