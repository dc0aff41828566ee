#pragma once

#include <vector>

#include "loops/closure_conditions.h"

namespace virtual_work_dynamics {

/// The condition of two wheels whose teeth mesh, or of a wheel and a rack: at the pitch point both
/// move alike along the tangent. Joints hold the wheels at their distance, so that the row is the
/// same in every position, and its integral (3.3) is a relation of coordinates whose constant is
/// that of the assembly. The force at the pitch point is the multiplier along the tangent, with the
/// shares along the axis and away from the other wheel that the teeth's angles demand; it loads the
/// bearings and does no work.
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

  /// The wrench of a multiplier, about the child frame's origin: teeth press the wheels apart with
  /// the magnitude of their force, whichever of their flanks bears.
  /// @param reversed whether it is that which a multiplier below zero presses on
  ClosureWrench wrenchOf(double multiplier, bool reversed, const FramePair& frames) const;

 private:
  // The pitch point and the directions there, root axes: tangent, axis, and away from the parent.
  struct Mesh {
    Eigen::Vector3d point, along, axis, away;
  };
  Mesh meshOf(const FramePair& frames) const;
  static FramePair framesOf(const LinkKinematics& links, const Frame& parent, const Frame& child);
  void check(const Mechanism& mechanism, const LinkKinematics& links);

  struct Term {
    int coordinate;
    double factor;
  };
  const bool is_rack_;
  const double parent_radius_, child_radius_;  // m; negative: teeth inside
  const double radial_, axial_;                // shares of the tangential force
  std::vector<Term> terms_;                    // of the row
};

}  // namespace virtual_work_dynamics
