#include "scene/touch_reader.h"

#include <cmath>

namespace virtual_work_dynamics {

namespace {

const Names kPlaneKeys = {"link", "point", "normal"};
const Names kRollingKeys = {"name",  "link", "centre", "axis", "radius",       "tube_radius",
                            "plane", "side", "normal", "slip", "roller_angle", "friction"};
const Names kCylinderKeys = {"name", "link_a", "at_a", "link_b", "at_b", "pulls_only"};
const Names kContactKeys = {"name", "link", "at", "plane", "slip", "friction", "closed", "gap"};
const Names kGapKeys = {"close", "open"};
const Names kKnifeEdgeKeys = {"name", "link", "at", "direction", "plane", "normal"};

// In the order of Slip.
const Names kSlips = {"none", "rolling", "lateral", "all"};
const Names kSlipsOfPoints = {"none", "all"};

void requireKey(bool given, const std::string& where, const std::string& what) {
  if (!given) failAt(where, what + " is missing");
}

Eigen::Vector3d readDirection(const YAML::Node& node, const std::string& key) {
  const Eigen::Vector3d v = readVector3(node, key);
  if (!(v.stableNorm() > 0)) failAt(key, "is zero, which is no direction");
  return v.stableNormalized();
}

// Turns that take z, or x, to a unit vector.
Eigen::Vector3d turnOfZ(const Eigen::Vector3d& z) {
  return {std::atan2(-z.y(), std::hypot(z.x(), z.z())), std::atan2(z.x(), z.z()), 0};
}
Eigen::Vector3d turnOfX(const Eigen::Vector3d& x) {
  return {0, std::atan2(-x.z(), std::hypot(x.x(), x.y())), std::atan2(x.y(), x.x())};
}

LinkFrame readPlane(const YAML::Node& node, const std::string& where) {
  LinkFrame plane;
  readMap(node, where, kPlaneKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "link") plane.link = scalarText(value, path, "a link's name");
    if (key == "point") plane.xyz = readVector3(value, path);
    if (key == "normal") plane.rpy = turnOfZ(readDirection(value, path));
  });
  requireKey(!plane.link.empty(), where, "link");
  return plane;
}

// The same plane seen from its other side: half a turn about x before its own.
void turnOver(LinkFrame& plane) {
  plane.rpy.x() += M_PI;
}

// What all lists have.
bool readCommon(const std::string& key, const YAML::Node& value, const std::string& path,
                Closure& closure) {
  if (key == "name") {
    closure.name = scalarText(value, path, "a name");
  } else if (key == "link") {
    closure.child.link = scalarText(value, path, "a link's name");
  } else if (key == "plane") {
    closure.parent = readPlane(value, path);
  } else if (key == "normal") {
    closure.touch.normal = readBool(value, path);
  } else if (key == "friction") {
    closure.touch.friction = readNumber(value, path);
  } else {
    return false;
  }
  return true;
}

void requireCommon(const Closure& closure, const std::string& where) {
  requireKey(!closure.name.empty(), where, "name");
  requireKey(!closure.child.link.empty(), where, "link");
  requireKey(!closure.parent.link.empty(), where, "plane");
}

Closure readRolling(const YAML::Node& node, const std::string& where) {
  Closure closure;
  closure.type = ClosureType::kRolling;
  bool has_axis = false, has_radius = false, has_slip = false, back = false;
  readMap(node, where, kRollingKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (readCommon(key, value, path, closure)) return;
    if (key == "centre") closure.child.xyz = readVector3(value, path);
    if (key == "axis") closure.child.rpy = turnOfZ(readDirection(value, path));
    if (key == "radius") closure.touch.radius = readNumber(value, path);
    if (key == "tube_radius") closure.touch.tube_radius = readNumber(value, path);
    if (key == "side") back = readWord(value, path, {"front", "back"}) == 1;
    if (key == "slip") {
      closure.touch.slip = static_cast<Slip>(readWord(value, path, kSlips));
    }
    if (key == "roller_angle") closure.touch.roller_angle = readNumber(value, path);
    has_axis = has_axis || key == "axis";
    has_radius = has_radius || key == "radius";
    has_slip = has_slip || key == "slip";
  });
  requireCommon(closure, where);
  requireKey(has_axis, where, "axis");
  requireKey(has_radius, where, "radius");
  if (has_slip && closure.touch.roller_angle) {
    failAt(where + ".slip", "a wheel with roller_angle has none: its rollers say how it slips");
  }
  if (back) turnOver(closure.parent);
  return closure;
}

