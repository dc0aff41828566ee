#include "virtual_work_dynamics/scene_reader.h"

#include <algorithm>

#include "base/number_text.h"
#include "base/printable.h"
#include "base/text_file.h"
#include "scene/closure_reader.h"
#include "scene/closure_types.h"
#include "scene/joint_type_checks.h"
#include "scene/touch_reader.h"
#include "scene/yaml_document.h"
#include "scene/yaml_values.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

const Names kSceneKeys = {"gravity",        "root",
                          "motion",         "reactions",
                          "include_active", "moments_about",
                          "strict_inertia", "applied_wrenches",
                          "joints",         "use_urdf_dynamics",
                          "tolerances",     "payload",
                          "joint_types",    "urdf_transmissions"};
// Bytes, beyond those of the most values that a scene may have.
constexpr std::size_t kLongestScene = std::size_t{64} << 20;
const Names kWrenchKeys = {"name",   "link", "at",     "axes",     "force",
                           "torque", "live", "invert", "deviation"};
const Names kWrenchDeviationKeys = {"force", "torque"};
// What the messages or columns of a live wrench say instead.
const Names kMeasured = {"at", "axes", "force", "torque"};
const Names kPayloadKeys = {"link", "mass", "at", "inertia"};
const Names kMomentKeys = {"name", "frame", "link", "at"};
const Names kTypeKeys = {"name", "type", "axis", "axis2", "pitch"};
const Names kToleranceKeys = {"mass", "inertia"};
const Names kJointKeys = {"name",    "stiffness",        "rest",          "damping",
                          "coulomb", "coulomb_velocity", "rotor_inertia", "offset"};

void readReactions(const YAML::Node& node, Scene& scene) {
  if (node.IsSequence()) {
    scene.reactions = ReactionSelection::kNamed;
    scene.reaction_names = readNames(node, "reactions", "joint names");
    return;
  }
  const std::string text = scalarText(node, "reactions", "all, none or a list of joint names");
  if (text != "all" && text != "none") {
    failAt("reactions", inQuotes(text) + " is neither all, none nor a list of joint names");
  }
  scene.reactions = text == "all" ? ReactionSelection::kAll : ReactionSelection::kNone;
}

void readTransmissions(const YAML::Node& node, Scene& scene) {
  const std::string key = "urdf_transmissions";
  if (node.IsSequence()) {
    scene.transmissions = TransmissionSelection::kNamed;
    scene.transmission_names = readNames(node, key, "names of transmissions");
    return;
  }
  const std::string text = scalarText(node, key, "all, none or a list of names of transmissions");
  if (text != "all" && text != "none") {
    failAt(key, inQuotes(text) + " is neither all, none nor a list of names of transmissions");
  }
  scene.transmissions = text == "all" ? TransmissionSelection::kAll : TransmissionSelection::kNone;
}

WrenchDeviation readWrenchDeviation(const YAML::Node& node, const std::string& where) {
  WrenchDeviation deviation;
  readMap(node, where, kWrenchDeviationKeys,
          [&](const auto& key, const auto& value, const auto& path) {
            const double number = readNumber(value, path);
            if (!(number >= 0)) failAt(path, numberText(number) + " is not zero or more");
            if (key == "force") deviation.force = number;
            if (key == "torque") deviation.torque = number;
          });
  return deviation;
}

AppliedWrench readAppliedWrench(const YAML::Node& node, const std::string& where) {
  AppliedWrench wrench;
  std::string fixed;  // a key of kMeasured that is given
  readMap(node, where, kWrenchKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "name") wrench.name = scalarText(value, path, "a name");
    if (key == "link") wrench.link = scalarText(value, path, "a link's name");
    if (key == "live") wrench.live = readBool(value, path);
    if (key == "invert") wrench.invert = readBool(value, path);
    if (contains(kMeasured, key)) fixed = key;
    if (key == "at") wrench.at = readVector3(value, path);
    if (key == "axes") {
      wrench.axes = readWord(value, path, {"link", "root"}) == 0 ? Axes::kLink : Axes::kRoot;
    }
    if (key == "force") wrench.force = readVector3(value, path);
    if (key == "torque") wrench.torque = readVector3(value, path);
    if (key == "deviation") wrench.deviation = readWrenchDeviation(value, path);
  });
  if (wrench.link.empty()) failAt(where, "names no link");
  if (wrench.live && !fixed.empty()) {
    failAt(where + "." + fixed, "a live wrench has none: what it receives says so");
  }
  return wrench;
}

Eigen::Matrix3d readInertia(const YAML::Node& node, const std::string& key) {
  if (!node.IsSequence() || node.size() != 6) {
    failAt(key, "expected a list of six numbers: ixx, ixy, ixz, iyy, iyz, izz");
  }
  double numbers[6];
  for (std::size_t i = 0; i < 6; ++i) numbers[i] = readNumber(node[i], key);
  const auto [xx, xy, xz, yy, yz, zz] = numbers;
  Eigen::Matrix3d inertia;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return inertia;
}

Payload readPayload(const YAML::Node& node, const std::string& where) {
  Payload payload;
  bool has_mass = false;
  readMap(node, where, kPayloadKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "link") payload.link = scalarText(value, path, "a link's name");
    if (key == "mass") payload.mass = readNumber(value, path);
    if (key == "mass") has_mass = true;
    if (key == "at") payload.at = readVector3(value, path);
    if (key == "inertia") payload.inertia = readInertia(value, path);
  });
  if (payload.link.empty()) failAt(where, "names no link");
  if (!has_mass) failAt(where, "has no mass");
  return payload;
}

