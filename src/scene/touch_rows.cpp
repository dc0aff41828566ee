#include "scene/touch_rows.h"

#include <algorithm>
#include <cmath>

#include "scene/closure_types.h"

namespace virtual_work_dynamics {

std::vector<TouchRow> touchRows(const Closure& closure) {
  const Touch& touch = closure.touch;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  std::vector<TouchRow> rows;
  if (!touch.closed) return rows;
  if (closure.type == ClosureType::kContact) {
    if (touch.slip == Slip::kNone) rows = {{"x", x, true, true}, {"y", y, true, true}};
  } else if (touch.roller_angle) {
    const double angle = *touch.roller_angle;
    rows.push_back({"roller", std::cos(angle) * y - std::sin(angle) * x, false, false});
  } else {
    const bool wheel = closure.type == ClosureType::kRolling;
    const bool rolls = touch.slip == Slip::kNone || touch.slip == Slip::kLateral;
    const bool holds = touch.slip == Slip::kNone || touch.slip == Slip::kRolling;
    if (wheel && rolls) rows.push_back({"rolling", x, false, false});
    if (holds) rows.push_back({"lateral", y, false, false});
  }
  if (touch.normal) rows.push_back({"normal", Eigen::Vector3d::UnitZ(), true, false});
  return rows;
}

bool hasPositions(const Closure& closure) {
  if (!traitsOf(closure.type).touches()) return true;
  const std::vector<TouchRow> rows = touchRows(closure);
  return std::all_of(rows.begin(), rows.end(),
                     [](const TouchRow& row) { return row.has_position; });
}

bool hasPositions(const Scene& scene) {
  return std::all_of(scene.closures.begin(), scene.closures.end(),
                     [](const Closure& closure) { return hasPositions(closure); }) &&
         std::none_of(scene.couplings.begin(), scene.couplings.end(),
                      [](const Coupling& coupling) { return coupling.rate_only; });
}

int conditionCount(const Closure& closure) {
  const ClosureTypeTraits& traits = traitsOf(closure.type);
  return traits.touches() ? static_cast<int>(touchRows(closure).size()) : traits.conditions;
}

}  // namespace virtual_work_dynamics
