#pragma once

#include <vector>

#include "loops/closure_conditions.h"

namespace virtual_work_dynamics {

/// The condition of two wheels whose teeth mesh, or of a wheel and a rack: at the pitch point both
/// move alike along the tangent. Joints hold the wheels at their distance, so that the row is the
/// same in every position, and its integral (3.3) is a relation of coordinates whose constant is
/// that of the assembly. The force at the pitch point is the multiplier along the tangent, with the
/// shares along the axis and away from the other wheel that the teeth's angles demand; it loads the
/// bearings and does no work. Teeth press the wheels apart with the magnitude of their force,
/// whichever of their flanks bears: the unit wrench is that of the flank that bears above zero.
class GearConditions : public ClosureConditions {
 public:
  /// @throws SceneError when the wheels do not stay at the distance of their radii with parallel
  ///   axes, or joints between them let a wheel do anything but turn.
  GearConditions(const Mechanism& mechanism, const Closure& closure, const Frame& parent,
                 const Frame& child, const std::vector<PathStep>& path,
                 const std::vector<int>& coordinates);

  bool isLinear() const override { return true; }
  void setPosition(const LoopState& state, ConditionRows rows) const override;
  void setMotion(const LoopState&, ConditionRows) const override {}

 private:
  // See MeshNumber.
  struct Mesh {
    Eigen::Vector3d lever, along, axis, away;
  };
  void check(const Mechanism& mechanism, const LinkKinematics& links);

  std::vector<double> factors_;  // of the row, by coordinate
  TeethShape teeth_;
};

}  // namespace virtual_work_dynamics
