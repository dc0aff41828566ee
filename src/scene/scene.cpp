#include "virtual_work_dynamics/scene.h"

#include <algorithm>

#include "base/printable.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

namespace {

void checkNames(const Mechanism& mechanism, const Scene& scene) {
  const std::vector<std::string>& names = scene.reaction_names;
  for (auto name = names.begin(); name != names.end(); ++name) {
    const std::string place = entryOf("reactions", static_cast<std::size_t>(name - names.begin()));
    if (*name != kGround && mechanism.jointIndex(*name) < 0 && closureIndex(scene, *name) < 0) {
      failAtUnknown(mechanism, scene, *name, place);
    }
    if (std::find(names.begin(), name, *name) != name) {
      throw SceneError(place + ": " + inQuotes(*name) + " is named twice");
    }
  }
}

}  // namespace

bool needsClosedLoops(const Scene& scene) {
  return !scene.closures.empty() || !scene.springs.empty() || scene.actuated;
}

std::vector<std::string> requestedReactions(const Mechanism& mechanism, const Scene& scene) {
  if (scene.reactions == ReactionSelection::kNone) return {};
  const auto& wanted = scene.reaction_names;
  const bool all = scene.reactions == ReactionSelection::kAll;
  if (!all) checkNames(mechanism, scene);
  const auto isNamed = [&](const std::string& name) {
    return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
  };
  std::vector<std::string> names;
  if (!all && isNamed(kGround)) names.emplace_back(kGround);
  for (const Joint& joint : mechanism.joints()) {
    if (all ? joint.type != JointType::kFixed : isNamed(joint.name)) names.push_back(joint.name);
  }
  for (const Closure& closure : scene.closures) {
    if (all || isNamed(closure.name)) names.push_back(closure.name);
  }
  return names;
}

}  // namespace virtual_work_dynamics
