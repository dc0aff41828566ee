#include "dynamics/shift_sizes.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

namespace {

// Least shift of positions, rad or m, and of rates, relative to what they are or to 1: half of a
// double's digits are left for the difference. Largest shift of positions, rad or m.
constexpr double kLeastShift = 1e-6;
constexpr double kLargestShift = 1e-3;

}  // namespace

double ShiftSizes::of(MotionLevel level, double value, double deviation) const {
  const double size = std::max(1.0, std::abs(value));
  if (level == MotionLevel::kAcceleration && linear) return size;
  if (!std::isfinite(deviation)) return kLeastShift;
  if (level == MotionLevel::kPosition) return std::clamp(deviation, kLeastShift, kLargestShift);
  return std::copysign(std::max(deviation, kLeastShift * size), -value);
}

double ShiftSizes::ofWrench(double deviation) const {
  return linear || !(deviation > 0) || !std::isfinite(deviation) ? 1 : deviation;
}

}  // namespace virtual_work_dynamics
