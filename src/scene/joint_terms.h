#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The terms of a joint, with damping and friction of the description where the scene asks for
/// them. Units are those of JointTerms.
struct ResolvedJointTerms {
  int joint = 0;  ///< index into Mechanism::joints()
  double stiffness = 0;
  double rest = 0;
  double damping = 0;
  double coulomb = 0;
  double coulomb_velocity = 1e-3;
  double rotor_inertia = 0;
  double offset = 0;
};

/// The terms of all joints that have any, in the mechanism's order; joints whose terms are all zero
/// are left out.
/// @throws SceneError naming a joint that is unknown, fixed or given twice, or has a value out of
///   range.
std::vector<ResolvedJointTerms> resolveJointTerms(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
