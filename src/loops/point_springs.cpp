#include "loops/point_springs.h"

#include <algorithm>
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
  const auto requireAtLeastZero = [&](const char* key, double value) {
    if (value >= 0 && std::isfinite(value)) return;
    throw SceneError(what + ": " + key + " = " + numberText(value) +
                     " is neither zero nor a positive number");
  };
  requireAtLeastZero("stiffness", spring.stiffness);
  requireAtLeastZero("rest_length", spring.rest_length);
  requireAtLeastZero("damping", spring.damping);
  if (spring.stiffness == 0 && spring.damping == 0) {
    throw SceneError(what + ": it has neither stiffness nor damping");
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

// From the end on link_a to that on link_b.
Eigen::Vector3d PointSprings::between(const Spring& spring,
                                      const LoopKinematics& kinematics) const {
  const auto pointOf = [&](int link, const Eigen::Vector3d& at) -> Eigen::Vector3d {
    return kinematics.originOf(link) + kinematics.axesOf(link) * at;
  };
  return pointOf(spring.link_b, spring.scene.at_b) - pointOf(spring.link_a, spring.scene.at_a);
}

// Derivative of between().
Eigen::Vector3d PointSprings::rate(const Spring& spring, const LoopKinematics& kinematics) const {
  const auto velocityOf = [&](int link, const Eigen::Vector3d& at) -> Eigen::Vector3d {
    const LinkKinematics& links = kinematics.links();
    return links.motionAt(link, links.originOf({link, Eigen::Matrix3d::Identity(), at})).v;
  };
  return velocityOf(spring.link_b, spring.scene.at_b) -
         velocityOf(spring.link_a, spring.scene.at_a);
}

Eigen::Vector3d PointSprings::force(std::size_t i, const LoopKinematics& kinematics) const {
  const Spring& spring = springs_[i];
  const Eigen::Vector3d r = between(spring, kinematics);
  // Divided by the largest entry, as squares of short lengths underflow.
  const double largest = r.cwiseAbs().maxCoeff();
  if (largest == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d scaled = r / largest;
  const double norm = scaled.norm();
  const double pull = spring.scene.stiffness * (largest * norm - spring.scene.rest_length);
  if (spring.scene.damping == 0) return pull / norm * scaled;
  const Eigen::Vector3d direction = scaled / norm;
  return (pull + spring.scene.damping * direction.dot(rate(spring, kinematics))) * direction;
}

bool PointSprings::directed(std::size_t i, const LoopKinematics& kinematics) const {
  const Spring& spring = springs_[i];
  if (!between(spring, kinematics).isZero(0)) return true;
  const bool pushes = spring.scene.stiffness > 0 && spring.scene.rest_length > 0;
  return !pushes && (spring.scene.damping == 0 || rate(spring, kinematics).isZero(0));
}

bool PointSprings::damped() const {
  return std::any_of(springs_.begin(), springs_.end(),
                     [](const Spring& spring) { return spring.scene.damping != 0; });
}

double PointSprings::length(std::size_t i, const LoopKinematics& kinematics) const {
  return between(springs_[i], kinematics).stableNorm();
}

}  // namespace virtual_work_dynamics
