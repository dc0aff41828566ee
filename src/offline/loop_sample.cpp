#include "offline/loop_sample.h"

namespace virtual_work_dynamics {

void LoopSample::compute(ClosedLoopDynamics& dynamics) {
  dynamics.compute(motion_);
  effort_ = dynamics.effort();
  child_axes_ = dynamics.childAxes();
  root_axes_ = dynamics.rootAxes();
  determinacy_ = dynamics.determinacy();
  effort_determined_ = dynamics.effortDetermined();
  child_axes_determined_ = dynamics.childAxesDetermined();
  root_axes_determined_ = dynamics.rootAxesDetermined();
  residuals_ = dynamics.residuals();
  relative_residuals_ = dynamics.relativeResiduals();
  tree_wrenches_ = dynamics.treeWrenches();
  own_wrenches_ = dynamics.tree().applied_wrenches.size() - tree_wrenches_.size();
}

}  // namespace virtual_work_dynamics
