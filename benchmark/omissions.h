#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contenders/robots.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// A compiled plan with the names of its inputs and outputs.
struct NamedPlan {
  NamedPlan(const Mechanism& mechanism, const Scene& scene, const Request& request)
      : coordinates(mechanism.coordinateNames()), dynamics(mechanism, scene, request) {}

  std::vector<std::string> coordinates;
  InverseDynamics dynamics;
};

/// A plan that leaves something out, and one that computes the same numbers with it.
struct Omission {
  std::string left_out;
  std::shared_ptr<const NamedPlan> plan;
  std::shared_ptr<const NamedPlan> with;  ///< null: nothing is left out
  /// True: `with` is given velocities and accelerations of zero; `plan`, which ignores them, is
  /// not.
  bool with_at_rest = false;
};

/// One robot and its plans, the one that leaves nothing out first.
struct OmissionScene {
  std::string name;
  std::vector<Omission> omissions;
};

/// The plans that leave out parts of a robot's full plan: fixed joints, outputs, velocities and
/// accelerations, gravity.
OmissionScene omissionsOf(const BenchmarkScene& scene);

/// The plans of the robot with a pan and a tilt joint at its last link that carry nothing.
OmissionScene masslessLeavesOf(const BenchmarkScene& scene);

}  // namespace virtual_work_dynamics
