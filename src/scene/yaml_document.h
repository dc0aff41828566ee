#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace virtual_work_dynamics {

/// Reads a text that is one YAML document, or none, in which case the node is null. Bounded:
/// refuses what is nested deeper, or becomes larger when its aliases are replaced by what they
/// stand for, than any description of a scene; and ends where yaml-cpp finds one empty document
/// after the other without ever reading on, as it does in ",".
/// @throws YAML::Exception with line and column.   @throws SceneError for more than one document.
YAML::Node readYamlDocument(const std::string& text);

}  // namespace virtual_work_dynamics
