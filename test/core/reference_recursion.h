#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A body of the recursion as the paper has it: vectors are components in its own frame, except for
/// r in its parent's, and f and m in the fixed axes.
struct ReferenceBody {
  Eigen::Matrix3d a = Eigen::Matrix3d::Identity(), a_0 = a;  // a_{k,k-1} and a_{k0}
  Eigen::Vector3d r = Eigen::Vector3d::Zero();               // r_{k,k-1}: contains the slide
  Eigen::Vector3d w = r, v = r, eps = r, gamma = r;          // absolute; v and gamma of O_k
  Eigen::Vector3d F = r, M = r, f = r, m = r;  // of the parent on the body, moments about O_k
};

/// Root to leaves: poses and motions. Body 0 is the root link, body k + 1 hangs on joint k.
inline std::vector<ReferenceBody> referenceMotion(const Mechanism& mechanism,
                                                  const Motion& motion) {
  using Eigen::Vector3d;
  std::vector<ReferenceBody> bodies(mechanism.links().size());
  for (std::size_t k = 1; k < bodies.size(); ++k) {
    const Joint& joint = mechanism.joints()[k - 1];
    const ReferenceBody& p = bodies[joint.parent_link];
    ReferenceBody& b = bodies[k];
    Vector3d x = Vector3d::Zero();  // position, velocity and acceleration of the joint
    if (const int i = joint.coordinate; i >= 0) {
      x = joint.multiplier * Vector3d(motion.q[i], motion.qd[i], motion.qdd[i]);
      x[0] += joint.offset;
    }
    const Vector3d slide = joint.type == JointType::kPrismatic ? x : Vector3d::Zero();
    const Vector3d turn = x - slide;
    const Eigen::Matrix3d R_PK = joint.R_PK.cast<double>();
    const Vector3d u3 = joint.axis_K.cast<double>();
    b.a = (R_PK * Eigen::AngleAxisd(turn[0], u3).toRotationMatrix()).transpose();
    b.a_0 = b.a * p.a_0;
    b.r = joint.p_PoKo_P.cast<double>() + R_PK * u3 * slide[0];
    const Vector3d w_x_u3 = (b.a * p.w).cross(u3);          // a w~ a^T u3
    b.w = b.a * p.w + turn[1] * u3;                         // (2.5)
    b.v = b.a * (p.v + p.w.cross(b.r)) + slide[1] * u3;     // (2.6)
    b.eps = b.a * p.eps + turn[2] * u3 + turn[1] * w_x_u3;  // (2.7), first line
    const Vector3d U_r = p.w.cross(p.w.cross(b.r)) + p.eps.cross(b.r);
    // Departs from (2.7): the print has a second a_{k,k-1} before U_r; see doc/theory.md.
    b.gamma = b.a * (p.gamma + U_r) + 2 * slide[1] * w_x_u3 + slide[2] * u3;
  }
  return bodies;
}

/// Leaves to root: the wrench at each joint, for bodies in motion, and the effort of each
/// coordinate. Of the scene, gravity and applied wrenches count.
inline Eigen::VectorXd referenceForces(const Mechanism& mechanism, const Scene& scene,
                                       std::vector<ReferenceBody>& bodies) {
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  Eigen::VectorXd effort = Eigen::VectorXd::Zero(mechanism.coordinates().size());
  for (std::size_t k = bodies.size(); k-- > 0;) {
    ReferenceBody& b = bodies[k];
    const Link& link = mechanism.links()[k];
    const double mass = static_cast<double>(link.mass);
    const Vector3d c = link.p_KoCm_K.cast<double>();  // r_k^C
    const Matrix3d steiner = mass * (c.dot(c) * Matrix3d::Identity() - c * c.transpose());
    const Matrix3d J = link.inertia_Cm_K.cast<double>() + steiner;  // about O_k
    Vector3d f_applied = mass * (b.a_0 * scene.gravity);            // (3.6), any direction
    Vector3d m_applied = c.cross(f_applied);
    for (const AppliedWrench& applied : scene.applied_wrenches) {
      if (applied.link != link.name) continue;
      const Matrix3d R = applied.axes == Axes::kRoot ? b.a_0 : Matrix3d(Matrix3d::Identity());
      f_applied += R * applied.force;
      m_applied += R * applied.torque + applied.at.cross(R * applied.force);
    }
    const Vector3d U_c = b.w.cross(b.w.cross(c)) + b.eps.cross(c);
    const Vector3d f_in = -mass * (b.gamma + U_c);  // (3.5)
    const Vector3d m_in = -(mass * c.cross(b.gamma) + J * b.eps + b.w.cross(J * b.w));
    b.F += -f_applied - f_in;  // (3.8); its children have added theirs before
    b.M += -m_applied - m_in;
    b.f = b.a_0.transpose() * b.F;  // (4.3)
    b.m = b.a_0.transpose() * b.M;
    if (k == 0) break;  // what ground exerts on the root link
    const Joint& joint = mechanism.joints()[k - 1];
    ReferenceBody& p = bodies[joint.parent_link];
    p.F += b.a.transpose() * b.F;  // (3.8), a sum over all children of p
    p.M += b.a.transpose() * b.M + b.r.cross(b.a.transpose() * b.F);
    if (joint.coordinate < 0) continue;
    const Vector3d& along = joint.type == JointType::kPrismatic ? b.F : b.M;
    const double active = joint.axis_K.cast<double>().dot(along);  // (3.7): u3^T F or u3^T M
    effort[joint.coordinate] += joint.multiplier * active;
  }
  return effort;
}

}  // namespace virtual_work_dynamics
