#include "scene/closure_reader.h"

#include "scene/closure_types.h"
#include "scene/drive_reader.h"
#include "scene/touch_reader.h"
#include "scene/yaml_values.h"

namespace virtual_work_dynamics {

namespace {

const Names kFrameKeys = {"link", "xyz", "rpy"};
const Names kClosureKeys = {"name",  "type",   "parent",         "child",      "length",
                            "radii", "radius", "pressure_angle", "helix_angle"};
const Names kSpringKeys = {"name", "link_a",    "at_a",        "link_b",
                           "at_b", "stiffness", "rest_length", "damping"};
const Names kCouplingKeys = {"name", "terms", "offset", "rate_only"};
const Names kRedundancyKeys = {"policy",         "zero_at",        "stiffness",
                               "effort_weights", "rank_tolerance", "length"};

// In the order of RedundancyPolicy.
const Names kPolicies = {"minimum_norm", "zero_at", "stiffness"};

void require(bool given, const std::string& where, const std::string& what) {
  if (!given) failAt(where, what + " is missing");
}

ClosureType readClosureType(const YAML::Node& node, const std::string& where) {
  Names names;
  for (const ClosureTypeTraits& traits : closureTypes()) {  // those first that `closures` may have
    if (traits.list == std::string("closures")) names.push_back(traits.name);
  }
  return closureTypes()[readWord(node, where, names)].type;
}

LinkFrame readFrame(const YAML::Node& node, const std::string& where) {
  LinkFrame frame;
  readMap(node, where, kFrameKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "link") frame.link = scalarText(value, path, "a link's name");
    if (key == "xyz") frame.xyz = readVector3(value, path);
    if (key == "rpy") frame.rpy = readVector3(value, path);
  });
  require(!frame.link.empty(), where, "link");
  return frame;
}

// Radii of two wheels.
void readRadii(const YAML::Node& node, const std::string& where, Teeth& teeth) {
  if (!node.IsSequence() || node.size() != 2) failAt(where, "expected a list of two numbers");
  teeth.parent_radius = readNumber(node[0], where);
  teeth.child_radius = readNumber(node[1], where);
}

// Refuses what belongs to another type and would have no effect.
void checkType(const Closure& closure, const Names& given, const std::string& where) {
  if (closure.length && !traitsOf(closure.type).hasLength()) {
    failAt(where + ".length", "only a closure of type distance has a length");
  }
  const bool gear = closure.type == ClosureType::kGear, rack = closure.type == ClosureType::kRack;
  for (const std::string& key : given) {
    if (key == "radii" ? gear : key == "radius" ? rack : gear || rack) continue;
    failAt(where + "." + key, key == "radii"    ? "only a closure of type gear has radii"
                              : key == "radius" ? "only a closure of type rack has a radius"
                                                : "only closures of type gear and rack have teeth");
  }
  require(!gear || contains(given, "radii"), where, "radii");
  require(!rack || contains(given, "radius"), where, "radius");
}

Closure readClosure(const YAML::Node& node, const std::string& where) {
  Closure closure;
  bool has_type = false;
  Names teeth;
  readMap(node, where, kClosureKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "name") closure.name = scalarText(value, path, "a name");
    if (key == "type") {
      closure.type = readClosureType(value, path);
      has_type = true;
    }
    if (key == "parent") closure.parent = readFrame(value, path);
    if (key == "child") closure.child = readFrame(value, path);
    if (key == "length") closure.length = readNumber(value, path);
    if (key == "radii") readRadii(value, path, closure.teeth);
    if (key == "radius") closure.teeth.parent_radius = readNumber(value, path);
    if (key == "pressure_angle") closure.teeth.pressure_angle = readNumber(value, path);
    if (key == "helix_angle") closure.teeth.helix_angle = readNumber(value, path);
    for (const char* of_teeth : {"radii", "radius", "pressure_angle", "helix_angle"}) {
      if (key == of_teeth) teeth.push_back(key);
    }
  });
  require(!closure.name.empty(), where, "name");
  require(has_type, where, "type");
  require(!closure.parent.link.empty(), where, "parent");
  require(!closure.child.link.empty(), where, "child");
  checkType(closure, teeth, where);
  return closure;
}

PointSpring readSpring(const YAML::Node& node, const std::string& where) {
  PointSpring spring;
  bool has_stiffness = false;
  bool has_damping = false;
  readMap(node, where, kSpringKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "name") spring.name = scalarText(value, path, "a name");
    if (key == "link_a") spring.link_a = scalarText(value, path, "a link's name");
    if (key == "at_a") spring.at_a = readVector3(value, path);
    if (key == "link_b") spring.link_b = scalarText(value, path, "a link's name");
    if (key == "at_b") spring.at_b = readVector3(value, path);
    if (key == "stiffness") {
      spring.stiffness = readNumber(value, path);
      has_stiffness = true;
    }
    if (key == "rest_length") spring.rest_length = readNumber(value, path);
    if (key == "damping") {
      spring.damping = readNumber(value, path);
      has_damping = true;
    }
  });
  require(!spring.name.empty(), where, "name");
  require(!spring.link_a.empty(), where, "link_a");
  require(!spring.link_b.empty(), where, "link_b");
  require(has_stiffness || has_damping, where, "stiffness");
  return spring;
}

