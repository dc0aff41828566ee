#include "core/input_checks.h"

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

int linkOf(const Mechanism& mechanism, const AppliedWrench& wrench) {
  const int link = mechanism.linkIndex(wrench.link);
  if (link < 0) throw SceneError("applied_wrenches: the robot has no link '" + wrench.link + "'");
  return link;
}

}  // namespace virtual_work_dynamics
