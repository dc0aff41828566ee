#include "virtual_work_dynamics/scene.h"

#include <algorithm>

#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

namespace {

void checkNames(const Mechanism& mechanism, const std::vector<std::string>& names) {
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (*name != kGround && mechanism.jointIndex(*name) < 0) {
      throw SceneError("reactions: the robot has no joint '" + *name + "'");
    }
    if (std::find(names.begin(), name, *name) != name) {
      throw SceneError("reactions: '" + *name + "' is named twice");
    }
  }
}

}  // namespace

std::vector<std::string> requestedReactions(const Mechanism& mechanism, const Scene& scene) {
  if (scene.reactions == ReactionSelection::kNone) return {};
  const auto& wanted = scene.reaction_names;
  const bool all = scene.reactions == ReactionSelection::kAll;
  if (!all) checkNames(mechanism, wanted);
  const auto isNamed = [&](const std::string& name) {
    return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
  };
  std::vector<std::string> names;
  if (!all && isNamed(kGround)) names.emplace_back(kGround);
  for (const Joint& joint : mechanism.joints()) {
    if (all ? joint.type != JointType::kFixed : isNamed(joint.name)) names.push_back(joint.name);
  }
  return names;
}

}  // namespace virtual_work_dynamics
