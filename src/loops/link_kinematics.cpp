#include "loops/link_kinematics.h"

#include <cmath>

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

// The matrices of a turning joint come from Rodrigues' formula.
LinkKinematics::JointConstants LinkKinematics::constantsOf(const Joint& joint) {
  const auto& axis = joint.axis_K;
  JointConstants constants;
  constants.parent_link = joint.parent_link;
  constants.coordinate = joint.coordinate;
  constants.slides = virtual_work_dynamics::unitOf(joint) == Unit::kMetre;
  constants.multiplier = static_cast<double>(joint.multiplier);
  constants.offset = static_cast<double>(joint.offset);
  constants.p_PoKo_P = joint.p_PoKo_P.cast<double>();
  constants.axis_P = (joint.R_PK * axis).cast<double>();
  constants.still = joint.R_PK.cast<double>();
  constants.across = constants.turned = Eigen::Matrix3d::Zero();
  if (constants.slides || joint.coordinate < 0) return constants;
  const auto along = (joint.R_PK * axis * axis.transpose()).eval();
  constants.still = along.cast<double>();
  constants.across = (joint.R_PK - along).cast<double>();
  for (int i = 0; i < 3; ++i) {
    const auto unit = decltype(joint.R_PK)::Identity().col(i).eval();
    constants.turned.col(i) = (joint.R_PK * axis.cross(unit)).cast<double>();
  }
  return constants;
}

LinkKinematics::LinkKinematics(const Mechanism& mechanism) : links_(mechanism.links().size()) {
  for (const Joint& joint : mechanism.joints()) {
    if (joint.type == JointType::kOriented) {
      oriented_.push_back({joints_.size(), joint.R_PK.cast<double>()});
    }
    joints_.push_back(constantsOf(joint));
  }
}

bool LinkKinematics::setOrientations(const std::vector<Eigen::Quaterniond>& orientations) {
  bool changes = false;
  for (std::size_t i = 0; i < oriented_.size(); ++i) {
    Oriented& own = oriented_[i];
    const Eigen::Quaterniond next =
        orientations.empty() ? Eigen::Quaterniond::Identity() : orientations[i];
    if (own.orientation.coeffs() == next.coeffs()) continue;
    own.orientation = next;
    joints_[own.joint].still.noalias() = own.R_PK * next.toRotationMatrix();
    changes = true;
  }
  return changes;
}

void LinkKinematics::setPosition(const Eigen::VectorXd& q) {
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const JointConstants& joint = joints_[k];
    const LinkState& parent = links_[static_cast<std::size_t>(joint.parent_link)];
    LinkState& link = links_[k + 1];
    link.o = parent.o + parent.R * joint.p_PoKo_P;
    link.z.noalias() = parent.R * joint.axis_P;
    if (joint.coordinate < 0) {
      link.R.noalias() = parent.R * joint.still;
      continue;
    }
    const double position = joint.multiplier * q[joint.coordinate] + joint.offset;
    if (joint.slides) {
      link.R.noalias() = parent.R * joint.still;
      link.o += position * link.z;
    } else {
      const Eigen::Matrix3d R_PL =
          joint.still + std::cos(position) * joint.across + std::sin(position) * joint.turned;
      link.R.noalias() = parent.R * R_PL;
    }
  }
}

void LinkKinematics::setVelocity(const Eigen::VectorXd& qd) {
  for (std::size_t k = 0; k < joints_.size(); ++k) moveLink(k, qd);
}

void LinkKinematics::moveLink(std::size_t k, const Eigen::VectorXd& qd) {
  const JointConstants& joint = joints_[k];
  const LinkState& parent = links_[static_cast<std::size_t>(joint.parent_link)];
  LinkState& link = links_[k + 1];
  const Eigen::Vector3d r = link.o - parent.o, turned = parent.w.cross(r);
  link.w = parent.w;
  link.alpha = parent.alpha;
  link.v = parent.v + turned;                                          // (2.6)
  link.a = parent.a + parent.alpha.cross(r) + parent.w.cross(turned);  // (2.7)
  if (joint.coordinate < 0) return;
  const Eigen::Vector3d rate = joint.multiplier * qd[joint.coordinate] * link.z;
  if (joint.slides) {
    link.v += rate;                      // (2.6)
    link.a += 2 * parent.w.cross(rate);  // (2.7)
  } else {
    link.w += rate;                      // (2.5)
    link.alpha += parent.w.cross(rate);  // (2.7)
  }
}

LinkKinematics::PointMotion LinkKinematics::motionAt(int link, const Eigen::Vector3d& point) const {
  const LinkState& state = links_[static_cast<std::size_t>(link)];
  const Eigen::Vector3d r = point - state.o, turned = state.w.cross(r);
  return {state.v + turned, state.w, state.a + state.alpha.cross(r) + state.w.cross(turned),
          state.alpha};
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
