#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The terms of a joint, with what the description says where the scene wants it.
struct ResolvedJointTerms {
  int joint = 0;  ///< index into Mechanism::joints()
  double stiffness = 0;
  double rest = 0;
  double damping = 0;
  double coulomb = 0;
  double coulomb_velocity = 1e-3;
  double rotor_inertia = 0;
};

/// Terms of all joints that have any, in the mechanism's order; joints whose terms are all zero are
/// left out.
/// @throws SceneError naming the joint: unknown, fixed, given twice, or with a value out of range.
std::vector<ResolvedJointTerms> resolveJointTerms(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
