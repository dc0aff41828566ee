#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "loops/condition.h"
#include "loops/link_kinematics.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The conditions (3.3) of a closure between its parent frame P and its child frame C, and the
/// wrenches that go with their multipliers. Everything in root axes.
class ClosureConditions : public ConditionSet {
 public:
  using Frame = LinkKinematics::Frame;

  /// @param path between the links of the frames   @param coordinates that move its joints
  ClosureConditions(const Closure& closure, const Frame& parent, const Frame& child,
                    std::vector<PathStep> path, std::vector<int> coordinates);

  void setPosition(const LoopState& state, ConditionRows rows) const override;
  void setMotion(const LoopState& state, ConditionRows rows) const override;

  const Frame& parent() const { return parent_; }
  const Frame& child() const { return child_; }
  /// Joints between the links, fixed ones included; a positive step moves the child's.
  const std::vector<PathStep>& path() const { return path_; }

  /// Direction of the axis z of P, which is that of the one free motion where there is one.
  Eigen::Vector3d freeAxis(const LinkKinematics& links) const { return links.axisOf(parent_, 2); }
  /// What that motion measures.
  Unit freeUnit() const { return traits_.free_axis.value_or(Unit::kRadian); }
  /// How far the child has turned about it, within half a turn, or slid along it, and how fast.
  double freePosition(const LinkKinematics& links) const;
  double freeVelocity(const LinkKinematics& links) const;
  /// Whether nothing may turn and the frames are more than a quarter turn apart, which the
  /// conditions do not see.
  bool reversed(const LinkKinematics& links) const;

 private:
  const ClosureTypeTraits& traits_;
  Frame parent_, child_;
  std::vector<PathStep> path_;
  double length_;
};

/// Makes the conditions of all closures of a scene, a set for each.
/// @throws SceneError naming the closure: unknown link, both frames on one link, or on links that
/// no
///   joint moves relative to each other.
ConditionSets closureConditions(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
