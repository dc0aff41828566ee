#include "virtual_work_dynamics/scene.h"

#include <string>
#include <unordered_set>

#include "base/printable.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

namespace {

using NameSet = std::unordered_set<std::string>;

// The names of reactions that the scene lists.
NameSet checkedNames(const Mechanism& mechanism, const Scene& scene) {
  NameSet closures, names;
  for (const Closure& closure : scene.closures) closures.insert(closure.name);
  for (std::size_t i = 0; i < scene.reaction_names.size(); ++i) {
    const std::string& name = scene.reaction_names[i];
    if (name != kGround && mechanism.reactionIndex(name) < 0 && closures.count(name) == 0) {
      failAtUnknown(mechanism, scene, name, entryOf("reactions", i));
    }
    if (!names.insert(name).second) {
      throw SceneError(entryOf("reactions", i) + ": " + inQuotes(name) + " is named twice");
    }
  }
  return names;
}

}  // namespace

bool needsClosedLoops(const Scene& scene) {
  return !scene.closures.empty() || !scene.springs.empty() || !scene.couplings.empty() ||
         scene.actuated || scene.given || scene.free_motion || scene.contact_intervals;
}

std::vector<std::string> requestedReactions(const Mechanism& mechanism, const Scene& scene) {
  if (scene.reactions == ReactionSelection::kNone) return {};
  const bool all = scene.reactions == ReactionSelection::kAll;
  const NameSet wanted = all ? NameSet() : checkedNames(mechanism, scene);
  const auto isNamed = [&](const std::string& name) { return wanted.count(name) > 0; };
  std::vector<std::string> names;
  if (!all && isNamed(kGround)) names.emplace_back(kGround);
  for (int k = 0; k < static_cast<int>(mechanism.joints().size()); ++k) {
    if (mechanism.isInnerPart(k)) continue;
    const std::string& name = mechanism.reactionName(k);
    if (all ? mechanism.joint(k).type != JointType::kFixed : isNamed(name)) names.push_back(name);
  }
  for (const Closure& closure : scene.closures) {
    if (all || isNamed(closure.name)) names.push_back(closure.name);
  }
  return names;
}

}  // namespace virtual_work_dynamics
