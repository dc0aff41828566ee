#include "scene/input_checks.h"

#include <cmath>
#include <set>
#include <string>

#include "base/number_text.h"
#include "base/printable.h"
#include "scene/joint_type_checks.h"
#include "scene/lookup.h"
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

void requireOrientations(const Motion& motion, std::size_t count) {
  constexpr double kOff = 1e-6;
  if (motion.orientations.empty()) return;
  if (motion.orientations.size() != count) {
    throw MotionError("motion: it has " + std::to_string(motion.orientations.size()) +
                      " orientations, the mechanism has " + std::to_string(count) +
                      " joints that turn freely");
  }
  for (const Eigen::Quaterniond& orientation : motion.orientations) {
    if (std::abs(orientation.squaredNorm() - 1) <= 2 * kOff) continue;
    throw MotionError("motion: an orientation has the length " + numberText(orientation.norm()) +
                      ", not 1");
  }
}

void requireRoots(const MotionTable& table, std::size_t rows) {
  if (table.roots.size() >= rows) return;
  throw MotionError("motion: the root moves, and " + std::to_string(table.roots.size()) +
                    " of its motions are given; needed are " + std::to_string(rows));
}

void requireOrientations(const MotionTable& table, std::size_t rows, std::size_t count) {
  const Eigen::MatrixXd& all = table.orientations;
  const bool fits = static_cast<std::size_t>(all.rows()) >= rows &&
                    static_cast<std::size_t>(all.cols()) == 4 * count;
  if (all.size() == 0 || fits) return;
  throw MotionError("motion: orientations are " + std::to_string(all.rows()) + " x " +
                    std::to_string(all.cols()) + ", needed are " + std::to_string(rows) + " x " +
                    std::to_string(4 * count));
}

void requireLoad(const Load& load, std::size_t applied) {
  if (load.wrenches.size() == applied) return;
  throw SceneError("load: it has " + std::to_string(load.wrenches.size()) +
                   " wrenches, the scene has " + std::to_string(applied) + " applied wrenches");
}

const Scene& openChain(const Scene& scene) {
  if (!scene.closures.empty()) {
    throw SceneError("closures: " + inQuotes(scene.closures[0].name) +
                     ": an open chain has no closures");
  }
  if (!scene.springs.empty()) {
    throw SceneError("springs: " + inQuotes(scene.springs[0].name) +
                     ": an open chain has no springs between points");
  }
  if (!scene.couplings.empty()) {
    throw SceneError("couplings: " + inQuotes(scene.couplings[0].name) +
                     ": an open chain has no couplings");
  }
  if (scene.actuated) {
    throw SceneError("actuated: every joint of an open chain carries effort");
  }
  return scene;
}

void requireSoundDescription(const Mechanism& mechanism, const Scene& scene) {
  requireJointTypes(mechanism, scene);
  if (scene.transmissions != TransmissionSelection::kNone) {
    throw SceneError(
        "urdf_transmissions: they are not in this mechanism, withTransmissions() makes it so");
  }
  if (!scene.strict_inertia) return;
  for (const Doubt& doubt : mechanism.doubts()) {
    if (doubt.about_inertia) throw SceneError("strict_inertia: " + doubt.text);
  }
}

std::vector<int> linksOf(const Mechanism& mechanism, const std::vector<std::string>& reactions) {
  std::vector<int> links;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < reactions.size(); ++i) {
    const std::string& name = reactions[i];
    const std::string place = entryOf("reactions", i);
    if (!seen.insert(name).second)
      throw SceneError(place + ": " + inQuotes(name) + " is named twice");
    links.push_back(name == kGround ? 0 : reactionNamed(mechanism, name, place) + 1);
  }
  return links;
}

void requireWrenchNames(const Scene& scene) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < scene.applied_wrenches.size(); ++i) {
    const AppliedWrench& wrench = scene.applied_wrenches[i];
    const std::string place = entryOf("applied_wrenches", i);
    if (wrench.live && wrench.name.empty()) {
      throw SceneError(place + ": a live wrench needs a name");
    }
    if (wrench.invert && !wrench.live) {
      throw SceneError(place + ": invert: only a live wrench is inverted");
    }
    if (!wrench.name.empty() && !seen.insert(wrench.name).second) {
      throw SceneError(place + ".name: " + inQuotes(wrench.name) + " is given twice");
    }
  }
}

int linkOf(const Mechanism& mechanism, const Scene& scene, std::size_t index) {
  return linkNamed(mechanism, scene.applied_wrenches[index].link,
                   entryOf("applied_wrenches", index) + ".link");
}

}  // namespace virtual_work_dynamics
