#include "virtual_work_dynamics/scene_reader.h"

#include <algorithm>

#include "core/text_file.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/number_text.h"

namespace virtual_work_dynamics {

namespace {

using Names = std::vector<std::string>;

const Names kSceneKeys = {"gravity",        "motion",           "reactions", "include_active",
                          "strict_inertia", "applied_wrenches", "joints",    "use_urdf_dynamics"};
const Names kLaterKeys = {"springs", "closures", "actuated", "assembly", "redundancy"};
const Names kWrenchKeys = {"link", "at", "axes", "force", "torque"};
const Names kJointKeys = {"name",    "stiffness",        "rest",         "damping",
                          "coulomb", "coulomb_velocity", "rotor_inertia"};

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void fail(const std::string& key, const std::string& what) {
  throw SceneError("scene: " + key + ": " + what);
}

std::string scalarText(const YAML::Node& node, const std::string& key, const char* expected) {
  if (!node.IsScalar()) fail(key, std::string("expected ") + expected);
  return node.Scalar();
}

double readNumber(const YAML::Node& node, const std::string& key) {
  const std::string text = scalarText(node, key, "a number");
  double value = 0;
  if (!parseNumber(text, value)) fail(key, "'" + text + "' is not a finite number");
  return value;
}

Eigen::Vector3d readVector3(const YAML::Node& node, const std::string& key) {
  if (!node.IsSequence() || node.size() != 3) fail(key, "expected a list of three numbers");
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = readNumber(node[i], key);
  return vector;
}

bool readBool(const YAML::Node& node, const std::string& key) {
  bool value = false;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) {
    fail(key, "expected true or false");
  }
  return value;
}

// One of two words; true for the first.
bool readChoice(const YAML::Node& node, const std::string& key, const std::string& first,
                const std::string& second) {
  const std::string text = scalarText(node, key, (first + " or " + second).c_str());
  if (text != first && text != second) {
    fail(key, "'" + text + "' is neither " + first + " nor " + second);
  }
  return text == first;
}

void readReactions(const YAML::Node& node, Scene& scene) {
  if (node.IsSequence()) {
    scene.reactions = ReactionSelection::kNamed;
    for (const YAML::Node& name : node) {
      scene.reaction_names.push_back(scalarText(name, "reactions", "a list of joint names"));
    }
    return;
  }
  const std::string text = scalarText(node, "reactions", "all, none or a list of joint names");
  if (text != "all" && text != "none") {
    fail("reactions", "'" + text + "' is neither all, none nor a list of joint names");
  }
  scene.reactions = text == "all" ? ReactionSelection::kAll : ReactionSelection::kNone;
}

// Calls read(key, value) for every entry of a map; yaml-cpp itself would let a doubled key pass.
template <typename Read>
void forEachEntry(const YAML::Node& map, const std::string& prefix, Read read) {
  Names seen;
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) throw SceneError("scene: " + prefix + "a key is not a word");
    const std::string& key = entry.first.Scalar();
    if (contains(seen, key)) fail(prefix + key, "given twice");
    seen.push_back(key);
    read(key, entry.second);
  }
}

AppliedWrench readAppliedWrench(const YAML::Node& node, const std::string& where) {
  if (!node.IsMap()) fail(where, "expected a map with link, at, axes, force, torque");
  AppliedWrench wrench;
  forEachEntry(node, where + ".", [&](const std::string& key, const YAML::Node& value) {
    const std::string path = where + "." + key;
    if (!contains(kWrenchKeys, key)) fail(path, "unknown key");
    if (key == "link") wrench.link = scalarText(value, path, "a link's name");
    if (key == "at") wrench.at = readVector3(value, path);
    if (key == "axes") {
      wrench.axes = readChoice(value, path, "link", "root") ? Axes::kLink : Axes::kRoot;
    }
    if (key == "force") wrench.force = readVector3(value, path);
    if (key == "torque") wrench.torque = readVector3(value, path);
  });
  if (wrench.link.empty()) fail(where, "names no link");
  return wrench;
}

JointTerms readJointTerms(const YAML::Node& node, const std::string& where) {
  if (!node.IsMap()) {
    fail(where,
         "expected a map with name, stiffness, rest, damping, coulomb, coulomb_velocity, "
         "rotor_inertia");
  }
  JointTerms terms;
  forEachEntry(node, where + ".", [&](const std::string& key, const YAML::Node& value) {
    const std::string path = where + "." + key;
    if (!contains(kJointKeys, key)) fail(path, "unknown key");
    if (key == "name") terms.joint = scalarText(value, path, "a joint's name");
    if (key == "stiffness") terms.stiffness = readNumber(value, path);
    if (key == "rest") terms.rest = readNumber(value, path);
    if (key == "damping") terms.damping = readNumber(value, path);
    if (key == "coulomb") terms.coulomb = readNumber(value, path);
    if (key == "coulomb_velocity") terms.coulomb_velocity = readNumber(value, path);
    if (key == "rotor_inertia") terms.rotor_inertia = readNumber(value, path);
  });
  if (terms.joint.empty()) fail(where, "names no joint");
  return terms;
}

void readJoints(const YAML::Node& node, Scene& scene) {
  if (!node.IsSequence()) fail("joints", "expected a list");
  for (std::size_t i = 0; i < node.size(); ++i) {
    scene.joints.push_back(readJointTerms(node[i], "joints[" + std::to_string(i) + "]"));
  }
}

void readAppliedWrenches(const YAML::Node& node, Scene& scene) {
  if (!node.IsSequence()) fail("applied_wrenches", "expected a list");
  for (std::size_t i = 0; i < node.size(); ++i) {
    scene.applied_wrenches.push_back(
        readAppliedWrench(node[i], "applied_wrenches[" + std::to_string(i) + "]"));
  }
}

void readEntry(const std::string& key, const YAML::Node& value, Scene& scene) {
  if (contains(kLaterKeys, key)) fail(key, "not available yet");
  if (!contains(kSceneKeys, key)) fail(key, "unknown key");
  if (key == "gravity") scene.gravity = readVector3(value, key);
  if (key == "motion") scene.static_motion = !readChoice(value, key, "full", "static");
  if (key == "reactions") readReactions(value, scene);
  if (key == "include_active") scene.include_active = readBool(value, key);
  if (key == "strict_inertia") scene.strict_inertia = readBool(value, key);
  if (key == "applied_wrenches") readAppliedWrenches(value, scene);
  if (key == "joints") readJoints(value, scene);
  if (key == "use_urdf_dynamics") scene.use_urdf_dynamics = readBool(value, key);
}

}  // namespace

Scene readScene(const YAML::Node& node) {
  Scene scene;
  if (!node || node.IsNull()) return scene;
  if (!node.IsMap()) throw SceneError("scene: expected a map of keys");
  forEachEntry(node, "", [&](const std::string& key, const YAML::Node& value) {
    readEntry(key, value, scene);
  });
  return scene;
}

Scene readSceneFile(const std::string& path) {
  const std::string text = readTextFile(path);
  YAML::Node node;
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) throw SceneError(path + ": holds more than one YAML document");
    if (!documents.empty()) node = documents.front();
  } catch (const YAML::Exception& error) {
    throw FileError(path + ": is no YAML: " + error.what());
  }
  try {
    return readScene(node);
  } catch (const SceneError& error) {
    throw SceneError(path + ": " + error.what());
  }
}

}  // namespace virtual_work_dynamics
