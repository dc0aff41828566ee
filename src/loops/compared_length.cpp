#include "loops/compared_length.h"

#include <algorithm>
#include <cmath>

namespace virtual_work_dynamics {

namespace {

// What couplings without closures compare moments over, m: how far apart the joints are that they
// tie, how large the links are that these move, or what factors say that slides are worth in turns,
// whichever is most. None depends on where the robot stands.
double lengthOfCoupled(const Mechanism& mechanism, const std::vector<ResolvedCoupling>& couplings,
                       const LoopKinematics& kinematics) {
  double longest = 0;
  std::vector<Eigen::Vector3d> origins;
  for (const ResolvedCoupling& coupling : couplings) {
    double turns = 0, slides = 0;
    for (const ResolvedCoupling::Term& term : coupling.terms) {
      double& largest = mechanism.unitOf(term.coordinate) == Unit::kMetre ? slides : turns;
      largest = std::max(largest, std::abs(term.factor));
      const int link = mechanism.coordinates()[static_cast<std::size_t>(term.coordinate)] + 1;
      origins.push_back(kinematics.originOf(link));
      const Link& moved = mechanism.links()[static_cast<std::size_t>(link)];
      if (!(moved.mass > 0)) continue;
      const double gyration = moved.inertia_Cm_K.trace() / (2 * moved.mass);
      if (std::isfinite(gyration)) longest = std::max(longest, std::sqrt(std::max(0.0, gyration)));
    }
    if (turns > 0 && slides > 0) longest = std::max(longest, turns / slides);
  }
  for (const Eigen::Vector3d& a : origins) {
    for (const Eigen::Vector3d& b : origins) longest = std::max(longest, (a - b).norm());
  }
  return longest > 0 ? longest : 1;
}

}  // namespace

double comparedLength(const Mechanism& mechanism, const std::vector<ResolvedCoupling>& couplings,
                      const std::vector<LoopGroup>& groups, const LoopKinematics& kinematics) {
  if (kinematics.closures() > 0) return loopLength(groups, kinematics);
  return lengthOfCoupled(mechanism, couplings, kinematics);
}

}  // namespace virtual_work_dynamics
