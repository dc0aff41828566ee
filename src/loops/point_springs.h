#pragma once

#include <Eigen/Core>
#include <vector>

#include "loops/kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The springs of a scene between points of links.
class PointSprings {
 public:
  /// @throws SceneError naming the spring: unknown link, both ends on one, a value out of range.
  PointSprings(const Mechanism& mechanism, const Scene& scene);

  std::size_t size() const { return springs_.size(); }
  /// Two wrenches for each spring, in root axes, that act at its ends: first on link_a, then on
  /// link_b.
  std::vector<AppliedWrench> wrenches() const;
  /// Force on link_a, in root axes, at the position of `kinematics`; its opposite acts on link_b.
  /// Zero where the ends meet, as a force has no direction there. Does not allocate.
  Eigen::Vector3d force(std::size_t spring, const LoopKinematics& kinematics) const;

 private:
  struct Spring {
    PointSpring scene;
    int link_a, link_b;
  };
  std::vector<Spring> springs_;
};

}  // namespace virtual_work_dynamics