Closure readKnifeEdge(const YAML::Node& node, const std::string& where) {
  Closure closure;
  closure.type = ClosureType::kKnifeEdge;
  bool has_direction = false;
  readMap(node, where, kKnifeEdgeKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (readCommon(key, value, path, closure)) return;
    if (key == "at") closure.child.xyz = readVector3(value, path);
    if (key == "direction") closure.child.rpy = turnOfX(readDirection(value, path));
    has_direction = has_direction || key == "direction";
  });
  requireCommon(closure, where);
  requireKey(has_direction, where, "direction");
  return closure;
}

Gap readGap(const YAML::Node& node, const std::string& where) {
  Gap gap;
  bool has_close = false, has_open = false;
  readMap(node, where, kGapKeys, [&](const auto& key, const auto& value, const auto& path) {
    (key == "close" ? gap.close : gap.open) = readNumber(value, path);
    (key == "close" ? has_close : has_open) = true;
  });
  requireKey(has_close, where, "close");
  requireKey(has_open, where, "open");
  return gap;
}

Closure readContact(const YAML::Node& node, const std::string& where) {
  Closure closure;
  closure.type = ClosureType::kContact;
  readMap(node, where, kContactKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (readCommon(key, value, path, closure)) return;
    if (key == "at") closure.child.xyz = readVector3(value, path);
    if (key == "slip" && readWord(value, path, kSlipsOfPoints) == 1) {
      closure.touch.slip = Slip::kAll;
    }
    if (key == "gap") closure.touch.gap = readGap(value, path);
    if (key == "closed") closure.touch.closed = readBool(value, path);
  });
  requireCommon(closure, where);
  return closure;
}

Closure readCylinder(const YAML::Node& node, const std::string& where) {
  Closure closure;
  closure.type = ClosureType::kCylinder;
  readMap(node, where, kCylinderKeys, [&](const auto& key, const auto& value, const auto& path) {
    if (key == "name") closure.name = scalarText(value, path, "a name");
    if (key == "link_a") closure.parent.link = scalarText(value, path, "a link's name");
    if (key == "at_a") closure.parent.xyz = readVector3(value, path);
    if (key == "link_b") closure.child.link = scalarText(value, path, "a link's name");
    if (key == "at_b") closure.child.xyz = readVector3(value, path);
    if (key == "pulls_only") closure.pulls_only = readBool(value, path);
  });
  requireKey(!closure.name.empty(), where, "name");
  requireKey(!closure.parent.link.empty(), where, "link_a");
  requireKey(!closure.child.link.empty(), where, "link_b");
  return closure;
}

void append(const std::vector<Closure>& more, Scene& scene) {
  scene.closures.insert(scene.closures.end(), more.begin(), more.end());
}

}  // namespace

const Names& touchKeys() {
  static const Names keys = {"rolling", "knife_edges", "contacts", "cylinders"};
  return keys;
}

bool readTouchEntry(const std::string& key, const YAML::Node& value, Scene& scene) {
  if (key == "rolling") {
    append(readList(value, key, readRolling), scene);
  } else if (key == "knife_edges") {
    append(readList(value, key, readKnifeEdge), scene);
  } else if (key == "contacts") {
    append(readList(value, key, readContact), scene);
  } else if (key == "cylinders") {
    append(readList(value, key, readCylinder), scene);
  } else {
    return false;
  }
  return true;
}

}  // namespace virtual_work_dynamics
