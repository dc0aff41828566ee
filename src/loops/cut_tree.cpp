#include "loops/cut_tree.h"

#include <algorithm>

namespace virtual_work_dynamics {

Scene withoutLoops(const Scene& scene) {
  Scene tree = scene;
  tree.closures.clear();
  tree.springs.clear();
  tree.couplings.clear();
  tree.actuated.reset();
  tree.given.reset();
  tree.drives.clear();
  tree.assembly.clear();
  tree.redundancy = {};
  tree.reactions = ReactionSelection::kNone;
  tree.reaction_names.clear();
  const auto ofClosure = [&](const MomentPoint& point) {
    return std::any_of(scene.closures.begin(), scene.closures.end(),
                       [&](const Closure& closure) { return closure.name == point.name; });
  };
  std::vector<MomentPoint>& points = tree.moments_about;
  points.erase(std::remove_if(points.begin(), points.end(), ofClosure), points.end());
  return tree;
}

namespace {

std::vector<std::string> withoutClosures(const Mechanism& mechanism,
                                         const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& name : names) {
    if (!isClosure(mechanism, name)) found.push_back(name);
  }
  return found;
}

}  // namespace

Scene openTreeScene(const Scene& scene, const PointSprings& springs) {
  Scene tree = withoutLoops(scene);
  const std::vector<AppliedWrench> ends = springs.wrenches();
  tree.applied_wrenches.insert(tree.applied_wrenches.end(), ends.begin(), ends.end());
  return tree;
}

Scene wholeReactionsScene(Scene open_tree) {
  open_tree.include_active = true;
  open_tree.moments_about.clear();
  return open_tree;
}

Scene closedTreeScene(const Scene& scene, const PointSprings& springs) {
  Scene tree = openTreeScene(scene, springs);
  for (const Closure& closure : scene.closures) {
    for (const LinkFrame* frame : {&closure.child, &closure.parent}) {
      AppliedWrench wrench;
      wrench.link = frame->link;
      wrench.at = frame->xyz;
      wrench.axes = Axes::kRoot;
      tree.applied_wrenches.push_back(wrench);
    }
  }
  return tree;
}

bool isClosure(const Mechanism& mechanism, const std::string& name) {
  return name != kGround && mechanism.reactionIndex(name) < 0;
}

Request treeRequest(const Mechanism& mechanism, const Request& request) {
  Request tree;
  tree.efforts = request.efforts;
  tree.child_axes_about_origin = request.child_axes_about_origin;
  tree.child_axes = withoutClosures(mechanism, request.child_axes);
  tree.root_axes = withoutClosures(mechanism, request.root_axes);
  return tree;
}

}  // namespace virtual_work_dynamics
