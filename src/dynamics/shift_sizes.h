#pragma once

#include "virtual_work_dynamics/deviations.h"

namespace virtual_work_dynamics {

/// By how much the numbers of a sample are shifted, see Deviations.
struct ShiftSizes {
  /// @param deviation the number's own; where it is not finite, results are of no use
  double of(MotionLevel level, double value, double deviation) const;
  /// The same for the forces and moments of wrenches.
  double ofWrench(double deviation) const;

  /// Whether results are linear in accelerations and wrenches, so that any shift serves.
  bool linear;
};

}  // namespace virtual_work_dynamics
