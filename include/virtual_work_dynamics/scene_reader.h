#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Reads a scene from YAML (doc/scene_file.md). A null node is the default scene; numeric
/// strings are numbers.
/// @throws SceneError naming the key: unknown or missing, wrong type or length, not finite.
Scene readScene(const YAML::Node& node);

/// The same from a file. @throws FileError when it cannot be read or is no YAML, SceneError as
/// above.
Scene readSceneFile(const std::string& path);

}  // namespace virtual_work_dynamics
