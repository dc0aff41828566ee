#pragma once

#include "loops/condition.h"
#include "scene/couplings.h"

namespace virtual_work_dynamics {

/// The condition of a coupling, sum of factors times coordinates = offset: a row of A qd = 0 (3.2)
/// whose entries are the factors. Its multiplier acts on the coordinates and is no wrench.
class CouplingCondition : public ConditionSet {
 public:
  explicit CouplingCondition(const ResolvedCoupling& coupling);

  bool isLinear() const override { return true; }
  void setPosition(const LoopState& state, ConditionRows rows) const override;
  void setMotion(const LoopState&, ConditionRows) const override {}

 private:
  const ResolvedCoupling coupling_;
};

/// The conditions of the scene's couplings, in its order.
/// @throws SceneError as resolveCouplings().
ConditionSets couplingConditions(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
