#pragma once

#include "virtual_work_dynamics/deviations.h"

namespace virtual_work_dynamics {

/// By how much a number of a sample is shifted, see Deviations.
/// @param deviation the number's own; where it is not finite, results are of no use
double shiftOf(MotionLevel level, double value, double deviation);

}  // namespace virtual_work_dynamics
