#include "newton_euler_oracle.h"

#include <Eigen/Geometry>

namespace virtual_work_dynamics {

NewtonEulerOracle::NewtonEulerOracle(const Mechanism& mechanism, const Scene& scene,
                                     const Motion& motion)
    : mechanism_(mechanism), links_(mechanism.links().size()) {
  if (scene.root_moves) moveRoot(scene, motion.root);
  for (std::size_t k = 0; k < mechanism.joints().size(); ++k) moveLink(k, scene, motion);
  for (std::size_t i = 0; i < links_.size(); ++i) forceOnLink(i, scene);
}

NewtonEulerOracle::RootWrench NewtonEulerOracle::reaction(int joint) const {
  RootWrench sum{Vector3l::Zero(), Vector3l::Zero()};
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!carries(joint, static_cast<int>(i))) continue;
    sum.force += links_[i].force;
    sum.torque += links_[i].moment_c + (links_[i].c - links_[joint + 1].o).cross(links_[i].force);
  }
  const Matrix3l R_0I = links_[0].R.transpose();
  return {R_0I * sum.force, R_0I * sum.torque};
}

NewtonEulerOracle::RootWrench NewtonEulerOracle::childReaction(int joint) const {
  const RootWrench wrench = reaction(joint);
  const Matrix3l R_K0 = links_[joint + 1].R.transpose() * links_[0].R;
  return {R_K0 * wrench.force, R_K0 * wrench.torque};
}

std::vector<long double> NewtonEulerOracle::efforts() const {
  std::vector<long double> efforts(mechanism_.coordinates().size(), 0);
  for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
    const Joint& joint = mechanism_.joints()[k];
    if (joint.coordinate < 0) continue;
    const RootWrench wrench = childReaction(static_cast<int>(k));
    const bool slides = joint.type == JointType::kPrismatic;
    efforts[joint.coordinate] +=
        joint.multiplier * joint.axis_K.dot(slides ? wrench.force : wrench.torque);
  }
  return efforts;
}

void NewtonEulerOracle::moveRoot(const Scene& scene, const RootMotion& motion) {
  State& root = links_[0];
  root.R = motion.orientation.cast<long double>().toRotationMatrix();
  root.o = motion.position.cast<long double>();
  if (scene.static_motion) return;
  root.v = motion.velocity.cast<long double>();
  root.a = motion.acceleration.cast<long double>();
  root.w = motion.angular_velocity.cast<long double>();
  root.alpha = motion.angular_acceleration.cast<long double>();
}

void NewtonEulerOracle::moveLink(std::size_t k, const Scene& scene, const Motion& motion) {
  const Joint& joint = mechanism_.joints()[k];
  const State& parent = links_[joint.parent_link];
  State& link = links_[k + 1];
  long double q = 0, qd = 0, qdd = 0;
  if (joint.coordinate >= 0) {
    q = static_cast<long double>(joint.multiplier) * motion.q[joint.coordinate] + joint.offset;
    if (!scene.static_motion) {
      qd = static_cast<long double>(joint.multiplier) * motion.qd[joint.coordinate];
      qdd = static_cast<long double>(joint.multiplier) * motion.qdd[joint.coordinate];
    }
  }
  const Matrix3l R_joint = parent.R * joint.R_PK;
  const Vector3l axis = R_joint * joint.axis_K;
  const bool slides = joint.type == JointType::kPrismatic;
  const Vector3l r = parent.R * joint.p_PoKo_P + (slides ? q : 0) * axis;
  link.o = parent.o + r;
  link.v = parent.v + parent.w.cross(r);
  link.a = parent.a + parent.alpha.cross(r) + parent.w.cross(parent.w.cross(r));
  link.w = parent.w;
  link.alpha = parent.alpha;
  link.R = R_joint;
  if (slides) {
    link.v += qd * axis;
    link.a += qdd * axis + 2 * parent.w.cross(qd * axis);
  } else if (joint.coordinate >= 0) {
    link.w += qd * axis;
    link.alpha += qdd * axis + parent.w.cross(qd * axis);
    link.R = R_joint * Eigen::AngleAxis<long double>(q, joint.axis_K).toRotationMatrix();
  }
}

void NewtonEulerOracle::forceOnLink(std::size_t i, const Scene& scene) {
  const Link& body = mechanism_.links()[i];
  State& link = links_[i];
  const Vector3l r = link.R * body.p_KoCm_K;
  const Vector3l a_c = link.a + link.alpha.cross(r) + link.w.cross(link.w.cross(r));
  const Matrix3l I = link.R * body.inertia_Cm_K * link.R.transpose();
  link.c = link.o + r;
  link.force = body.mass * (a_c - scene.gravity.cast<long double>());
  link.moment_c = I * link.alpha + link.w.cross(I * link.w);
  for (const Payload& payload : scene.payloads) {
    if (payload.link != body.name) continue;
    const Vector3l p = link.R * payload.at.cast<long double>();
    const Vector3l a = link.a + link.alpha.cross(p) + link.w.cross(link.w.cross(p));
    const Matrix3l I_p = link.R * payload.inertia.cast<long double>() * link.R.transpose();
    const Vector3l force = payload.mass * (a - scene.gravity.cast<long double>());
    link.force += force;
    link.moment_c += I_p * link.alpha + link.w.cross(I_p * link.w) + (p - r).cross(force);
  }
  for (const AppliedWrench& applied : scene.applied_wrenches) {
    if (applied.link != body.name) continue;
    const Matrix3l R = applied.axes == Axes::kLink ? link.R : links_[0].R;
    const Vector3l force = R * applied.force.cast<long double>();
    const Vector3l at = link.o + link.R * applied.at.cast<long double>();
    link.force -= force;
    link.moment_c -= R * applied.torque.cast<long double>() + (at - link.c).cross(force);
  }
}

bool NewtonEulerOracle::carries(int joint, int link) const {
  if (joint < 0) return true;
  while (link > 0) {
    const int parent_joint = mechanism_.links()[link].parent_joint;
    if (parent_joint == joint) return true;
    link = mechanism_.joints()[parent_joint].parent_link;
  }
  return false;
}

}  // namespace virtual_work_dynamics
