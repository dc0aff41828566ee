#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Names of the types of compound joints, in the order of CompoundType.
const std::vector<std::string>& compoundTypeNames();

/// Checks an entry of Scene::joint_types on its own. @throws SceneError that begins with `where`,
/// for what its type lacks or does not have, and for axes without direction or parallel ones.
void requireSoundType(const JointTypeEntry& entry, const std::string& where);

/// Checks that a mechanism has the joint types of the scene. @throws SceneError naming an entry
/// that withJointTypes() has not put in place.
void requireJointTypes(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
