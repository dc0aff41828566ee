#pragma once

#include <string>
#include <vector>

#include "loop_geometry.h"
#include "newton_euler_oracle.h"
#include "random_cases.h"

namespace virtual_work_dynamics {

/// A random point for the moment of each joint and closure: fixed on its parent frame, its child
/// frame or any link.
inline std::vector<MomentPoint> randomMomentPoints(RandomCases& random, const Mechanism& mechanism,
                                                   const Scene& scene) {
  std::vector<MomentPoint> points;
  const auto add = [&](const std::string& name) {
    MomentPoint point;
    point.name = name;
    const int kind = random.pick(4);
    if (kind == 0) point.frame = JointFrame::kParent;
    if (kind > 1) {
      const auto links = static_cast<int>(mechanism.links().size());
      point.link = mechanism.link(random.pick(links)).name;
    }
    if (random.chance(0.8)) point.at = random.doubles(0.6);
    points.push_back(point);
  };
  for (const Joint& joint : mechanism.joints()) add(joint.name);
  for (const Closure& closure : scene.closures) add(closure.name);
  return points;
}

/// Where the point of a moment is, in root axes.
inline Vector3l placeOf(const Mechanism& mechanism, const Scene& scene,
                        const NewtonEulerOracle& bodies, const MomentPoint& point) {
  const Vector3l at = point.at.cast<long double>();
  const auto onLink = [&](int link, const Vector3l& p) {
    return Vector3l(bodies.origin(link) + bodies.orientation(link) * p);
  };
  if (point.link) return onLink(mechanism.linkIndex(*point.link), at);
  const bool parent = point.frame == JointFrame::kParent;
  const int k = mechanism.jointIndex(point.name);
  if (k >= 0) {
    const Joint& joint = mechanism.joint(k);
    return parent ? onLink(joint.parent_link, joint.p_PoKo_P + joint.R_PK * at)
                  : onLink(joint.child_link, at);
  }
  for (const Closure& closure : scene.closures) {
    if (closure.name != point.name) continue;
    const PlacedFrame frame(mechanism, bodies, parent ? closure.parent : closure.child);
    return frame.o + frame.R * at;
  }
  return Vector3l::Constant(NAN);
}

}  // namespace virtual_work_dynamics
