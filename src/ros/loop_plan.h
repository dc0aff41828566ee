#pragma once

#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// A mechanism with closed loops compiled for an audience, and which of its results exist. In a
/// singular position a result has no value when it depends on what the position leaves open; what
/// redundant constraints leave open has one, by the scene's policy.
class LoopPlan {
 public:
  /// @param reactions all that the scene asks for.
  /// @param wrenches which of them `request` has in child axes, ascending; others may follow that
  /// nobody listens to.
  /// @throws SceneError as ClosedLoopDynamics does.
  LoopPlan(const Mechanism& mechanism, const Scene& scene, const Request& request,
           const std::vector<std::size_t>& wrenches);

  /// Does not allocate.
  void compute(const Motion& motion);

  const ClosedLoopDynamics& results() const { return dynamics_; }
  bool singular() const { return dynamics_.determinacy().free_motions > 0; }

  // Whether each of the results exists, in their order.
  const std::vector<bool>& effortExists() const { return effort_exists_; }
  const std::vector<bool>& rootAxesExist() const { return root_axes_exist_; }
  const std::vector<bool>& childAxesExist() const { return child_axes_exist_; }

  /// How many entries in child axes, the first ones, somebody listens to.
  std::size_t wrenches() const { return wrenches_.size(); }
  /// Which of all reactions such an entry is; those in root axes are all or none.
  std::size_t reactionOf(std::size_t child_axes_entry) const { return wrenches_[child_axes_entry]; }

 private:
  void setExistence();

  ClosedLoopDynamics dynamics_;
  const std::vector<std::size_t> wrenches_;
  // What is determined in positions that are not singular, the last one met.
  std::vector<bool> usual_effort_;
  std::vector<Determined> usual_root_axes_, usual_child_axes_;
  std::vector<bool> effort_exists_, root_axes_exist_, child_axes_exist_;
};

}  // namespace virtual_work_dynamics
