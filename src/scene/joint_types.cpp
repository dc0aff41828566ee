#include "virtual_work_dynamics/joint_types.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "robot/compound_joints.h"
#include "scene/joint_type_checks.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

// Sine of the angle between the axes of a universal joint from which on they count as parallel: the
// moment about their common normal would leave hardly a digit of the efforts.
constexpr long double kParallel = 1e-6L;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw SceneError(where + what);
}

std::string text(const Eigen::Vector3d& v) {
  return "[" + numberText(v.x()) + ", " + numberText(v.y()) + ", " + numberText(v.z()) + "]";
}

// The direction of an axis that is given. Scaled first, so that its length does not overflow.
Vector3l direction(const Eigen::Vector3d& axis) {
  const Vector3l v = axis.cast<long double>();
  return (v / v.cwiseAbs().maxCoeff()).normalized();
}

void requireDirection(const std::optional<Eigen::Vector3d>& axis, const std::string& where) {
  if (!axis || (axis->allFinite() && !axis->isZero(0))) return;
  fail(where, ": " + text(*axis) + " has no direction");
}

void requireAcross(const Vector3l& axis, const Vector3l& axis2, const std::string& where) {
  if (axis.cross(axis2).norm() >= kParallel) return;
  fail(where, ".axis2: is parallel to the first axis");
}

bool hasAxis(CompoundType type) {
  return type != CompoundType::kSpherical && type != CompoundType::kFloating;
}

// The axis of a joint that an entry leaves to the description.
Vector3l describedAxis(const Mechanism& mechanism, int joint) {
  return mechanism.joint(joint).axis_K;
}

CompoundWish wishOf(const Mechanism& mechanism, const JointTypeEntry& entry,
                    const std::string& where) {
  CompoundWish wish;
  wish.joint = mechanism.reactionIndex(entry.joint);
  if (wish.joint < 0) {
    std::vector<std::string> names;
    for (int k = 0; k < static_cast<int>(mechanism.joints().size()); ++k) {
      if (!mechanism.isInnerPart(k)) names.push_back(mechanism.reactionName(k));
    }
    fail(where, ".name: no joint " + inQuotes(entry.joint) + nameHelp(entry.joint, names));
  }
  wish.type = entry.type;
  if (!hasAxis(entry.type)) return wish;
  wish.axis = entry.axis ? direction(*entry.axis) : describedAxis(mechanism, wish.joint);
  if (wish.axis.isZero(0)) {
    fail(where,
         ": joint " + inQuotes(entry.joint) + " has no axis in the description: axis is missing");
  }
  if (entry.axis2) {
    wish.axis2 = direction(*entry.axis2);
    requireAcross(wish.axis, wish.axis2, where);
  }
  wish.pitch = entry.pitch.value_or(0);
  return wish;
}

}  // namespace

const std::vector<std::string>& compoundTypeNames() {
  static const std::vector<std::string> names = {"planar", "cylindrical", "universal",
                                                 "screw",  "spherical",   "floating"};
  return names;
}

const char* nameOf(CompoundType type) {
  return compoundTypeNames()[static_cast<std::size_t>(type)].c_str();
}

void requireSoundType(const JointTypeEntry& entry, const std::string& where) {
  const auto only = [&](bool given, CompoundType type, const char* key) {
    if (given && entry.type != type) {
      fail(where, std::string(".") + key + ": only a joint of type " + nameOf(type) + " has one");
    }
    if (!given && entry.type == type) {
      fail(where,
           std::string(": ") + key + " is missing: a joint of type " + nameOf(type) + " has one");
    }
  };
  if (entry.axis && !hasAxis(entry.type)) {
    fail(where, std::string(".axis: a joint of type ") + nameOf(entry.type) + " has none");
  }
  only(entry.axis2.has_value(), CompoundType::kUniversal, "axis2");
  only(entry.pitch.has_value(), CompoundType::kScrew, "pitch");
  requireDirection(entry.axis, where + ".axis");
  requireDirection(entry.axis2, where + ".axis2");
  if (entry.pitch && !std::isfinite(*entry.pitch)) fail(where, ".pitch: is not finite");
  if (entry.axis && entry.axis2) {
    requireAcross(direction(*entry.axis), direction(*entry.axis2), where);
  }
}

Mechanism withJointTypes(const Mechanism& described, const Scene& scene) {
  if (scene.joint_types.empty()) return described;
  std::vector<CompoundWish> wishes;
  std::set<int> seen;
  for (std::size_t i = 0; i < scene.joint_types.size(); ++i) {
    const JointTypeEntry& entry = scene.joint_types[i];
    const std::string where = entryOf("joint_types", i);
    requireSoundType(entry, where);
    wishes.push_back(wishOf(described, entry, where));
    if (!seen.insert(wishes.back().joint).second) {
      fail(where, ".name: " + inQuotes(entry.joint) + " is given twice");
    }
  }
  try {
    return withCompounds(described, wishes);
  } catch (const UrdfError& error) {
    throw SceneError(std::string("joint_types: ") + error.what());
  }
}

void requireJointTypes(const Mechanism& mechanism, const Scene& scene) {
  for (std::size_t i = 0; i < scene.joint_types.size(); ++i) {
    const JointTypeEntry& entry = scene.joint_types[i];
    const auto& all = mechanism.compounds();
    const bool there = std::any_of(all.begin(), all.end(), [&](const CompoundJoint& compound) {
      return compound.name == entry.joint && compound.type == entry.type;
    });
    if (there) continue;
    fail(entryOf("joint_types", i), ": joint " + inQuotes(entry.joint) + " is not " +
                                        nameOf(entry.type) +
                                        " in this mechanism, withJointTypes() makes it so");
  }
}

}  // namespace virtual_work_dynamics
