#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "newton_euler_oracle.h"
#include "touching_bodies.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Three ways to forces of some hundred newtons.
constexpr double kTolerance = 1e-10;

constexpr double kRadius = 0.09, kTrack = 0.25;  // half of the latter

// A base with two wheels and an arm of three joints; the base is the root, or slides and turns on
// the ground.
Mechanism mobileArm(bool on_ground) {
  RobotBuilder builder(11);
  const Matrix3l R = Matrix3l::Identity();
  const Vector3l zero = Vector3l::Zero();
  int base = 0;
  if (on_ground) {
    for (const Vector3l& axis : {Vector3l(Vector3l::UnitX()), Vector3l(Vector3l::UnitY())}) {
      base = builder.add(JointType::kPrismatic, base, axis, R, zero);
      builder.removeInertia(base);
    }
    base = builder.add(JointType::kRevolute, base, Vector3l::UnitZ(), R, zero);
  }
  const auto load = [&](int link, double mass, const Vector3l& at, const Vector3l& inertia) {
    builder.link(link).mass = mass;
    builder.link(link).p_KoCm_K = at;
    builder.link(link).inertia_Cm_K = inertia.asDiagonal();
  };
  load(base, 20, {0.05, 0.02, 0.2}, {0.6, 0.7, 0.8});
  for (const double side : {1.0, -1.0}) {
    const int wheel =
        builder.add(JointType::kRevolute, base, Vector3l::UnitY(), R, {0, side * kTrack, kRadius});
    load(wheel, 1.5, zero, {0.004, 0.006, 0.004});
  }
  int arm = builder.add(JointType::kRevolute, base, Vector3l::UnitZ(), R, {0.2, 0.05, 0.5});
  load(arm, 2, {0.01, 0.02, 0.1}, {0.02, 0.03, 0.01});
  arm = builder.add(JointType::kRevolute, arm, Vector3l::UnitY(), R, {0.05, 0, 0.2});
  load(arm, 3, {0.2, 0.01, 0}, {0.01, 0.05, 0.04});
  arm = builder.add(JointType::kPrismatic, arm, Vector3l::UnitX(), R, {0.4, 0, 0});
  load(arm, 1, {0.1, 0, 0.02}, {0.001, 0.01, 0.01});
  return builder.build();
}

Scene onWheels() {
  return sceneOf(R"(
rolling:
  - {name: left, link: link_4, axis: [0, 1, 0], radius: 0.09, normal: false, plane: {link: link_0}}
  - {name: right, link: link_5, axis: [0, 1, 0], radius: 0.09, normal: false, plane: {link: link_0}}
gravity: [0, 0, -9.81]
actuated: [joint_4, joint_5, joint_6, joint_7, joint_8]
)");
}

constexpr double kAngle = 0.7, kSpeed = 0.8, kTurn = 1.1, kGain = -0.6, kTurnGain = 0.9;

Motion onGround() {
  const double s = std::sin(kAngle), c = std::cos(kAngle), r = kRadius, b = kTrack;
  return motionOf({0.3, 0.2, kAngle, 0.5, -0.8, 0.6, -0.4, 0.1},
                  {kSpeed * c, kSpeed * s, kTurn, (kSpeed - b * kTurn) / r,
                   (kSpeed + b * kTurn) / r, 0.5, -1.2, 0.3},
                  {kGain * c - kSpeed * kTurn * s, kGain * s + kSpeed * kTurn * c, kTurnGain,
                   (kGain - b * kTurnGain) / r, (kGain + b * kTurnGain) / r, 2.0, -1.5, 0.7});
}

struct WheelForces {
  double left_torque, right_torque, left, right, lateral;  // lateral: of both together
};

