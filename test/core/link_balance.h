#pragma once

#include <vector>

#include "link_motions.h"
#include "property_check.h"

namespace virtual_work_dynamics {

/// The wrench, in root axes, that all joints together must exert on each link: the rates of change
/// of its momentum and of its angular momentum about its centre of mass, less its weight and the
/// wrenches applied to it. Momenta are written from positions and velocities and differentiated
/// automatically; no acceleration enters.
class LinkBalance {
 public:
  explicit LinkBalance(const Case& made) : made_(made) {
    Motion motion = made.motion;
    if (made.scene.static_motion) {
      motion.qd.setZero();
      motion.qdd.setZero();
    }
    moves_ = linkMotions(made.mechanism, motion);
  }

  Vector3l origin(int link) const { return valueOf(moves_[link].o); }
  Vector3l centre(int link) const { return origin(link) + valueOf(arm(link)); }

  /// The wrench that a link needs, about its centre of mass.
  LongWrench needed(int link) const {
    const LinkMotion<Rated>& move = moves_[link];
    const Link& body = made_.mechanism.links()[link];
    const V3<Rated> v_C = move.v + crossed<Rated>(move.w, arm(link));
    const V3<Rated> w_link = move.R.transpose() * move.w;
    const V3<Rated> spin = constant<Rated>(body.inertia_Cm_K) * w_link;
    const V3<Rated> angular_momentum = move.R * spin;
    LongWrench sum;
    sum.force = body.mass * (rateOf(v_C) - made_.scene.gravity.cast<long double>());
    sum.torque = rateOf(angular_momentum);
    for (const AppliedWrench& applied : made_.scene.applied_wrenches) {
      if (applied.link == body.name) sum = sum - appliedTo(link, applied);
    }
    return sum;
  }

  /// The wrench that the joints exert on a link by the published reactions: that of the joint which
  /// carries the link, less those of the joints that it carries.
  LongWrench published(int link, const Outcome& outcome) const {
    const std::vector<Joint>& joints = made_.mechanism.joints();
    const std::string own = link == 0 ? std::string(kGround) : joints[link - 1].name;
    LongWrench sum = outcome.root(own).about(centre(link) - origin(link));
    for (const Joint& joint : joints) {
      if (joint.parent_link != link) continue;
      sum = sum - outcome.root(joint.name).about(centre(link) - origin(joint.child_link));
    }
    return sum;
  }

 private:
  V3<Rated> arm(int link) const {
    return moves_[link].R * constant<Rated>(made_.mechanism.links()[link].p_KoCm_K);
  }

  LongWrench appliedTo(int link, const AppliedWrench& applied) const {
    Matrix3l R;
    for (int i = 0; i < 3; ++i) R.col(i) = valueOf(moves_[link].R.col(i));
    const Vector3l at = origin(link) + R * applied.at.cast<long double>();
    LongWrench wrench{applied.force.cast<long double>(), applied.torque.cast<long double>(), 0, 0};
    if (applied.axes == Axes::kLink) wrench = wrench.turned(R);
    return wrench.about(centre(link) - at);
  }

  const Case& made_;
  std::vector<LinkMotion<Rated>> moves_;
};

}  // namespace virtual_work_dynamics
