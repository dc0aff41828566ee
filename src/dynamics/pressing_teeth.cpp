#include "dynamics/pressing_teeth.h"

#include <algorithm>
#include <set>
#include <string>

#include "scene/closure_types.h"

namespace virtual_work_dynamics {

namespace {

bool presses(const Closure& closure) {
  return traitsOf(closure.type).meshes() && closure.teeth.pressure_angle > 0;
}

// The links from one to the root link, which is not among them.
std::set<int> wayToRoot(const Mechanism& mechanism, const std::string& link) {
  std::set<int> way;
  int i = mechanism.linkIndex(link);
  while (i > 0) {
    way.insert(i);
    i = mechanism.joints()[static_cast<std::size_t>(i - 1)].parent_link;
  }
  return way;
}

bool isReached(const Mechanism& mechanism, const Scene& scene, const std::string& reaction) {
  const int link = mechanism.reactionIndex(reaction) + 1;
  return std::any_of(scene.closures.begin(), scene.closures.end(), [&](const Closure& closure) {
    if (!presses(closure)) return false;
    if (closure.name == reaction) return true;
    return link > 0 && wayToRoot(mechanism, closure.parent.link).count(link) !=
                           wayToRoot(mechanism, closure.child.link).count(link);
  });
}

}  // namespace

bool teethPress(const Scene& scene) {
  return std::any_of(scene.closures.begin(), scene.closures.end(), presses);
}

std::vector<bool> reachedByTeeth(const Mechanism& mechanism, const Scene& scene,
                                 const Request& request, std::size_t efforts) {
  const bool chosen = scene.redundancy.policy != RedundancyPolicy::kMinimumNorm;
  std::vector<bool> reached(efforts, false);
  for (const auto* reactions : {&request.child_axes, &request.root_axes}) {
    for (const std::string& reaction : *reactions) {
      reached.insert(reached.end(), 6, chosen || isReached(mechanism, scene, reaction));
    }
  }
  return reached;
}

}  // namespace virtual_work_dynamics
