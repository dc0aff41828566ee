#include "loops/spring_reach.h"

#include <algorithm>
#include <string>

#include "loops/link_kinematics.h"
#include "scene/closure_types.h"
#include "scene/touch_rows.h"

namespace virtual_work_dynamics {

SpringReach::SpringReach(const Mechanism& mechanism, const Scene& scene, const LoopScene& loops,
                         const std::vector<LoopGroup>& groups, const PointSprings& springs,
                         std::size_t spring, const Request& request,
                         const std::vector<std::string>& one_sided) {
  std::vector<bool> joints(mechanism.joints().size()), closures(scene.closures.size());
  std::vector<bool> coordinates(mechanism.coordinates().size());
  std::vector<bool> couplings(scene.couplings.size());
  for (const PathStep& step :
       pathBetween(mechanism, springs.linkA(spring), springs.linkB(spring))) {
    joints[static_cast<std::size_t>(step.joint)] = true;
    const int coordinate = mechanism.joint(step.joint).coordinate;
    if (coordinate >= 0) coordinates[static_cast<std::size_t>(coordinate)] = true;
  }
  for (const LoopGroup& group : groups) {
    const auto reached = [&](int i) { return coordinates[static_cast<std::size_t>(i)]; };
    if (std::none_of(group.coordinates.begin(), group.coordinates.end(), reached)) continue;
    for (const int i : group.coordinates) coordinates[static_cast<std::size_t>(i)] = true;
    for (const std::size_t c : group.closures) closures[c] = true;
    for (std::size_t local = group.closures.size(); local < group.sets.size(); ++local) {
      couplings[group.sets[local] - closures.size()] = true;
    }
    for (const LoopGroup::CrossedJoint& crossed : group.joints) {
      joints[static_cast<std::size_t>(crossed.joint)] = true;
    }
  }
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i]) efforts.push_back(i);
  }
  for (std::size_t i = 0; i < loops.actuated_closures.size(); ++i) {
    if (closures[loops.actuated_closures[i]]) efforts.push_back(coordinates.size() + i);
  }
  const std::size_t first = coordinates.size() + loops.actuated_closures.size();
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    if (couplings[i]) efforts.push_back(first + i);
  }
  const auto add = [&](const std::vector<std::string>& names, std::vector<std::size_t>& items) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const int joint = mechanism.reactionIndex(names[i]);
      bool reached = joint >= 0 && joints[static_cast<std::size_t>(joint)];
      for (std::size_t c = 0; c < closures.size(); ++c) {
        reached = reached || (closures[c] && scene.closures[c].name == names[i]);
      }
      if (reached) items.push_back(i);
    }
  };
  add(request.child_axes, child_axes);
  add(request.root_axes, root_axes);
  for (std::size_t i = 0; i < one_sided.size(); ++i) {
    for (std::size_t c = 0; c < closures.size(); ++c) {
      const Closure& closure = scene.closures[c];
      const bool lifted = traitsOf(closure.type).touches() && conditionCount(closure) == 0;
      if (closures[c] && !lifted && closure.name == one_sided[i]) holds.push_back(i);
    }
  }
}

}  // namespace virtual_work_dynamics
