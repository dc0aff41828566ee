#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Reads the keys of a scene that concern closed loops: closures, springs, couplings,
/// actuated, assembly, redundancy. Returns false for any other key.
/// @throws SceneError naming the key.
bool readLoopEntry(const std::string& key, const YAML::Node& value, Scene& scene);

}  // namespace virtual_work_dynamics
