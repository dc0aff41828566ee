#include "scene/input_checks.h"

#include <set>
#include <string>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

void requireLength(const char* name, Eigen::Index size, Eigen::Index expected) {
  if (size == expected) return;
  throw MotionError(std::string("motion: ") + name + " has " + std::to_string(size) +
                    " entries, the mechanism has " + std::to_string(expected) + " coordinates");
}

}  // namespace

void requireLengths(const Motion& motion, Eigen::Index coordinates) {
  requireLength("q", motion.q.size(), coordinates);
  requireLength("qd", motion.qd.size(), coordinates);
  requireLength("qdd", motion.qdd.size(), coordinates);
}

void requireLoad(const Load& load, std::size_t applied) {
  if (load.wrenches.size() == applied) return;
  throw SceneError("load: it has " + std::to_string(load.wrenches.size()) +
                   " wrenches, the scene has " + std::to_string(applied) + " applied wrenches");
}

const Scene& openChain(const Scene& scene) {
  if (!scene.closures.empty()) {
    throw SceneError("closures: '" + scene.closures[0].name + "': an open chain has no closures");
  }
  if (!scene.springs.empty()) {
    throw SceneError("springs: '" + scene.springs[0].name +
                     "': an open chain has no springs between points");
  }
  if (scene.actuated) {
    throw SceneError("actuated: every joint of an open chain carries effort");
  }
  return scene;
}

void requireSoundInertias(const Mechanism& mechanism, const Scene& scene) {
  if (!scene.strict_inertia) return;
  for (const Doubt& doubt : mechanism.doubts()) {
    if (doubt.about_inertia) throw SceneError("strict_inertia: " + doubt.text);
  }
}

std::vector<int> linksOf(const Mechanism& mechanism, const std::vector<std::string>& reactions) {
  std::vector<int> links;
  std::set<std::string> seen;
  for (const std::string& name : reactions) {
    if (!seen.insert(name).second) {
      throw SceneError("reactions: '" + name + "' is requested twice");
    }
    const int joint = name == kGround ? -1 : mechanism.jointIndex(name);
    if (joint < 0 && name != kGround) {
      throw SceneError("reactions: the robot has no joint '" + name + "'");
    }
    links.push_back(joint + 1);
  }
  return links;
}

int linkOf(const Mechanism& mechanism, const AppliedWrench& wrench) {
  const int link = mechanism.linkIndex(wrench.link);
  if (link < 0) throw SceneError("applied_wrenches: the robot has no link '" + wrench.link + "'");
  return link;
}

}  // namespace virtual_work_dynamics
