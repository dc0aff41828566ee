#include "robot/effort_limits.h"

#include <limits>

namespace virtual_work_dynamics {

std::vector<double> effortLimits(const Mechanism& mechanism) {
  std::vector<double> limits;
  for (int i = 0; i < static_cast<int>(mechanism.coordinates().size()); ++i) {
    const double limit = mechanism.jointOf(i).effort_limit;
    limits.push_back(limit > 0 ? limit : std::numeric_limits<double>::infinity());
  }
  return limits;
}

}  // namespace virtual_work_dynamics
