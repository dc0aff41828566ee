#pragma once

#include <string>

#include "scene/yaml_values.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The keys of a scene that readTouchEntry() knows.
const Names& touchKeys();

/// Reads a key of what touches a plane, or of cylinders. Returns false for any other.
/// @throws SceneError
bool readTouchEntry(const std::string& key, const YAML::Node& value, Scene& scene);

}  // namespace virtual_work_dynamics
