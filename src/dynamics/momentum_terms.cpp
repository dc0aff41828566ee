#include "dynamics/momentum_terms.h"

namespace virtual_work_dynamics {

MomentumTerms::MomentumTerms(const Mechanism& mechanism)
    : links_(mechanism),
      motions_(mechanism.links().size()),
      momentum_(static_cast<Eigen::Index>(mechanism.coordinates().size())),
      gradient_(momentum_.size()) {
  for (const Link& link : mechanism.links()) {
    bodies_.push_back({static_cast<double>(link.mass), link.p_KoCm_K.cast<double>(),
                       link.inertia_Cm_K.cast<double>()});
  }
  for (const Joint& joint : mechanism.joints()) {
    const bool slides = joint.coordinate >= 0 && unitOf(joint) == Unit::kMetre;
    joints_.push_back({joint.parent_link, joint.coordinate, slides, joint.multiplier});
  }
}

void MomentumTerms::compute(const Motion& motion, const Eigen::Vector3d& root_rate) {
  links_.setPosition(motion.q);
  links_.setVelocity(motion.qd);
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const auto link = static_cast<int>(k);
    const Body& body = bodies_[k];
    LinkMotion& own = motions_[k];
    const auto relative = links_.motionAt(link, Eigen::Vector3d::Zero());
    own.w = relative.w + root_rate;
    own.v = relative.v;
    const Eigen::Matrix3d& R = links_.axesOf(link);
    const Eigen::Vector3d centre = links_.originOf(link) + R * body.p_KoCm_K;
    own.P = body.mass * (own.v + own.w.cross(centre));
    own.L = R * (body.inertia_Cm_K * (R.transpose() * own.w)) + centre.cross(own.P);
  }
  momentum_.setZero();
  gradient_.setZero();
  for (std::size_t k = joints_.size(); k-- > 0;) {
    const JointPlace& joint = joints_[k];
    const LinkMotion& own = motions_[k + 1];
    LinkMotion& parent = motions_[static_cast<std::size_t>(joint.parent)];
    parent.P += own.P;
    parent.L += own.L;
    if (joint.coordinate < 0) continue;
    const Eigen::Vector3d axis = joint.multiplier * links_.axisOf(static_cast<int>(k));
    const Eigen::Vector3d& origin = links_.originOf(static_cast<int>(k) + 1);
    if (joint.slides) {
      momentum_[joint.coordinate] += axis.dot(own.P);
      gradient_[joint.coordinate] += own.P.dot(parent.w.cross(axis));
    } else {
      const Eigen::Vector3d slip = origin.cross(axis);  // of the point at the root's origin
      momentum_[joint.coordinate] += axis.dot(own.L) + slip.dot(own.P);
      gradient_[joint.coordinate] +=
          own.L.dot(parent.w.cross(axis)) + own.P.dot(parent.w.cross(slip) + parent.v.cross(axis));
    }
  }
}

}  // namespace virtual_work_dynamics