// By the balances of all bodies together, and of each wheel about its axle.
WheelForces closedForm(const Mechanism& mechanism, const Motion& motion) {
  const NewtonEulerOracle bodies(mechanism, sceneOf("gravity: [0, 0, -9.81]"), motion);
  const Vector3l heading = bodies.orientation(3).col(0), left = bodies.orientation(3).col(1);
  Vector3l force = Vector3l::Zero(), moment = Vector3l::Zero();
  for (int link = 1; link < 9; ++link) {
    const auto demand = bodies.demand(link);
    force += demand.force;
    moment += demand.torque + (bodies.centreOfMass(link) - bodies.origin(3)).cross(demand.force);
  }
  const long double sum = force.dot(heading), difference = moment.z() / kTrack;
  WheelForces wheels{};
  wheels.left = static_cast<double>((sum - difference) / 2);
  wheels.right = static_cast<double>((sum + difference) / 2);
  wheels.lateral = static_cast<double>(force.dot(left));
  wheels.left_torque =
      static_cast<double>(bodies.demand(4).torque.dot(left)) + kRadius * wheels.left;
  wheels.right_torque =
      static_cast<double>(bodies.demand(5).torque.dot(left)) + kRadius * wheels.right;
  return wheels;
}

TEST(MobileBase, RollingMatchesTheBalancesOfAllBodies) {
  const Mechanism mechanism = mobileArm(true);
  const Motion motion = onGround();
  const NamedLoopResults results(mechanism, onWheels(), motion);
  EXPECT_LE(violation(results), kTolerance);
  const WheelForces expected = closedForm(mechanism, motion);
  EXPECT_GT(std::abs(expected.lateral), 1);
  const Wrench left = results.childAxes("left"), right = results.childAxes("right");
  EXPECT_NEAR(results.effort("joint_4"), expected.left_torque, kTolerance);
  EXPECT_NEAR(results.effort("joint_5"), expected.right_torque, kTolerance);
  EXPECT_NEAR(left.force.x(), expected.left, kTolerance);
  EXPECT_NEAR(right.force.x(), expected.right, kTolerance);
  EXPECT_NEAR(left.force.y() + right.force.y(), expected.lateral, kTolerance);
  for (const char* wheel : {"left", "right"}) {
    EXPECT_TRUE(results.childAxesDetermined(wheel)[0]) << wheel;
    EXPECT_FALSE(results.childAxesDetermined(wheel)[1]) << wheel;
  }
  for (const bool determined : results.dynamics().effortDetermined()) EXPECT_TRUE(determined);
}

// The base as a root that moves, with the forces on its wheels as if they were measured: the same
// efforts, and nothing is left for the ground to do but to carry the weight.
TEST(MobileBase, MovingRootWithMeasuredContactsFindsTheSame) {
  const Mechanism on_ground = mobileArm(true), base = mobileArm(false);
  const Motion motion = onGround();
  const NamedLoopResults rolling(on_ground, onWheels(), motion);

  Scene scene = sceneOf("root: moving\ngravity: [0, 0, -9.81]");
  const Eigen::Matrix3d R = Eigen::AngleAxisd(kAngle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const std::string name : {"left", "right"}) {
    AppliedWrench wrench;
    wrench.link = name == "left" ? "link_1" : "link_2";
    wrench.axes = Axes::kRoot;
    wrench.force = R.transpose() * rolling.rootAxes(name).force;
    wrench.torque = Eigen::Vector3d(0, 0, -kRadius).cross(wrench.force);
    scene.applied_wrenches.push_back(wrench);
  }
  Motion moving(5);
  moving.q = motion.q.tail<5>();
  moving.qd = motion.qd.tail<5>();
  moving.qdd = motion.qdd.tail<5>();
  moving.root.orientation = Eigen::AngleAxisd(kAngle, Eigen::Vector3d::UnitZ());
  moving.root.angular_velocity = {0, 0, kTurn};
  moving.root.angular_acceleration = {0, 0, kTurnGain};
  moving.root.velocity << motion.qd.head<2>(), 0;
  moving.root.acceleration << motion.qdd.head<2>(), 0;
  Request request;
  request.root_axes = {kGround};
  const Dynamics dynamics(base, scene, request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(moving, workspace);
  const Results& results = workspace.results();
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(results.effort[i], rolling.effort("joint_" + std::to_string(4 + i)), kTolerance)
        << i;
  }
  const Wrench& ground = results.root_axes.at(0);
  EXPECT_NEAR(ground.force.x(), 0, kTolerance);
  EXPECT_NEAR(ground.force.y(), 0, kTolerance);
  EXPECT_NEAR(ground.torque.z(), 0, kTolerance);
  EXPECT_GT(ground.force.z(), 100);
}

}  // namespace
}  // namespace virtual_work_dynamics
