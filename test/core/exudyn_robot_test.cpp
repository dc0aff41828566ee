// EXUDYN, TestModels/movingGroundRobotTest.py: a robot of six hinges under a controller, with its
// number for the torques at 0.2 s. What moves it here is inverse dynamics only, which is linear in
// accelerations, so that seven of them tell the motion of given torques.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// The Denavit-Hartenberg frame behind a joint, by angle 0, and what is fixed in it.
struct Segment {
  double d, a, alpha;
  double mass;
  Eigen::Vector3d centre, inertia;
};

const std::vector<Segment>& segments() {
  static const double half = std::acos(-1.0) / 2;
  static const std::vector<Segment> all = {
      {0, 0, half, 20, {0, 0, 0}, {0.18, 0.35, 0.18}},
      {0, 0.4318, 0, 17.4, {-0.3638, 0.006, 0.2275}, {0.13, 0.524, 0.539}},
      {0.15, 0.0203, -half, 4.8, {-0.0203, -0.0141, 0.07}, {0.066, 0.086, 0.02}},
      {0.4318, 0, half, 0.82, {0, 0.019, 0}, {0.0018, 0.0013, 0.0018}},
      {0, 0, -half, 0.34, {0, 0, 0}, {0.0003, 0.0004, 0.0003}},
      {0, 0, 0, 0.09, {0, 0, 0.032}, {0.00015, 0.00015, 4e-5}}};
  return all;
}

Mechanism robot() {
  std::vector<Link> links(1);
  std::vector<Joint> joints;
  links[0].name = "base";
  Matrix3l R = Matrix3l::Identity();
  Vector3l p = Vector3l::Zero();
  for (std::size_t i = 0; i < segments().size(); ++i) {
    const Segment& segment = segments()[i];
    const int index = static_cast<int>(i);
    Joint joint;
    joint.name = "joint_" + std::to_string(i + 1);
    joint.type = JointType::kContinuous;
    joint.parent_link = index;
    joint.child_link = index + 1;
    joint.p_PoKo_P = p;
    joint.R_PK = R;
    joint.axis_K = Vector3l::UnitZ();
    joint.coordinate = index;
    joints.push_back(joint);
    R = Eigen::AngleAxis<long double>(segment.alpha, Vector3l::UnitX()).toRotationMatrix();
    p = {segment.a, 0, segment.d};
    Link link;
    link.name = "link_" + std::to_string(i + 1);
    link.parent_joint = index;
    link.mass = segment.mass;
    link.p_KoCm_K = R * segment.centre.cast<long double>() + p;
    link.inertia_Cm_K = R * segment.inertia.cast<long double>().asDiagonal() * R.transpose();
    links.push_back(link);
  }
  return Mechanism("exudyn", links, joints);
}

class Simulated {
 public:
  Simulated() : mechanism_(robot()) {
    Scene scene;
    scene.gravity = {0, 0, 9.81};  // as published, upwards
    dynamics_ = std::make_unique<Dynamics>(mechanism_, scene, Request());
    workspace_ = std::make_unique<Dynamics::Workspace>(dynamics_->makeWorkspace());
  }

  Vector6 torque(const Vector6& q, const Vector6& qd, const Vector6& qdd) {
    Motion motion(6);
    motion.q = q;
    motion.qd = qd;
    motion.qdd = qdd;
    dynamics_->compute(motion, *workspace_);
    return workspace_->results().effort;
  }
  Vector6 acceleration(const Vector6& q, const Vector6& qd, const Vector6& torques) {
    const Vector6 without = torque(q, qd, Vector6::Zero());
    Matrix6 mass;
    for (int i = 0; i < 6; ++i) mass.col(i) = torque(q, qd, Vector6::Unit(i)) - without;
    return mass.ldlt().solve(torques - without);
  }
  // The controller, with the torques that hold the robot against gravity.
  Vector6 controlled(double t, const Vector6& q, const Vector6& qd) {
    const double pi = std::acos(-1.0), duration = 0.25, left = duration - t;
    Vector6 way, p, d;
    way << 0, pi / 8, pi / 4, 0, pi / 8, 0;
    p << 40000, 40000, 40000, 100, 100, 10;
    d << 400, 400, 100, 1, 1, 0.05;
    const Vector6 a = 4 / (duration * duration) * way;  // half of the time up, half down
    const bool first = t < duration / 2;
    const Vector6 wanted = first ? (a * (t * t / 2)).eval() : (way - a * (left * left / 2)).eval();
    const Vector6 rate = first ? (a * t).eval() : (a * left).eval();
    return torque(q, Vector6::Zero(), Vector6::Zero()) - p.cwiseProduct(q - wanted) -
           d.cwiseProduct(qd - rate);
  }

 private:
  Mechanism mechanism_;
  std::unique_ptr<Dynamics> dynamics_;
  std::unique_ptr<Dynamics::Workspace> workspace_;
};

// The published number depends on the method: torques of the begin of each step of 1 ms, by angles
// and rates before it and the trajectory after it, and the generalized alpha method with a spectral
// radius of 0.5. Its own coordinates are those of six free bodies with constraints. Step by step in
// the same way, but in the six angles, the angles differ by 2e-8 rad, and the sum by 7e-4 of 77 N
// m.
TEST(Exudyn, RobotUnderAControllerTakesItsTorques) {
  Simulated simulated;
  const double rho = 0.5, h = 1e-3;
  const double am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1), gamma = 0.5 - am + af,
               beta = (gamma + 0.5) * (gamma + 0.5) / 4;
  Vector6 q = Vector6::Zero(), qd = q, torques = simulated.controlled(0, q, qd);
  Vector6 acceleration = simulated.acceleration(q, qd, torques), auxiliary = acceleration;
  for (int step = 1; step <= 200; ++step) {
    torques = simulated.controlled(step * h, q, qd);
    Vector6 next = acceleration, next_auxiliary, next_q, next_qd;
    for (int i = 0; i < 20; ++i) {
      next_auxiliary = ((1 - af) * next + af * acceleration - am * auxiliary) / (1 - am);
      next_q = q + h * qd + h * h * ((0.5 - beta) * auxiliary + beta * next_auxiliary);
      next_qd = qd + h * ((1 - gamma) * auxiliary + gamma * next_auxiliary);
      const Vector6 found = simulated.acceleration(next_q, next_qd, torques);
      const double change = (found - next).norm();
      next = found;
      if (change < 1e-10) break;
    }
    q = next_q;
    qd = next_qd;
    acceleration = next;
    auxiliary = next_auxiliary;
  }
  const double published = 76.81798995944785;  // 0.007681798995944785 in units of 1e4 N m
  EXPECT_NEAR(-torques.sum(), published, 1e-5 * published);
  // Printed angles, rad, of nearly the same inertias.
  Vector6 angles;
  angles << -3.19543456e-4, 3.63829923e-1, 7.25569701e-1, 2.42757634e-7, 3.63658987e-1,
      -5.07549126e-8;
  EXPECT_LE((q - angles).lpNorm<Eigen::Infinity>(), 5e-8) << q.transpose();
}

}  // namespace
}  // namespace virtual_work_dynamics
