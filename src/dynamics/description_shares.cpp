#include "dynamics/description_shares.h"

#include <algorithm>
#include <utility>

#include "dynamics/pressing_teeth.h"
#include "scene/bare_scene.h"

namespace virtual_work_dynamics {
namespace {

enum class Kind { kMass, kInertia };

// The mechanism in which one link's mass or inertia is `factor` of its own, and the others' are
// `others` of theirs.
Mechanism changed(const Mechanism& mechanism, std::size_t link, Kind kind, double factor,
                  double others) {
  std::vector<Link> links = mechanism.links();
  for (std::size_t i = 0; i < links.size(); ++i) {
    links[i].mass *= i == link && kind == Kind::kMass ? factor : others;
    links[i].inertia_Cm_K *= i == link && kind == Kind::kInertia ? factor : others;
  }
  return Mechanism(mechanism.name(), links, mechanism.joints(), {}, mechanism.compounds());
}

double numberAt(const Results& results, std::size_t index) {
  const ResultNumbers numbers(results);
  if (index < numbers.efforts) return results.effort[static_cast<Eigen::Index>(index)];
  index -= numbers.efforts;
  const std::size_t i = index / 6;
  const Wrench& wrench =
      i < numbers.child_axes ? results.child_axes[i] : results.root_axes[i - numbers.child_axes];
  const auto component = static_cast<Eigen::Index>(index % 3);
  return index % 6 < 3 ? wrench.force[component] : wrench.torque[component];
}

bool hasLiveWrenches(const Scene& scene) {
  return std::any_of(scene.applied_wrenches.begin(), scene.applied_wrenches.end(),
                     [](const AppliedWrench& wrench) { return wrench.live; });
}

}  // namespace

DescriptionShares::DescriptionShares(const Mechanism& mechanism, const Scene& scene,
                                     const Request& request) {
  const bool press = teethPress(scene) && scene.tolerances.any();
  Scene own = press ? scene : bareScene(scene);
  own.strict_inertia = false;
  if (press) {
    nominal_.emplace(mechanism, own, request);
    if (hasLiveWrenches(scene))
      unknown_ = reachedByTeeth(mechanism, scene, request, nominal_->effortNames().size());
  }
  const auto add = [&](std::size_t link, Kind kind, double tolerance) {
    if (tolerance == 0) return;
    const double factor = press ? 1 + tolerance : 1, others = press ? 1 : 0;
    shares_.push_back({Dynamics(changed(mechanism, link, kind, factor, others), own, request),
                       press ? 1 : tolerance});
  };
  for (std::size_t i = 0; i < mechanism.links().size(); ++i) {
    const Link& link = mechanism.links()[i];
    if (link.mass != 0) add(i, Kind::kMass, scene.tolerances.mass);
    if (!link.inertia_Cm_K.isZero(0)) add(i, Kind::kInertia, scene.tolerances.inertia);
  }
}

std::vector<Dynamics::Workspace> DescriptionShares::makeWorkspaces() const {
  std::vector<Dynamics::Workspace> workspaces;
  if (nominal_) workspaces.push_back(nominal_->makeWorkspace());
  for (const Share& share : shares_) workspaces.push_back(share.plan.makeWorkspace());
  return workspaces;
}

void DescriptionShares::addVariances(const Motion& motion,
                                     std::vector<Dynamics::Workspace>& workspaces,
                                     std::vector<double>& variances,
                                     std::vector<bool>& known) const {
  const std::size_t first = nominal_ ? 1 : 0;
  if (nominal_) nominal_->compute(motion, workspaces.front());
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    shares_[i].plan.compute(motion, workspaces[first + i]);
    const Results& results = workspaces[first + i].results();
    forEachNumber(results, [&](std::size_t number, double value) {
      if (nominal_) value -= numberAt(workspaces.front().results(), number);
      const double deviation = shares_[i].factor * value;
      variances[number] += deviation * deviation;
    });
    // Which results are determined does not depend on masses.
    if (i == 0 && shares_[i].plan.closed()) markKnown(results, known);
  }
  for (std::size_t number = 0; number < unknown_.size(); ++number) {
    if (unknown_[number]) known[number] = false;
  }
}

}  // namespace virtual_work_dynamics
