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
/// wrenches that go with their multipliers. Everything is in root axes.
class ClosureConditions : public ConditionSet {
 public:
  using Frame = LinkKinematics::Frame;

  /// @param path the joints from the parent's link to the child's
  /// @param coordinates those that move these joints, ascending
  ClosureConditions(const Mechanism& mechanism, const Closure& closure, std::vector<Condition> rows,
                    const Frame& parent, const Frame& child, std::vector<PathStep> path,
                    std::vector<int> coordinates);

  void setPosition(const LoopState& state, ConditionRows rows) const override;
  void setMotion(const LoopState& state, ConditionRows rows) const override;

  ClosureType type() const { return traits_.type; }
  const ClosureTypeTraits& traits() const { return traits_; }
  /// Length of a rod, m; empty where the assembly tells it, and for other types.
  const std::optional<double>& length() const { return given_length_; }
  const Frame& parent() const { return parent_; }
  const Frame& child() const { return child_; }
  /// Joints between the links, fixed ones included; a positive step moves the child's link.
  const std::vector<PathStep>& path() const { return path_; }
  /// As kernels see it.
  const ClosureShape& shape() const { return shape_; }

  /// Unit of the free motion; radian where there is none.
  Unit freeUnit() const { return traits_.free_axis.value_or(Unit::kRadian); }
  /// The frames at a position of the links.
  virtual FramePair framesAt(const LinkKinematics& links) const;
  /// Angle about the free axis, within half a turn, or distance along it; rad or m.
  double freePosition(const FramePair& frames) const;
  /// Rate of freePosition(), rad/s or m/s.
  double freeVelocity(const LinkKinematics& links, const FramePair& frames) const;
  /// Rate of freeVelocity() for qdd = 0, rad/s^2 or m/s^2.
  virtual double freeAcceleration(const LinkKinematics& links, const FramePair& frames) const;
  /// How a step of a joint on the path displaces the line of a wrench between the frames.
  virtual LinkKinematics::Displacement displacedBy(const LinkKinematics& links,
                                                   const FramePair& frames, const PathStep& step,
                                                   double length) const;
  /// What is wrong with a position where conditions or forces have no direction; null: nothing.
  /// @param least distance of points that do not coincide, m
  virtual const char* fault(const LinkKinematics& /*links*/, double /*least*/) const {
    return nullptr;
  }
  /// Whether the closure lets nothing turn and its frames are more than a quarter turn apart, which
  /// the conditions do not detect.
  bool reversed(const FramePair& frames) const;

 protected:
  const LoopFunctions& kernel() const { return *kernel_; }
  // What kernels need besides; it must live as long.
  void setShape(const TouchShape& touch) { shape_.touch = &touch; }
  void setShape(const TeethShape& teeth) { shape_.teeth = &teeth; }

 private:
  const ClosureTypeTraits& traits_;
  const LoopFunctions* kernel_;
  Frame parent_, child_;
  std::vector<PathStep> path_;
  std::optional<double> given_length_;
  std::vector<StepShape> steps_;
  ClosureShape shape_;
};

/// The coordinates that move the links of a path relative to each other, ascending.
std::vector<int> coordinatesOn(const Mechanism& mechanism, const std::vector<PathStep>& path);

/// Makes the conditions of all closures of a scene, one set for each.
/// @throws SceneError naming the closure: unknown link, both frames on one link, or on links that
///   no joint moves relative to each other.
ConditionSets closureConditions(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
