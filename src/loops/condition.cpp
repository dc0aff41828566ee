#include "loops/condition.h"

#include "loops/closure_conditions.h"
#include "loops/coupling_conditions.h"

namespace virtual_work_dynamics {

namespace {

using Maker = ConditionSets (*)(const Mechanism& mechanism, const Scene& scene);

// One line for each kind of condition. Closures stay first, so that closure c is set c.
constexpr Maker kMakers[] = {closureConditions, couplingConditions};

}  // namespace

LoopState::LoopState(const Mechanism& mechanism) : links(mechanism) {
  q.setZero(static_cast<Eigen::Index>(mechanism.coordinates().size()));
  qd = q;
}

ConditionValues::ConditionValues(Eigen::Index conditions, Eigen::Index coordinates,
                                 std::size_t sets)
    : frames(sets) {
  phi.setZero(conditions);
  turning = b = bd = roundings = phi;
  A.setZero(conditions, coordinates);
  unit_wrenches.resize(static_cast<std::size_t>(conditions));
}

ConditionSets makeConditions(const Mechanism& mechanism, const Scene& scene) {
  ConditionSets all;
  for (const Maker make : kMakers) {
    const ConditionSets made = make(mechanism, scene);
    all.insert(all.end(), made.begin(), made.end());
  }
  return all;
}

}  // namespace virtual_work_dynamics
