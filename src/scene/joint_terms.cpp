#include "scene/joint_terms.h"

#include <cmath>

#include "base/number_text.h"
#include "base/printable.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

void requireAtLeastZero(const std::string& where, const char* key, double value) {
  if (value >= 0 && std::isfinite(value)) return;
  throw SceneError(where + ": " + key + " = " + numberText(value) +
                   " is neither zero nor a positive number");
}

void check(const JointTerms& terms) {
  const std::string where = "joints: " + inQuotes(terms.joint);
  requireAtLeastZero(where, "stiffness", terms.stiffness);
  requireAtLeastZero(where, "damping", terms.damping.value_or(0));
  requireAtLeastZero(where, "coulomb", terms.coulomb.value_or(0));
  requireAtLeastZero(where, "rotor_inertia", terms.rotor_inertia);
  if (!std::isfinite(terms.rest)) throw SceneError(where + ": rest is not finite");
  if (!std::isfinite(terms.offset)) throw SceneError(where + ": offset is not finite");
  if (!(terms.coulomb_velocity >= 1e-12) || !std::isfinite(terms.coulomb_velocity)) {
    throw SceneError(where + ": coulomb_velocity = " + numberText(terms.coulomb_velocity) +
                     " is not a finite number from 1e-12 on");
  }
}

// The index in Scene::joints of the terms of each joint; -1 where a joint has none.
std::vector<int> termsOfJoints(const Mechanism& mechanism, const Scene& scene) {
  std::vector<int> given(mechanism.joints().size(), -1);
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const JointTerms& terms = scene.joints[i];
    const int joint = jointNamed(mechanism, terms.joint, entryOf("joints", i) + ".name");
    if (mechanism.joint(joint).coordinate < 0) {
      throw SceneError("joints: " + inQuotes(terms.joint) + " is a fixed joint");
    }
    if (given[joint] >= 0) throw SceneError("joints: " + inQuotes(terms.joint) + " is given twice");
    check(terms);
    given[joint] = static_cast<int>(i);
  }
  return given;
}

}  // namespace

std::vector<ResolvedJointTerms> resolveJointTerms(const Mechanism& mechanism, const Scene& scene) {
  const std::vector<int> given = termsOfJoints(mechanism, scene);
  std::vector<ResolvedJointTerms> resolved;
  for (std::size_t k = 0; k < given.size(); ++k) {
    const Joint& joint = mechanism.joints()[k];
    if (joint.coordinate < 0) continue;
    JointTerms terms;
    terms.joint = joint.name;
    if (given[k] >= 0) terms = scene.joints[given[k]];
    if (scene.use_urdf_dynamics) {
      const std::string where =
          "use_urdf_dynamics: joint " + inQuotes(joint.name) + " of the description";
      if (!terms.damping) requireAtLeastZero(where, "damping", joint.damping);
      if (!terms.coulomb) requireAtLeastZero(where, "friction", joint.friction);
      terms.damping = terms.damping.value_or(joint.damping);
      terms.coulomb = terms.coulomb.value_or(joint.friction);
    }
    const double damping = terms.damping.value_or(0), coulomb = terms.coulomb.value_or(0);
    if (terms.stiffness == 0 && damping == 0 && coulomb == 0 && terms.rotor_inertia == 0 &&
        terms.offset == 0) {
      continue;
    }
    resolved.push_back({static_cast<int>(k), terms.stiffness, terms.rest, damping, coulomb,
                        terms.coulomb_velocity, terms.rotor_inertia, terms.offset});
  }
  return resolved;
}

}  // namespace virtual_work_dynamics
