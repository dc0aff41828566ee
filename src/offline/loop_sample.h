#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// Motion and results of one sample of a mechanism with closed loops, as ClosedLoopDynamics has
/// them, which computes others meanwhile.
class LoopSample {
 public:
  explicit LoopSample(Eigen::Index coordinates) : motion_(coordinates) {}

  Motion& motion() { return motion_; }
  const Motion& motion() const { return motion_; }

  /// All results of motion(), by any instance of the same mechanism, scene and request.
  void compute(ClosedLoopDynamics& dynamics);

  const Eigen::VectorXd& effort() const { return effort_; }
  const std::vector<Wrench>& childAxes() const { return child_axes_; }
  const std::vector<Wrench>& rootAxes() const { return root_axes_; }

  const Determinacy& determinacy() const { return determinacy_; }
  /// Whether actuated joints and closures do not hold the mechanism there.
  bool singular() const { return determinacy_.free_motions > 0; }
  const std::vector<bool>& effortDetermined() const { return effort_determined_; }
  const std::vector<Determined>& childAxesDetermined() const { return child_axes_determined_; }
  const std::vector<Determined>& rootAxesDetermined() const { return root_axes_determined_; }

  const std::vector<ClosureResidual>& residuals() const { return residuals_; }
  const std::vector<ClosureResidual>& relativeResiduals() const { return relative_residuals_; }

  /// As ClosedLoopDynamics::applyTo().
  template <typename OfTree>
  void applyTo(OfTree& of_tree) const {
    for (std::size_t i = 0; i < tree_wrenches_.size(); ++i) {
      of_tree.setAppliedWrench(own_wrenches_ + i, tree_wrenches_[i].force,
                               tree_wrenches_[i].torque);
    }
  }

 private:
  Motion motion_;
  Eigen::VectorXd effort_;
  std::vector<Wrench> child_axes_, root_axes_;
  Determinacy determinacy_;
  std::vector<bool> effort_determined_;
  std::vector<Determined> child_axes_determined_, root_axes_determined_;
  std::vector<ClosureResidual> residuals_, relative_residuals_;
  std::vector<Wrench> tree_wrenches_;
  std::size_t own_wrenches_ = 0;  // of the scene, before those
};

}  // namespace virtual_work_dynamics
