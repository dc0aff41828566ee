#include "scene/yaml_values.h"

#include <algorithm>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Lists words as "a, b or c", or with another separator before the last.
std::string listed(const Names& words, const std::string& last = " or ") {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? last : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void failAt(const std::string& key, const std::string& what) {
  throw SceneError(printable(key) + ": " + what);
}

void failAtUnknownKey(const std::string& where, const std::string& key, const Names& keys) {
  failAt(where + (where.empty() ? "" : ".") + shortened(key), "unknown key" + nameHelp(key, keys));
}

std::string scalarText(const YAML::Node& node, const std::string& key,
                       const std::string& expected) {
  if (!node.IsScalar()) failAt(key, "expected " + expected);
  return node.Scalar();
}

double readNumber(const YAML::Node& node, const std::string& key) {
  const std::string text = scalarText(node, key, "a number");
  double value = 0;
  if (!parseNumber(text, value)) failAt(key, inQuotes(text) + " is not a finite number");
  return value;
}

Eigen::Vector3d readVector3(const YAML::Node& node, const std::string& key) {
  if (!node.IsSequence() || node.size() != 3) failAt(key, "expected a list of three numbers");
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = readNumber(node[i], key);
  return vector;
}

bool readBool(const YAML::Node& node, const std::string& key) {
  bool value = false;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) {
    failAt(key, "expected true or false");
  }
  return value;
}

std::size_t readWord(const YAML::Node& node, const std::string& key, const Names& words) {
  const std::string text = scalarText(node, key, listed(words));
  const auto found = std::find(words.begin(), words.end(), text);
  if (found == words.end()) {
    const std::string nearest = nearestName(text, words);
    failAt(key, inQuotes(text) +
                    (words.size() == 2 ? " is neither " + listed(words, " nor ")
                                       : " is not one of " + listed(words, ", ")) +
                    (nearest.empty() ? "" : "; did you mean " + inQuotes(nearest) + "?"));
  }
  return static_cast<std::size_t>(found - words.begin());
}

Names readNames(const YAML::Node& node, const std::string& key, const std::string& what) {
  const std::string expected = "a list of " + what;
  if (!node.IsSequence()) failAt(key, "expected " + expected);
  Names names;
  for (const YAML::Node& name : node) names.push_back(scalarText(name, key, expected));
  return names;
}

void forEachEntry(const YAML::Node& map, const std::string& prefix, const ReadEntry& read) {
  Names seen;
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) throw SceneError(prefix + "a key is not a word");
    const std::string& key = entry.first.Scalar();
    if (contains(seen, key)) failAt(prefix + shortened(key), "given twice");
    seen.push_back(key);
    read(key, entry.second);
  }
}

void readMap(const YAML::Node& node, const std::string& where, const Names& keys,
             const std::function<void(const std::string& key, const YAML::Node& value,
                                      const std::string& path)>& read) {
  if (!node.IsMap()) failAt(where, "expected a map with " + listed(keys, ", "));
  forEachEntry(node, where + ".", [&](const std::string& key, const YAML::Node& value) {
    const std::string path = where + "." + key;
    if (!contains(keys, key)) failAtUnknownKey(where, key, keys);
    read(key, value, path);
  });
}

}  // namespace virtual_work_dynamics
