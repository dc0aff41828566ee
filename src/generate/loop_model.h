#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "loops/compiled_loops.h"
#include "tree/plan.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// The parts of a ClosedLoopDynamics, made as it makes them, for code that is generated of them.
struct LoopModel {
  /// @throws SceneError as ClosedLoopDynamics does, and in one line where no code can be generated.
  LoopModel(const Mechanism& mechanism, const Scene& scene, const Request& request);
  LoopModel(const LoopModel&) = delete;  // solvers refer to it

  const Mechanism& mechanism;
  const Scene& scene;
  ClosedLoopDynamics dynamics;
  LoopScene loops;
  std::vector<ResolvedCoupling> couplings;
  LoopKinematics kinematics;  // at the assembly
  std::vector<LoopGroup> groups;
  double length;
  LoopSolvers solvers;
  LoopReactions child_axes, root_axes;
  Plan<double> tree;  // without closures, with the ends of springs as applied wrenches
  /// Positions by which choices are made: with the loops closed, then open.
  std::vector<Eigen::VectorXd> usual;

  /// By which names efforts go.
  std::vector<std::string> effortNames() const;
  /// The results that mechanics does not determine in a regular position, by name.
  std::vector<std::string> undetermined() const;
};

}  // namespace virtual_work_dynamics
