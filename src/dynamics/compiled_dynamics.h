#pragma once

#include <optional>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// What a Dynamics was compiled to.
struct Dynamics::Impl {
  Impl(const Mechanism& mechanism, const Scene& scene, const Request& request,
       InstructionSet instruction_set);

  // Exactly one of the two is set.
  std::optional<InverseDynamics> chain;
  std::optional<ClosedLoopDynamics> loops;

  Scene tree;
  Request tree_request;
  Load own_load;  // values in the scene
  std::vector<std::string> effort_names, closure_names;
  std::size_t first_coupling = 0;  // in closure_names
  bool have_positions = true;      // all conditions, which wheels and blades have not
  std::vector<bool> residuals;     // by effort
  std::vector<bool> actuated;
  std::vector<bool> coupled;  // by coordinate: whole turns make a difference
  std::vector<bool> bends;    // by coordinate: not tied by couplings alone
  Given given;
  Eigen::VectorXd assembly;
};

/// The memory behind a Dynamics::Workspace.
struct Dynamics::Workspace::Impl {
  const Dynamics::Impl* plan;  // compared with the plan of a call

  // Exactly one of the two is set.
  std::optional<virtual_work_dynamics::Workspace> chain;
  std::optional<ClosedLoopDynamics::Workspace> loops;
};

}  // namespace virtual_work_dynamics
