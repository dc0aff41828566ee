#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "loops/kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The springs and dampers of a scene between points of links.
class PointSprings {
 public:
  /// @throws SceneError naming the spring: unknown link, both ends on one, a value out of range.
  PointSprings(const Mechanism& mechanism, const Scene& scene);

  std::size_t size() const { return springs_.size(); }
  /// Two wrenches for each spring, in root axes, that act at its ends: first on link_a, then on
  /// link_b.
  std::vector<AppliedWrench> wrenches() const;
  /// Force on link_a, in root axes, at the position and motion of `kinematics`; its opposite acts
  /// on link_b. Zero where the ends meet. Does not allocate.
  Eigen::Vector3d force(std::size_t spring, const LoopKinematics& kinematics) const;
  /// Whether the force has a direction, or is zero: not where the ends of a spring meet that is
  /// longer at rest, or those of a damper that move past each other.
  bool directed(std::size_t spring, const LoopKinematics& kinematics) const;
  /// Distance of the ends, m.
  double length(std::size_t spring, const LoopKinematics& kinematics) const;
  /// Whether the force of any depends on velocities.
  bool damped() const;
  const std::string& name(std::size_t spring) const { return springs_[spring].scene.name; }
  int linkA(std::size_t spring) const { return springs_[spring].link_a; }
  int linkB(std::size_t spring) const { return springs_[spring].link_b; }

 private:
  struct Spring {
    PointSpring scene;
    int link_a, link_b;
  };
  Eigen::Vector3d between(const Spring& spring, const LoopKinematics& kinematics) const;
  Eigen::Vector3d rate(const Spring& spring, const LoopKinematics& kinematics) const;
  std::vector<Spring> springs_;
};

}  // namespace virtual_work_dynamics
