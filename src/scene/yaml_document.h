#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>

namespace virtual_work_dynamics {

/// How deep a scene may be nested, and how many values it may have when its aliases are replaced by
/// what they stand for.
constexpr std::size_t kDeepestYaml = 64;
constexpr std::size_t kMostYamlValues = 1000000;

/// Reads a text that is one YAML document, or none, in which case the node is null. Bounded:
/// refuses what is nested deeper, or becomes larger when its aliases are replaced by what they
/// stand for, than any description of a scene; and ends where yaml-cpp finds one empty document
/// after the other without ever reading on, as it does in ",".
/// @throws YAML::Exception with line and column.   @throws SceneError for more than one document.
YAML::Node readYamlDocument(const std::string& text);

}  // namespace virtual_work_dynamics
