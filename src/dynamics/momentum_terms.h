#pragma once

#include <Eigen/Core>
#include <vector>

#include "loops/link_kinematics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// The momenta of the coordinates of a tree, p = dT/dqd, and the gradient of its kinetic energy,
/// dT/dq = 1/2 qd^T (dM/dq) qd, each in one pass outward and one inward, without a mass matrix.
///
/// h_k is the momentum (P_k of its motion, L_k about the root's origin) of all that joint k
/// carries, s_k the screw of the joint. A velocity of the coordinate adds s_k to the motion of what
/// it carries, so p_k = s_k . h_k. A displacement of it turns all that it carries along, which
/// keeps its energy, except that the motion V of the parent link, seen from what is carried,
/// changes by V x s_k: dT/dq_k = h_k . (V x s_k), the motion cross product of Featherstone
/// (2008, 2.9). With a root that turns, V has its angular velocity, and T is the energy in axes
/// that do not turn, which move along with its origin.
class MomentumTerms {
 public:
  explicit MomentumTerms(const Mechanism& mechanism);

  /// Computes both at a position and velocity. Does not allocate.
  /// @param root_rate angular velocity of the root, in its axes, rad/s
  void compute(const Motion& motion, const Eigen::Vector3d& root_rate);

  const Eigen::VectorXd& momentum() const { return momentum_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }

 private:
  struct Body {
    double mass;
    Eigen::Vector3d p_KoCm_K;
    Eigen::Matrix3d inertia_Cm_K;
  };
  struct JointPlace {
    int parent;
    int coordinate;
    bool slides;
    double multiplier;
  };
  struct LinkMotion {
    Eigen::Vector3d w, v;  // v: of the point of the link that is at the root's origin
    Eigen::Vector3d P, L;  // momentum of all that hangs on the link
  };

  LinkKinematics links_;
  std::vector<Body> bodies_;  // by link
  std::vector<JointPlace> joints_;
  std::vector<LinkMotion> motions_;  // by link
  Eigen::VectorXd momentum_, gradient_;
};

}  // namespace virtual_work_dynamics
