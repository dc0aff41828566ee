#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The place of an entry of a scene's list, as messages begin with it: "reactions[2]".
std::string entryOf(const std::string& list, std::size_t index);

/// Index of the joint whose reaction is named at a place of the scene, as
/// Mechanism::reactionIndex() has it. @throws SceneError as below.
int reactionNamed(const Mechanism& mechanism, const std::string& name, const std::string& place);

/// Index of the joint or link that is named at a place of the scene.
/// @throws SceneError naming the place and what could have been meant when there is none.
int jointNamed(const Mechanism& mechanism, const std::string& name, const std::string& place);
int linkNamed(const Mechanism& mechanism, const std::string& name, const std::string& place);

/// Reports a name that is neither that of a joint nor of a closure. @throws SceneError always.
[[noreturn]] void failAtUnknown(const Mechanism& mechanism, const Scene& scene,
                                const std::string& name, const std::string& place);

}  // namespace virtual_work_dynamics
