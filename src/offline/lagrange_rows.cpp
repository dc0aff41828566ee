#include "offline/lagrange_rows.h"

#include <algorithm>
#include <string>

namespace virtual_work_dynamics {
namespace {

// `in_tree` holds those of `names` that the tree has, in the same order.
std::vector<int> placesOf(const std::vector<std::string>& names,
                          const std::vector<std::string>& in_tree) {
  std::vector<int> places;
  int next = 0;
  for (const std::string& name : names) {
    const bool has =
        next < static_cast<int>(in_tree.size()) && in_tree[static_cast<std::size_t>(next)] == name;
    places.push_back(has ? next++ : -1);
  }
  return places;
}

void merge(const std::vector<int>& places, const std::vector<Wrench>& of_tree,
           std::vector<Wrench>& merged) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] >= 0) merged[i] = of_tree[static_cast<std::size_t>(places[i])];
  }
}

}  // namespace

LagrangeRows::LagrangeRows(const Mechanism& mechanism, const Dynamics& dynamics)
    : dynamics_(dynamics),
      lagrange_(mechanism, dynamics.tree(), dynamics.treeRequest()),
      child_places_(placesOf(dynamics.request().child_axes, dynamics.treeRequest().child_axes)),
      root_places_(placesOf(dynamics.request().root_axes, dynamics.treeRequest().root_axes)) {}

const Results& LagrangeRows::compute(const Motion& motion, const Load& load,
                                     const Results& results) {
  dynamics_.getTreeLoad(results, load, load_);
  lagrange_.compute(motion, load_);
  results_ = results;
  if (lagrange_.request().efforts) {
    const Eigen::Index coordinates = lagrange_.coordinates();
    results_.effort.head(coordinates) = lagrange_.effort();
    if (dynamics_.couplings() > 0) {
      results_.effort.head(coordinates) +=
          results.effort.head(coordinates) - results.treeEffort(coordinates);
    }
  }
  merge(child_places_, lagrange_.childAxes(), results_.child_axes);
  merge(root_places_, lagrange_.rootAxes(), results_.root_axes);
  return results_;
}

}  // namespace virtual_work_dynamics
