#include "offline/loop_lagrange.h"

#include "loops/cut_tree.h"

namespace virtual_work_dynamics {
namespace {

std::vector<int> placesOf(const Mechanism& mechanism, const std::vector<std::string>& names) {
  std::vector<int> places;
  int next = 0;
  for (const std::string& name : names) places.push_back(isClosure(mechanism, name) ? -1 : next++);
  return places;
}

void merge(const std::vector<int>& places, const std::vector<Wrench>& of_tree,
           const std::vector<Wrench>& of_loops, std::vector<Wrench>& merged) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    merged[i] = places[i] < 0 ? of_loops[i] : of_tree[static_cast<std::size_t>(places[i])];
  }
}

}  // namespace

LoopLagrange::LoopLagrange(const Mechanism& mechanism, const ClosedLoopDynamics& loops)
    : lagrange_(mechanism, loops.tree(), treeRequest(mechanism, loops.request())),
      child_places_(placesOf(mechanism, loops.request().child_axes)),
      root_places_(placesOf(mechanism, loops.request().root_axes)),
      child_axes_(child_places_.size()),
      root_axes_(root_places_.size()) {}

void LoopLagrange::compute(const LoopSample& loops) {
  loops.applyTo(lagrange_);
  lagrange_.compute(loops.motion());
  effort_ = loops.effort();
  if (lagrange_.request().efforts) effort_.head(lagrange_.coordinates()) = lagrange_.effort();
  merge(child_places_, lagrange_.childAxes(), loops.childAxes(), child_axes_);
  merge(root_places_, lagrange_.rootAxes(), loops.rootAxes(), root_axes_);
}

}  // namespace virtual_work_dynamics
