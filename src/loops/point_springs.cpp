#include "loops/point_springs.h"

#include <cmath>
#include <set>
#include <string>

#include "base/number_text.h"
#include "base/printable.h"
#include "scene/lookup.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

namespace {

void check(const PointSpring& spring) {
  const std::string what = "springs: " + inQuotes(spring.name);
  if (!(spring.stiffness > 0) || !std::isfinite(spring.stiffness)) {
    throw SceneError(what + ": stiffness = " + numberText(spring.stiffness) +
                     " is not a positive number");
  }
  if (!(spring.rest_length >= 0) || !std::isfinite(spring.rest_length)) {
    throw SceneError(what + ": rest_length = " + numberText(spring.rest_length) +
                     " is neither zero nor a positive number");
  }
  if (!spring.at_a.allFinite() || !spring.at_b.allFinite()) {
    throw SceneError(what + ": an end is not finite");
  }
  if (spring.link_a == spring.link_b) {
    throw SceneError(what + ": both ends are on link " + inQuotes(spring.link_a));
  }
}

}  // namespace

PointSprings::PointSprings(const Mechanism& mechanism, const Scene& scene) {
  std::set<std::string> seen;
  for (const PointSpring& spring : scene.springs) {
    if (!seen.insert(spring.name).second) {
      throw SceneError("springs: " + inQuotes(spring.name) + " is given twice");
    }
    check(spring);
    const std::string place = "springs: " + inQuotes(spring.name) + ": ";
    springs_.push_back({spring, linkNamed(mechanism, spring.link_a, place + "link_a"),
                        linkNamed(mechanism, spring.link_b, place + "link_b")});
  }
}

std::vector<AppliedWrench> PointSprings::wrenches() const {
  std::vector<AppliedWrench> wrenches;
  for (const Spring& spring : springs_) {
    AppliedWrench wrench;
    wrench.axes = Axes::kRoot;
    wrench.link = spring.scene.link_a;
    wrench.at = spring.scene.at_a;
    wrenches.push_back(wrench);
    wrench.link = spring.scene.link_b;
    wrench.at = spring.scene.at_b;
    wrenches.push_back(wrench);
  }
  return wrenches;
}

Eigen::Vector3d PointSprings::force(std::size_t i, const LoopKinematics& kinematics) const {
  const Spring& spring = springs_[i];
  const auto pointOf = [&](int link, const Eigen::Vector3d& at) -> Eigen::Vector3d {
    return kinematics.originOf(link) + kinematics.axesOf(link) * at;
  };
  const Eigen::Vector3d r =
      pointOf(spring.link_b, spring.scene.at_b) - pointOf(spring.link_a, spring.scene.at_a);
  const double length = r.norm();
  if (length == 0) return Eigen::Vector3d::Zero();
  return spring.scene.stiffness * (length - spring.scene.rest_length) / length * r;
}

}  // namespace virtual_work_dynamics
