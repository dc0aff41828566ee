#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

using Names = std::vector<std::string>;

bool contains(const Names& names, const std::string& name);

/// @throws SceneError always: the key of the scene, and what is wrong with it.
[[noreturn]] void failAt(const std::string& key, const std::string& what);

// Each throws SceneError naming the key when the node is something else.

/// A scalar as it stands; `expected` is for the message.
std::string scalarText(const YAML::Node& node, const std::string& key, const std::string& expected);
/// A finite number; numbers in quotes count, too.
double readNumber(const YAML::Node& node, const std::string& key);
Eigen::Vector3d readVector3(const YAML::Node& node, const std::string& key);
bool readBool(const YAML::Node& node, const std::string& key);
/// One of several words: its index.
std::size_t readWord(const YAML::Node& node, const std::string& key, const Names& words);
/// A list of words; `what` they are is for the message.
Names readNames(const YAML::Node& node, const std::string& key, const std::string& what);

using ReadEntry = std::function<void(const std::string& key, const YAML::Node& value)>;

/// Calls read(key, value) for every entry of a map, each key once; yaml-cpp itself would let a
/// doubled key pass. `prefix` stands before the key in messages.
void forEachEntry(const YAML::Node& map, const std::string& prefix, const ReadEntry& read);

/// The same for a map that knows these keys and no others: `read` gets the whole path of the key
/// behind it.
void readMap(const YAML::Node& node, const std::string& where, const Names& keys,
             const std::function<void(const std::string& key, const YAML::Node& value,
                                      const std::string& path)>& read);

/// A list, entry by entry: `read(node, where)` makes an element.
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
