#include "loops/link_kinematics.h"

namespace virtual_work_dynamics {

namespace {

// Tells for each joint whether it carries the link.
std::vector<bool> carriersOf(const Mechanism& mechanism, int link) {
  std::vector<bool> carries(mechanism.joints().size(), false);
  while (link > 0) {
    carries[static_cast<std::size_t>(link - 1)] = true;
    link = mechanism.joint(link - 1).parent_link;
  }
  return carries;
}

}  // namespace

LinkKinematics::LinkKinematics(const Mechanism& mechanism) : links_(mechanism.links().size()) {
  for (const Joint& joint : mechanism.joints()) {
    joints_.push_back({joint.parent_link, joint.coordinate, unitOf(joint) == Unit::kMetre,
                       joint.multiplier, joint.offset, joint.R_PK.cast<double>(),
                       joint.p_PoKo_P.cast<double>(), joint.axis_K.cast<double>()});
  }
}

void LinkKinematics::setPosition(const Eigen::VectorXd& q) {
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const JointConstants& joint = joints_[k];
    const LinkState& parent = links_[static_cast<std::size_t>(joint.parent_link)];
    LinkState& link = links_[k + 1];
    const double position =
        joint.coordinate < 0 ? 0 : joint.multiplier * q[joint.coordinate] + joint.offset;
    link.R.noalias() = parent.R * joint.R_PK;
    link.z.noalias() = link.R * joint.axis_K;
    link.o = parent.o + parent.R * joint.p_PoKo_P;
    if (joint.slides) {
      link.o += position * link.z;
    } else if (joint.coordinate >= 0) {
      link.R = (link.R * Eigen::AngleAxisd(position, joint.axis_K).toRotationMatrix()).eval();
    }
  }
}

void LinkKinematics::setMotion(const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd) {
  for (std::size_t k = 0; k < joints_.size(); ++k) moveLink(k, qd, qdd);
}

void LinkKinematics::moveLink(std::size_t k, const Eigen::VectorXd& qd,
                              const Eigen::VectorXd& qdd) {
  const JointConstants& joint = joints_[k];
  const LinkState& parent = links_[static_cast<std::size_t>(joint.parent_link)];
  LinkState& link = links_[k + 1];
  const Eigen::Vector3d r = link.o - parent.o;
  link.w = parent.w;
  link.alpha = parent.alpha;
  link.v = parent.v + parent.w.cross(r);                                          // (2.6)
  link.a = parent.a + parent.alpha.cross(r) + parent.w.cross(parent.w.cross(r));  // (2.7)
  if (joint.coordinate < 0) return;
  const Eigen::Vector3d rate = joint.multiplier * qd[joint.coordinate] * link.z;
  const Eigen::Vector3d acceleration = joint.multiplier * qdd[joint.coordinate] * link.z;
  if (joint.slides) {
    link.v += rate;                                     // (2.6)
    link.a += acceleration + 2 * parent.w.cross(rate);  // (2.7)
  } else {
    link.w += rate;                                     // (2.5)
    link.alpha += acceleration + parent.w.cross(rate);  // (2.7)
  }
}

LinkKinematics::Point LinkKinematics::pointOf(const Frame& frame) const {
  const LinkState& link = links_[static_cast<std::size_t>(frame.link)];
  const Eigen::Vector3d r = link.R * frame.p_LoFo_L;
  return {link.o + r, link.v + link.w.cross(r), link.w,
          link.a + link.alpha.cross(r) + link.w.cross(link.w.cross(r)), link.alpha};
}

LinkKinematics::Displacement LinkKinematics::displacementBy(const PathStep& step,
                                                            const Eigen::Vector3d& at,
                                                            double length) const {
  const LinkState& link = links_[static_cast<std::size_t>(step.joint) + 1];
  if (joints_[static_cast<std::size_t>(step.joint)].slides) {
    return {Eigen::Vector3d::Zero(), step.sign * length * link.z};
  }
  return {step.sign * link.z, step.sign * link.z.cross(at - link.o)};
}

double LinkKinematics::workOf(const PathStep& step, const Eigen::Vector3d& at,
                              const ClosureWrench& wrench) const {
  const JointConstants& joint = joints_[static_cast<std::size_t>(step.joint)];
  const LinkState& link = links_[static_cast<std::size_t>(step.joint) + 1];
  const double along = joint.slides ? link.z.dot(wrench.force)
                                    : link.z.dot(wrench.moment + (at - link.o).cross(wrench.force));
  return step.sign * joint.multiplier * along;
}

std::vector<PathStep> pathBetween(const Mechanism& mechanism, int first_link, int second_link) {
  const std::vector<bool> above_first = carriersOf(mechanism, first_link);
  const std::vector<bool> above_second = carriersOf(mechanism, second_link);
  std::vector<PathStep> path;
  for (std::size_t k = 0; k < above_first.size(); ++k) {
    if (above_first[k] == above_second[k]) continue;
    path.push_back({static_cast<int>(k), above_second[k] ? 1.0 : -1.0});
  }
  return path;
}

}  // namespace virtual_work_dynamics