// Reads an entry {name: ..., <quantity>: ...}.
NamedNumber readNamedNumber(const YAML::Node& node, const std::string& where,
                            const std::string& quantity) {
  NamedNumber number;
  bool has_value = false;
  readMap(node, where, {"name", quantity},
          [&](const auto& key, const auto& value, const auto& path) {
            if (key == "name") {
              number.name = scalarText(value, path, "a name");
            } else {
              number.value = readNumber(value, path);
              has_value = true;
            }
          });
  require(!number.name.empty(), where, "name");
  require(has_value, where, quantity);
  return number;
}

std::vector<NamedNumber> readNamedNumbers(const YAML::Node& node, const std::string& key,
                                          const std::string& quantity) {
  return readList(node, key, [&](const YAML::Node& entry, const std::string& where) {
    return readNamedNumber(entry, where, quantity);
  });
}

Coupling readCoupling(const YAML::Node& node, const std::string& where) {
  Coupling coupling;
  readMap(node, where, kCouplingKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "name") coupling.name = scalarText(value, path, "a name");
    if (key == "terms") coupling.terms = readNamedNumbers(value, path, "factor");
    if (key == "offset") coupling.offset = readNumber(value, path);
    if (key == "rate_only") coupling.rate_only = readBool(value, path);
  });
  require(!coupling.name.empty(), where, "name");
  require(!coupling.terms.empty(), where, "terms");
  return coupling;
}

// Refuses what belongs to another policy and would have no effect.
void checkPolicy(const Redundancy& redundancy, bool has_zero_at, bool has_stiffness) {
  const bool zero_at = redundancy.policy == RedundancyPolicy::kZeroAt;
  const bool stiffness = redundancy.policy == RedundancyPolicy::kStiffness;
  if (has_zero_at && !zero_at) failAt("redundancy.zero_at", "the policy is not zero_at");
  if (has_stiffness && !stiffness) failAt("redundancy.stiffness", "the policy is not stiffness");
  if (zero_at && redundancy.zero_at.empty()) failAt("redundancy.zero_at", "names no closure");
  if (stiffness && redundancy.stiffness.empty()) {
    failAt("redundancy.stiffness", "names no joint or closure");
  }
}

Redundancy readRedundancy(const YAML::Node& node) {
  const std::string where = "redundancy";
  Redundancy redundancy;
  bool has_zero_at = false;
  bool has_stiffness = false;
  readMap(node, where, kRedundancyKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "policy") {
      redundancy.policy = static_cast<RedundancyPolicy>(readWord(value, path, kPolicies));
    }
    if (key == "zero_at") {
      redundancy.zero_at = readNames(value, path, "closures' names");
      has_zero_at = true;
    }
    if (key == "stiffness") {
      redundancy.stiffness = readNamedNumbers(value, path, "stiffness");
      has_stiffness = true;
    }
    if (key == "effort_weights") {
      redundancy.effort_weights = readNamedNumbers(value, path, "weight");
    }
    if (key == "rank_tolerance") redundancy.rank_tolerance = readNumber(value, path);
    if (key == "length" && scalarText(value, path, "auto or a number") != "auto") {
      redundancy.length = readNumber(value, path);
    }
  });
  checkPolicy(redundancy, has_zero_at, has_stiffness);
  return redundancy;
}

}  // namespace

bool readLoopEntry(const std::string& key, const YAML::Node& value, Scene& scene) {
  if (key == "closures") {
    const std::vector<Closure> closures = readList(value, key, readClosure);
    scene.closures.insert(scene.closures.end(), closures.begin(), closures.end());
  } else if (key == "springs") {
    scene.springs = readList(value, key, readSpring);
  } else if (key == "couplings") {
    scene.couplings = readList(value, key, readCoupling);
  } else if (key == "actuated") {
    scene.actuated = readNames(value, key, "names of joints and closures");
  } else if (key == "free_motion") {
    scene.free_motion = readBool(value, key);
  } else if (key == "given") {
    scene.given = readNames(value, key, "names of joints and closures");
  } else if (key == "drives") {
    scene.drives = readList(value, key, readDrive);
  } else if (key == "assembly") {
    scene.assembly = readNamedNumbers(value, key, "position");
  } else if (key == "contact_intervals") {
    scene.contact_intervals = readBool(value, key);
  } else if (key == "redundancy") {
    scene.redundancy = readRedundancy(value);
  } else {
    return readTouchEntry(key, value, scene);
  }
  return true;
}

}  // namespace virtual_work_dynamics
