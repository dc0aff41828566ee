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

template <typename Derived>
void copyTo(double* to, const Eigen::MatrixBase<Derived>& from) {
  Eigen::Map<Eigen::Matrix<double, 3, Derived::ColsAtCompileTime>>{to} =
      from.template cast<double>();
}

// The matrices of a turning joint come from Rodrigues' formula.
JointShape shapeOf(const Joint& joint) {
  const auto& axis = joint.axis_K;
  JointShape shape{};
  shape.kind = joint.coordinate < 0            ? JointKind::kFixed
               : unitOf(joint) == Unit::kMetre ? JointKind::kSlides
                                               : JointKind::kTurnsObliquely;
  shape.parent = joint.parent_link;
  shape.coordinate = joint.coordinate;
  shape.angle = -1;
  shape.multiplier = static_cast<double>(joint.multiplier);
  shape.offset = static_cast<double>(joint.offset);
  copyTo(shape.p_PoKo_P, joint.p_PoKo_P);
  copyTo(shape.axis_P, (joint.R_PK * axis));
  copyTo(shape.still, joint.R_PK);
  if (shape.kind != JointKind::kTurnsObliquely) return shape;
  const auto along = (joint.R_PK * axis * axis.transpose()).eval();
  copyTo(shape.still, along);
  copyTo(shape.across, (joint.R_PK - along));
  for (int i = 0; i < 3; ++i) {
    const auto unit = decltype(joint.R_PK)::Identity().col(i).eval();
    copyTo(shape.turned + 3 * i, (joint.R_PK * axis.cross(unit)));
  }
  if (joint.R_PK != decltype(joint.R_PK)::Identity()) return shape;
  for (int i = 0; i < 3; ++i) {
    if (axis[i] != 1 && axis[i] != -1) continue;
    shape.kind = JointKind::kTurnsPlainly;
    shape.axis = i;
    shape.sign = static_cast<double>(axis[i]);
  }
  return shape;
}

}  // namespace

LinkKinematics::LinkKinematics(const Mechanism& mechanism)
    : kernel_(&loopKernelFor(chosenInstructionSet()).one), links_(mechanism.links().size()) {
  for (const Joint& joint : mechanism.joints()) addJoint(joint);
  turns_.resize(2 * (angles_.size() + kMostAngleLanes));
}

void LinkKinematics::addJoint(const Joint& joint) {
  JointShape shape = shapeOf(joint);
  if (shape.kind == JointKind::kTurnsPlainly || shape.kind == JointKind::kTurnsObliquely) {
    shape.angle = static_cast<int>(angles_.size());
    angles_.push_back({shape.coordinate, shape.multiplier, shape.offset});
  }
  joints_.push_back(shape);
}

void LinkKinematics::setPosition(const Eigen::VectorXd& q) {
  kernel_->placeLinks(view(), q.data(), turns_.data(), links_.front().R.data());
}

void LinkKinematics::setVelocity(const Eigen::VectorXd& qd) {
  kernel_->moveLinks(view(), qd.data(), links_.front().R.data());
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
  if (joints_[static_cast<std::size_t>(step.joint)].kind == JointKind::kSlides) {
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
