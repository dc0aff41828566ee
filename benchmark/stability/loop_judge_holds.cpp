#include "stability/loop_judge.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>
#include <cmath>

#include "loop_geometry.h"

// What of forces that can act one way only does so, by the exact ones.

namespace virtual_work_dynamics {
namespace {

// Of the largest force: closer to its edge, either answer may be the right one.
constexpr long double kOnTheEdge = 1e-6L;
constexpr long double kNearlyFree = 100;

bool isNearlyFree(const ExactComponent& component) {
  return component.freedom > MaximalCoordinatesOracle::kFree / kNearlyFree &&
         component.freedom < MaximalCoordinatesOracle::kFree * kNearlyFree;
}

}  // namespace

// None where it is on the edge.
std::optional<Hold> LoopJudge::holdOf(const Closure& closure, const Exact& exact,
                                      long double edge) const {
  if (isTouch(closure) && !closure.touch.closed) return Hold::kHolds;
  std::size_t normal = 0;
  if (isTouch(closure)) {
    const auto place = std::find(names_.begin(), names_.end(), closure.name) - names_.begin();
    normal = 12 * static_cast<std::size_t>(place) + 8;  // z of the force in child axes
  } else {
    const auto& actuated = dynamics_.actuatedClosures();
    const auto place = std::find(actuated.begin(), actuated.end(), closure.name) - actuated.begin();
    normal = 12 * names_.size() + mechanism_.coordinates().size() + static_cast<std::size_t>(place);
  }
  const ExactComponent& acting = exact.components[normal];
  if (isNearlyFree(acting)) return std::nullopt;
  if (!acting.determined()) return Hold::kNotDecidable;
  const long double press = isTouch(closure) ? acting.value : -acting.value;
  if (std::abs(press) <= edge) return std::nullopt;
  if (press < 0) return Hold::kWrongWay;
  if (!isTouch(closure) || !closure.touch.friction) return Hold::kHolds;
  const ExactComponent &x = exact.components[normal - 2], &y = exact.components[normal - 1];
  if (isNearlyFree(x) || isNearlyFree(y)) return std::nullopt;
  if (!x.determined() || !y.determined()) return Hold::kNotDecidable;
  const long double beyond = std::hypot(x.value, y.value) - *closure.touch.friction * press;
  if (std::abs(beyond) <= edge) return std::nullopt;
  return beyond > 0 ? Hold::kOutsideCone : Hold::kHolds;
}

void LoopJudge::compareHolds(const Exact& exact, long double largest, LoopVerdict& verdict) const {
  if (!verdict.clear || exact.free_motions > 0 || verdict.free_motions > 0) return;
  const std::vector<Hold>& holds = dynamics_.results().loops.holds;
  std::size_t next = 0;
  for (const Closure& closure : scene_.closures) {
    const bool presses = isTouch(closure) && closure.touch.normal;
    if (!presses && !closure.pulls_only) continue;
    const Hold found = holds.at(next++);
    const std::optional<Hold> right = holdOf(closure, exact, kOnTheEdge * largest);
    if (!right) continue;
    ++verdict.holds;
    if (found == *right) continue;
    if (verdict.apart++ == 0) verdict.worst_apart = "how '" + closure.name + "' holds";
  }
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
