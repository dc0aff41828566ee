#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Reads a scene from YAML (doc/scene_file.md). A null node is the default scene; numeric
/// strings are numbers.
/// @throws SceneError naming the key that is unknown or missing, or whose value has a wrong type or
///   length or is not finite.
Scene readScene(const YAML::Node& node);

/// Reads a scene from a YAML file, as readScene() does from a node.
/// @throws FileError when the file cannot be read or is not valid YAML; SceneError naming the file,
///   as readScene() or for more than one document.
Scene readSceneFile(const std::string& path);

}  // namespace virtual_work_dynamics