MomentPoint readMomentPoint(const YAML::Node& node, const std::string& where) {
  MomentPoint point;
  bool has_frame = false;
  readMap(node, where, kMomentKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "name") point.name = scalarText(value, path, "the name of a joint or closure");
    if (key == "frame") {
      const bool parent = readWord(value, path, {"parent", "child"}) == 0;
      point.frame = parent ? JointFrame::kParent : JointFrame::kChild;
      has_frame = true;
    }
    if (key == "link") point.link = scalarText(value, path, "a link's name");
    if (key == "at") point.at = readVector3(value, path);
  });
  if (point.name.empty()) failAt(where, "names no joint or closure");
  if (has_frame && point.link) {
    failAt(where, "has both frame and link; one of them says where the point is fixed");
  }
  return point;
}

JointTerms readJointTerms(const YAML::Node& node, const std::string& where) {
  JointTerms terms;
  readMap(node, where, kJointKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "name") {
      terms.joint = scalarText(value, path, "a joint's name");
      return;
    }
    const double number = readNumber(value, path);
    if (key == "stiffness") terms.stiffness = number;
    if (key == "rest") terms.rest = number;
    if (key == "damping") terms.damping = number;
    if (key == "coulomb") terms.coulomb = number;
    if (key == "coulomb_velocity") terms.coulomb_velocity = number;
    if (key == "rotor_inertia") terms.rotor_inertia = number;
    if (key == "offset") terms.offset = number;
  });
  if (terms.joint.empty()) failAt(where, "names no joint");
  return terms;
}

JointTypeEntry readJointType(const YAML::Node& node, const std::string& where) {
  JointTypeEntry entry;
  bool has_type = false;
  readMap(node, where, kTypeKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "name") entry.joint = scalarText(value, path, "a joint's name");
    if (key == "type") {
      entry.type = static_cast<CompoundType>(readWord(value, path, compoundTypeNames()));
      has_type = true;
    }
    if (key == "axis") entry.axis = readVector3(value, path);
    if (key == "axis2") entry.axis2 = readVector3(value, path);
    if (key == "pitch") entry.pitch = readNumber(value, path);
  });
  if (entry.joint.empty()) failAt(where, "names no joint");
  if (!has_type) failAt(where, "type is missing");
  requireSoundType(entry, where);
  return entry;
}

Tolerances readTolerances(const YAML::Node& node, const std::string& where) {
  Tolerances tolerances;
  readMap(node, where, kToleranceKeys, [&](const auto& key, const auto& value, const auto& path) {
    const double number = readNumber(value, path);
    if (!(number >= 0 && number < 1)) {
      failAt(path, numberText(number) + " is not from 0 to below 1");
    }
    if (key == "mass") tolerances.mass = number;
    if (key == "inertia") tolerances.inertia = number;
  });
  return tolerances;
}

// Where the list of the scene that a closure stands in comes among them.
// Every other list has one type.
int listOf(const Closure& closure) {
  const bool first = traitsOf(closure.type).list == std::string("closures");
  return first ? -1 : static_cast<int>(closure.type);
}

void readEntry(const std::string& key, const YAML::Node& value, Scene& scene) {
  if (readLoopEntry(key, value, scene)) return;
  if (!contains(kSceneKeys, key)) {
    Names known = kSceneKeys;
    for (const char* other : {"closures", "springs", "couplings", "actuated", "free_motion",
                              "given", "drives", "assembly", "redundancy", "contact_intervals"}) {
      known.emplace_back(other);
    }
    known.insert(known.end(), touchKeys().begin(), touchKeys().end());
    failAtUnknownKey("", key, known);
  }
  if (key == "gravity") scene.gravity = readVector3(value, key);
  if (key == "root") scene.root_moves = readWord(value, key, {"fixed", "moving"}) == 1;
  if (key == "motion") scene.static_motion = readWord(value, key, {"full", "static"}) == 1;
  if (key == "reactions") readReactions(value, scene);
  if (key == "include_active") scene.include_active = readBool(value, key);
  if (key == "moments_about") scene.moments_about = readList(value, key, readMomentPoint);
  if (key == "strict_inertia") scene.strict_inertia = readBool(value, key);
  if (key == "applied_wrenches") scene.applied_wrenches = readList(value, key, readAppliedWrench);
  if (key == "payload") scene.payloads = readList(value, key, readPayload);
  if (key == "joints") scene.joints = readList(value, key, readJointTerms);
  if (key == "joint_types") scene.joint_types = readList(value, key, readJointType);
  if (key == "urdf_transmissions") readTransmissions(value, scene);
  if (key == "tolerances") scene.tolerances = readTolerances(value, key);
  if (key == "use_urdf_dynamics") scene.use_urdf_dynamics = readBool(value, key);
}

}  // namespace

Scene readScene(const YAML::Node& node) {
  Scene scene;
  if (!node || node.IsNull()) return scene;
  if (!node.IsMap()) throw SceneError("expected a map of keys, such as gravity: [0, 0, -9.81]");
  forEachEntry(node, "", [&](const std::string& key, const YAML::Node& value) {
    readEntry(key, value, scene);
  });
  // The order of a map's keys says nothing, and ROS parameters do not keep it.
  std::stable_sort(scene.closures.begin(), scene.closures.end(),
                   [](const Closure& a, const Closure& b) { return listOf(a) < listOf(b); });
  return scene;
}

Scene readSceneFile(const std::string& path) {
  const std::string text = readTextFile(path, kLongestScene);
  YAML::Node node;
  try {
    node = readYamlDocument(text);
  } catch (const SceneError& error) {
    throw SceneError(path + ": " + error.what());
  } catch (const YAML::Exception& error) {
    throw FileError(path + ": is not valid YAML: " + printable(error.what()));
  }
  try {
    return readScene(node);
  } catch (const SceneError& error) {
    throw SceneError(path + ": " + error.what());
  }
}

}  // namespace virtual_work_dynamics
