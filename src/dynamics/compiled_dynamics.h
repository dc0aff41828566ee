#pragma once

#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// The inside of a Dynamics.
struct Dynamics::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, const Request& request,
       InstructionSet instruction_set);

  // One of the two.
  std::optional<InverseDynamics> chain;
  std::optional<ClosedLoopDynamics> loops;

  Scene tree;
  Request tree_request;
  Load own_load;  // of the scene
  std::vector<std::string> effort_names, closure_names;
  std::vector<bool> actuated;
  Eigen::VectorXd assembly;
};

/// The inside of a Dynamics::Workspace.
struct Dynamics::Workspace::Impl {
  const Dynamics::Impl* plan;  // only compared

  // One of the two.
  std::optional<virtual_work_dynamics::Workspace> chain;
  std::optional<ClosedLoopDynamics::Workspace> loops;
};

}  // namespace virtual_work_dynamics
