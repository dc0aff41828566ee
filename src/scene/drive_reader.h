#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Reads an entry of `drives`. @throws SceneError for keys that its law does not have, or lacks.
DriveLaw readDrive(const YAML::Node& node, const std::string& where);

}  // namespace virtual_work_dynamics
