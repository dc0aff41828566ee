#include "dynamics/description_shares.h"

#include "scene/bare_scene.h"

namespace virtual_work_dynamics {
namespace {

enum class Kind { kMass, kInertia };

// The mechanism in which one link's mass or inertia is alone.
Mechanism alone(const Mechanism& mechanism, std::size_t link, Kind kind) {
  std::vector<Link> links = mechanism.links();
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (i != link || kind != Kind::kMass) links[i].mass = 0;
    if (i != link || kind != Kind::kInertia) links[i].inertia_Cm_K.setZero();
  }
  return Mechanism(mechanism.name(), links, mechanism.joints(), {}, mechanism.compounds());
}

}  // namespace

DescriptionShares::DescriptionShares(const Mechanism& mechanism, const Scene& scene,
                                     const Request& request) {
  const Scene stripped = bareScene(scene);
  const auto add = [&](std::size_t link, Kind kind, double tolerance) {
    if (tolerance == 0) return;
    shares_.push_back({Dynamics(alone(mechanism, link, kind), stripped, request), tolerance});
  };
  for (std::size_t i = 0; i < mechanism.links().size(); ++i) {
    const Link& link = mechanism.links()[i];
    if (link.mass != 0) add(i, Kind::kMass, scene.tolerances.mass);
    if (!link.inertia_Cm_K.isZero(0)) add(i, Kind::kInertia, scene.tolerances.inertia);
  }
}

std::vector<Dynamics::Workspace> DescriptionShares::makeWorkspaces() const {
  std::vector<Dynamics::Workspace> workspaces;
  for (const Share& share : shares_) workspaces.push_back(share.plan.makeWorkspace());
  return workspaces;
}

void DescriptionShares::addVariances(const Motion& motion,
                                     std::vector<Dynamics::Workspace>& workspaces,
                                     std::vector<double>& variances,
                                     std::vector<bool>& known) const {
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    shares_[i].plan.compute(motion, workspaces[i]);
    const Results& results = workspaces[i].results();
    forEachNumber(results, [&](std::size_t number, double value) {
      const double deviation = shares_[i].tolerance * value;
      variances[number] += deviation * deviation;
    });
    // Which results are determined does not depend on masses.
    if (i == 0 && shares_[i].plan.closed()) markKnown(results, known);
  }
}

}  // namespace virtual_work_dynamics
