#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

using Names = std::vector<std::string>;

bool contains(const Names& names, const std::string& name);

/// Reports what is wrong with a key of the scene, which its path names. @throws SceneError always.
[[noreturn]] void failAt(const std::string& key, const std::string& what);

/// Reports a key that is not one of those that may stand in the map `where`, which is empty for the
/// scene itself. @throws SceneError always, with the key that may be meant.
[[noreturn]] void failAtUnknownKey(const std::string& where, const std::string& key,
                                   const Names& keys);

// The following functions throw SceneError naming the key when the node has another type or value.

/// Reads a scalar as it is written; `expected` describes it in the message.
std::string scalarText(const YAML::Node& node, const std::string& key, const std::string& expected);
/// Reads a finite number, which may be in quotes.
double readNumber(const YAML::Node& node, const std::string& key);
/// Reads a list of three finite numbers.
Eigen::Vector3d readVector3(const YAML::Node& node, const std::string& key);
bool readBool(const YAML::Node& node, const std::string& key);
/// Reads one of several words. @returns its index in `words`.
std::size_t readWord(const YAML::Node& node, const std::string& key, const Names& words);
/// Reads a list of words; `what` says in the message what they are.
Names readNames(const YAML::Node& node, const std::string& key, const std::string& what);

using ReadEntry = std::function<void(const std::string& key, const YAML::Node& value)>;

/// Calls read(key, value) for every entry of a map and refuses keys that are given twice, which
/// yaml-cpp accepts. `prefix` stands before the key in messages.
void forEachEntry(const YAML::Node& map, const std::string& prefix, const ReadEntry& read);

/// Calls read(key, value, path) for every entry of a map that may have these keys and no others,
/// each once; `path` is `where` with the key.
void readMap(const YAML::Node& node, const std::string& where, const Names& keys,
             const std::function<void(const std::string& key, const YAML::Node& value,
                                      const std::string& path)>& read);

/// Reads a list of which read(node, where) makes each element.
template <typename Read>
auto readList(const YAML::Node& node, const std::string& key, Read read) {
  if (!node.IsSequence()) failAt(key, "expected a list");
  std::vector<decltype(read(node, key))> list;
  for (std::size_t i = 0; i < node.size(); ++i) {
    list.push_back(read(node[i], key + "[" + std::to_string(i) + "]"));
  }
  return list;
}

}  // namespace virtual_work_dynamics
