#include "offline/report_columns.h"

#include <Eigen/Geometry>

namespace virtual_work_dynamics {
namespace {

bool turnsAboutZ(ClosureType type) {
  return type == ClosureType::kRevolute || type == ClosureType::kCylindrical ||
         type == ClosureType::kPlanar;
}

// Whether the link hangs on a joint that turns freely, whose orientation is no coordinate.
bool turnsFreely(const Mechanism& mechanism, int link) {
  for (int joint = mechanism.link(link).parent_joint; joint >= 0;
       joint = mechanism.link(mechanism.joint(joint).parent_link).parent_joint) {
    if (mechanism.joint(joint).type == JointType::kOriented) return true;
  }
  return false;
}

// As in a URDF: turns about fixed x, y and z.
Eigen::Matrix3d rotationOf(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

std::string ReportColumns::turningColumn(const Mechanism& mechanism, const Closure& closure) {
  if (!turnsAboutZ(closure.type)) return "";
  for (const std::string& name : {closure.parent.link, closure.child.link}) {
    const int link = mechanism.linkIndex(name);
    if (link < 0 || turnsFreely(mechanism, link)) return "";
  }
  return "turning." + closure.name;
}

ReportColumns::ReportColumns(const Mechanism& mechanism, const Scene& scene)
    : mechanism_(mechanism), names_{"condition"}, links_(mechanism.links().size()) {
  for (const Closure& closure : scene.closures) {
    const std::string column = turningColumn(mechanism, closure);
    if (column.empty()) continue;
    names_.push_back(column);
    turnings_.push_back({mechanism.linkIndex(closure.parent.link),
                         mechanism.linkIndex(closure.child.link),
                         rotationOf(closure.child.rpy) * Eigen::Vector3d::UnitZ()});
  }
}

void ReportColumns::add(const Motion& motion, const Results& results, std::vector<double>& cells) {
  cells.push_back(results.loops.determinacy.condition);
  if (turnings_.empty()) return;
  links_[0] = {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  for (const Joint& joint : mechanism_.joints()) {
    const LinkTurn& parent = links_[static_cast<std::size_t>(joint.parent_link)];
    LinkTurn& child = links_[static_cast<std::size_t>(joint.child_link)];
    child = {parent.R_RK * joint.R_PK.cast<double>(), parent.w_R};
    if (joint.coordinate < 0 || unitOf(joint) != Unit::kRadian) continue;
    const Eigen::Vector3d axis_K = joint.axis_K.cast<double>();
    const double angle = joint.multiplier * motion.q[joint.coordinate] + joint.offset;
    child.R_RK *= Eigen::AngleAxisd(angle, axis_K).toRotationMatrix();
    child.w_R += joint.multiplier * motion.qd[joint.coordinate] * (child.R_RK * axis_K);
  }
  for (const Turning& turning : turnings_) {
    const LinkTurn& child = links_[static_cast<std::size_t>(turning.child)];
    const Eigen::Vector3d w_R = child.w_R - links_[static_cast<std::size_t>(turning.parent)].w_R;
    cells.push_back(w_R.dot(child.R_RK * turning.z_C));
  }
}

}  // namespace virtual_work_dynamics
