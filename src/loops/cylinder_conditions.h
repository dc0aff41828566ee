#pragma once

#include <vector>

#include "loops/closure_conditions.h"

namespace virtual_work_dynamics {

/// A massless actuator along the line between the origins of the parent's frame P and the child's
/// frame C. It demands nothing; its one free motion is its length. In place of P's axes stand axes
/// whose z is along the line, from P to C.
class CylinderConditions : public ClosureConditions {
 public:
  CylinderConditions(const Mechanism& mechanism, const Closure& closure, const Frame& parent,
                     const Frame& child, std::vector<PathStep> path, std::vector<int> coordinates);

  void setPosition(const LoopState& state, ConditionRows rows) const override;
  void setMotion(const LoopState& state, ConditionRows rows) const override;
  FramePair framesAt(const LinkKinematics& links) const override;
  double freeAcceleration(const LinkKinematics& links, const FramePair& frames) const override;
  const char* fault(const LinkKinematics& links, double least) const override;
  LinkKinematics::Displacement displacedBy(const LinkKinematics& links, const FramePair& frames,
                                           const PathStep& step, double length) const override;
};

}  // namespace virtual_work_dynamics
