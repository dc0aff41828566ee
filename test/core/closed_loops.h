#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// A ClosedLoopDynamics with a workspace of its own, for tests of one sample after the other.
/// Results are those of the sample computed last.
class ClosedLoops {
 public:
  ClosedLoops(const Mechanism& mechanism, const Scene& scene, const Request& request = {})
      : dynamics_(mechanism, scene, request), workspace_(dynamics_.makeWorkspace()) {}

  Eigen::Index coordinates() const { return dynamics_.coordinates(); }
  const Request& request() const { return dynamics_.request(); }
  const Eigen::VectorXd& assembly() const { return dynamics_.assembly(); }
  const std::vector<bool>& actuated() const { return dynamics_.actuated(); }
  const std::vector<bool>& residual() const { return dynamics_.residual(); }
  const std::vector<std::string>& actuatedClosures() const { return dynamics_.actuatedClosures(); }
  const Scene& tree() const { return dynamics_.tree(); }

  bool complete(Motion& motion) { return dynamics_.complete(motion, workspace_); }
  bool complete(Motion& motion, const std::vector<bool>& given) {
    return dynamics_.complete(motion, given, workspace_);
  }
  void compute(const Motion& motion) { dynamics_.compute(motion, workspace_); }
  void compute(const Motion& motion, const Load& load) {
    dynamics_.compute(motion, load, workspace_);
  }

  const Results& results() const { return workspace_.results(); }
  const Eigen::VectorXd& effort() const { return results().effort; }
  const std::vector<Wrench>& childAxes() const { return results().child_axes; }
  const std::vector<Wrench>& rootAxes() const { return results().root_axes; }
  const std::vector<Pose>& poses() const { return results().poses; }
  const std::vector<Twist>& twists() const { return results().twists; }
  bool finite() const { return results().finite(); }

  const Determinacy& determinacy() const { return loops().determinacy; }
  const std::vector<bool>& effortDetermined() const { return loops().effort_determined; }
  const std::vector<Determined>& childAxesDetermined() const {
    return loops().child_axes_determined;
  }
  const std::vector<Determined>& rootAxesDetermined() const { return loops().root_axes_determined; }
  const std::vector<bool>& effortExists() const { return loops().effort_exists; }
  const std::vector<Determined>& childAxesExist() const { return loops().child_axes_exist; }
  const std::vector<Determined>& rootAxesExist() const { return loops().root_axes_exist; }
  const std::vector<double>& closureConditions() const { return loops().closure_conditions; }
  const std::vector<ClosureResidual>& residuals() const { return loops().residuals; }
  const std::vector<ClosureResidual>& relativeResiduals() const {
    return loops().relative_residuals;
  }
  /// Positions and velocities of actuated closures.
  const Eigen::VectorXd& actuatedPositions() const { return loops().actuated_positions; }
  const Eigen::VectorXd& actuatedVelocities() const { return loops().actuated_velocities; }

  /// The load that acts on tree() in the sample.
  Load treeLoad() const {
    Load load;
    load.wrenches = loops().tree_wrenches;
    return load;
  }

 private:
  const LoopResults& loops() const { return results().loops; }

  ClosedLoopDynamics dynamics_;
  ClosedLoopDynamics::Workspace workspace_;
};

}  // namespace virtual_work_dynamics
