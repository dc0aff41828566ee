#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// A name of ROS and of each namespace above it: `/a/b/name`, `/a/name`, `/name`.
/// @param space that the search begins in, like `/a/b`
std::vector<std::string> searchedNames(const std::string& space, const std::string& name);

/// What `rosparam dump` wrote.
class ParameterDump {
 public:
  /// @throws FileError naming the file when it cannot be read or is no map of parameters.
  explicit ParameterDump(const std::string& path);

  /// The value of a parameter like `/a/b`, with everything below it; nothing: it is not set.
  std::optional<YAML::Node> find(const std::string& name) const;
  /// The first of these that is set; empty: none is.
  std::string firstOf(const std::vector<std::string>& names) const;
  /// Parameters whose last word is this one, in the order of the file.
  std::vector<std::string> endingIn(const std::string& word) const;

 private:
  YAML::Node root_;
};

}  // namespace virtual_work_dynamics
