// Couplings, drives and contacts against numbers that the tests of other programs have.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "published_model.h"
#include "virtual_work_dynamics/drives.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms of a few operations, of numbers of about 1.
constexpr double kFewOperations = 1e-14;

std::optional<std::size_t> drivenAt(PublishedModel& model, double t) {
  Drives drives(model.mechanism, model.scene);
  Motion driven(0);
  return drives.evaluate(t, model.dynamics.given(), model.motion, driven);
}

// Project Chrono, utest_MCORE_rotmotors.cpp: a body whose motor's angle grows by 0.5 or -0.5 rad/s
// from 0.1 to 2 s, held to 1e-6 rad/s there. Its weight is along the axis.
TEST(PublishedConditions, MotorsKeepTheirSpeedAsInChrono) {
  for (const double speed : {0.5, -0.5}) {
    PublishedModel model("<link name='ground_link'/>" + planarLink("body", 1, 0, 1) +
                             planarJoint("continuous", "ground_link", "body", "0 0 1"),
                         "{drives: [{name: body, law: polynomial, coefficients: [0, " +
                             std::to_string(speed) + "]}]}");
    for (const double t : {0.1, 0.7, 2.0}) {
      ASSERT_FALSE(drivenAt(model, t));
      model.compute();
      EXPECT_EQ(model.motion.qd[0], speed);
      EXPECT_NEAR(model.motion.q[0], speed * t, kFewOperations);
      EXPECT_EQ(model.effort("body"), 0);
      EXPECT_NEAR(model.reaction("body").force.z(), 9.81, 10 * kFewOperations);
    }
  }
}

// Simbody, TestConstraints.cpp: ten bodies of 1 kg, each on three hinges that meet in a point. The
// first body's second hinge turns at 0.8 rad/s (ConstantSpeed); or the last body's origin is held
// at the first one's, the second body's hinge accelerates by 0.01 rad/s^2 and the fifth one's
// turns at 0.1 rad/s (ConstantAcceleration). Conditions hold to 1e-10 there, and to roundings of
// the problem's size.
TEST(PublishedConditions, SpeedsAndAccelerationsOfSimbody) {
  std::string urdf = "<link name='z0'/>", actuated, start;
  int i = 0;
  for (int body = 1; body <= 10; ++body) {
    const std::string number = std::to_string(body);
    const std::string before = "z" + std::to_string(body - 1);
    urdf += planarLink("x" + number, 0, 0, 0) + planarLink("y" + number, 0, 0, 0) +
            planarLink("z" + number, 1, -0.5, 1) +
            // Bodies' frames here are at their hinges, half a metre before their centres.
            planarJoint("continuous", before, "x" + number, "1 0 0", body == 1 ? 0 : -0.5) +
            planarJoint("continuous", "x" + number, "y" + number, "0 1 0") +
            planarJoint("continuous", "y" + number, "z" + number, "0 0 1");
    for (const std::string axis : {"x", "y", "z"}) {
      const std::string name = axis + number;
      start += (i ? ", {name: " : "{name: ") + name + ", position: " +
               std::to_string((axis == "z" ? 2 * M_PI / 9 : 0) + 0.1 * std::sin(7.0 * i)) + "}";
      if (name != "z3" && name != "z6" && name != "y8") actuated += (i ? ", " : "") + name;
      ++i;
    }
  }
  const auto law = [](const std::string& name, double rate, double half) {
    return "{name: " + name + ", law: polynomial, coefficients: [0, " + std::to_string(rate) +
           ", " + std::to_string(half) + "]}";
  };
  const std::string rest = ", gravity: [0, 0, 0], assembly: [" + start + "]}";
  PublishedModel steady(urdf, "{drives: [" + law("y1", 0.8, 0) + "]" + rest);
  PublishedModel ball(urdf, "{drives: [" + law("y2", 0.3, 0.005) + ", " + law("y5", 0.1, 0) +
                                "], actuated: [" + actuated +
                                "], closures: [{name: ball, type: spherical, parent: {link: z1, "
                                "xyz: [-0.5, 0, 0]}, child: {link: z10, xyz: [-0.5, 0, 0]}}]" +
                                rest);
  for (PublishedModel* model : {&steady, &ball}) {
    for (int k = 0; k < 30; ++k) {
      model->motion.qd[k] = std::sin(1.0 + k);
      model->motion.qdd[k] = std::cos(1.0 + 2 * k);
    }
    ASSERT_FALSE(drivenAt(*model, 0.25));
    ASSERT_TRUE(model->complete());
    model->compute();
    EXPECT_TRUE(model->workspace.results().finite());
  }
  const Eigen::Index y1 = steady.coordinate("y1"), y2 = ball.coordinate("y2"),
                     y5 = ball.coordinate("y5");
  EXPECT_NEAR(steady.motion.qd[y1], 0.8, kFewOperations);
  EXPECT_EQ(steady.motion.qdd[y1], 0);
  EXPECT_NEAR(ball.motion.qdd[y2], 0.01, kFewOperations);
  EXPECT_NEAR(ball.motion.qd[y5], 0.1, kFewOperations);
  EXPECT_EQ(ball.motion.qdd[y5], 0);
  const ClosureResidual& held = ball.workspace.results().loops.residuals[0];
  EXPECT_LE(std::abs(held.position), 1e-10);
  EXPECT_LE(std::abs(held.velocity), 1e-10);
  EXPECT_LE(std::abs(held.acceleration), 30 * 30 * 2.2e-16);
}

// gz-physics, joint_mimic_features.cc, UniversalMimicTest and PendulumMimicTest: both axes of a
// cross follow those of another one, and pendulums follow, by multiplier, offset and reference.
TEST(PublishedConditions, CrossesFollowAsInGzPhysics) {
  constexpr std::array<std::array<double, 3>, 8> kRows{{{1, 0, 0},
                                                        {-1, 0, 0},
                                                        {1, 0.1, 0},
                                                        {1, 0.2, 0.1},
                                                        {-1, 0.2, 0},
                                                        {-2, 0, 0},
                                                        {2, 0.1, 0},
                                                        {2, 0.3, -0.1}}};
  const std::string urdf = "<link name='ground_link'/>" + planarLink("j1", 1, 0.2, 0.1) +
                           planarLink("j2", 2, 0.3, 0.2) +
                           planarJoint("continuous", "ground_link", "j1", "1 0 0") +
                           planarJoint("continuous", "ground_link", "j2", "1 0 0", 0, 1);
  for (const auto [multiplier, offset, reference] : kRows) {
    std::ostringstream scene;
    scene << "{joint_types: [{name: j1, type: universal, axis: [1, 0, 0], axis2: [0, 1, 0]}, "
             "{name: j2, type: universal, axis: [1, 0, 0], axis2: [0, 1, 0]}], actuated: "
             "[j1.angle1, j1.angle2], couplings: [";
    for (const int i : {1, 2}) {
      scene << (i == 1 ? "" : ", ") << "{name: axis_" << i
            << ", offset: " << offset - multiplier * reference << ", terms: [{name: j2.angle" << i
            << ", factor: 1}, {name: j1.angle" << i << ", factor: " << -multiplier << "}]}";
    }
    PublishedModel model(urdf, scene.str() + "]}");
    for (const double angle : {-0.4, 0.0, 0.3}) {
      model.motion.q.setZero();
      model.motion.q.head<2>() << angle, 0.5 - angle;
      ASSERT_TRUE(model.complete());
      for (const int i : {0, 1}) {
        EXPECT_NEAR(model.motion.q[2 + i], multiplier * (model.motion.q[i] - reference) + offset,
                    kFewOperations);
      }
    }
  }
}

// Drake, sap_coupler_constraint_test.cc: q_0 = 1.2 q_1 + 0.7 has the Jacobian (1, -1.2) and at 0.5
// and 2.3 its impulse 1.2345 adds (1.2345, -1.4814) to the joints': 2.5186 is left of 4.
TEST(PublishedConditions, CouplerPushesAsInDrake) {
  PublishedModel model(
      "<link name='ground_link'/>" + planarLink("q0", 1, 0, 1) + planarLink("q1", 1, 0, 1) +
          planarJoint("continuous", "ground_link", "q0", "0 0 1") +
          planarJoint("continuous", "ground_link", "q1", "0 0 1"),
      // What the joints need.
      "{actuated: [q1], joints: [{name: q0, offset: 1.2345}, {name: q1, offset: 2.5186}], "
      "couplings: [{name: coupler, offset: 0.7, terms: [{name: q0, factor: 1}, {name: q1, factor: "
      "-1.2}]}]}");
  model.motion.q << 0.5, 2.3;
  model.compute();
  EXPECT_NEAR(model.effort("coupler"), 1.2345, kFewOperations);
  EXPECT_NEAR(model.effort("q1"), 4, 4 * kFewOperations);
  EXPECT_NEAR(model.workspace.results().loops.residuals[0].position, 2.96, 4 * kFewOperations);
}

// gz-physics, joint_transmitted_wrench_features.cc, ContactForces: an arm of 6 kg and 1 m lies with
// its end on a box, and 0.4 kg are at its pin, which bears 9.8 (6 / 2 + 0.4) N upwards.
TEST(PublishedConditions, ArmLiesOnABoxAsInGzPhysics) {
  for (const double angle : {0.3, 1.2}) {
    PublishedModel model(
        "<link name='ground_link'/>" + planarLink("arm", 6, 0.5, 0.5) +
            planarLink("sensor", 0.4, 0, 0.02) +
            planarJoint("continuous", "ground_link", "arm", "0 1 0") +
            planarJoint("fixed", "arm", "sensor", "0 1 0"),
        "{gravity: [0, 0, -9.8], actuated: [], contacts: [{name: box, link: arm, at: [1, 0, 0], "
        "slip: all, plane: {link: ground_link, point: [0, 0, " +
            std::to_string(-std::sin(angle)) +
            "]}}], assembly: [{name: arm, position: " + std::to_string(angle) + "}]}");
    model.compute();
    const Eigen::Vector3d pin = model.reaction("arm").force;
    EXPECT_LE((pin - Eigen::Vector3d(0, 0, 33.32)).norm(), 100 * kFewOperations) << angle;
    EXPECT_LE((model.reaction("box").force - Eigen::Vector3d(0, 0, 29.4)).norm(),
              100 * kFewOperations);
  }
}

// Simbody, GazeboReactionForce.cpp: cubes of 100, 5 and 1 kg, 1 m wide, stand on each other's edges
// by motors, the last one at 45 degrees, with 50 m/s^2: the first one on four corners here, which
// bear 5300 N together, whatever each of them does.
TEST(PublishedConditions, CubesStandOnEachOtherAsInSimbody) {
  const auto cube = [](const std::string& name, const std::string& mass, const std::string& y) {
    return "<link name='" + name + "'><inertial><origin xyz='0.5 " + y + " 0.5'/><mass value='" +
           mass + "'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>";
  };
  const auto hinge = [](const std::string& parent, const std::string& child) {
    return "<joint name='" + child + "' type='continuous'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='1 0 1'/><axis xyz='0 1 0'/></joint>";
  };
  std::string contacts;
  for (const std::string corner : {"[0, -0.5, 0]", "[0, 0.5, 0]", "[1, -0.5, 0]", "[1, 0.5, 0]"}) {
    contacts += "{name: 'corner " + corner + "', link: first, at: " + corner +
                ", slip: all, plane: {link: ground_link}}, ";
  }
  PublishedModel model(
      "<link name='ground_link'/>" + cube("first", "100", "0") + cube("second", "5", "0") +
          cube("third", "1", "0.5") + planarJoint("fixed", "ground_link", "first", "0 0 1") +
          hinge("first", "second") + hinge("second", "third"),
      "{gravity: [0, 0, -50], joint_types: [{name: first, type: floating}], actuated: [second, "
      "third], free_motion: true, contacts: [" +
          contacts + "]}");
  model.motion.q[model.coordinate("third")] = -M_PI / 4;
  model.compute();
  const auto expect = [](const Wrench& found, const Eigen::Vector3d& torque, double force) {
    EXPECT_LE((found.torque - torque).norm(), 1000 * kFewOperations);
    EXPECT_LE((found.force - Eigen::Vector3d(0, 0, force)).norm(), 1000 * kFewOperations);
  };
  expect(model.reaction("second"), {25, -175, 0}, 300);
  expect(model.reaction("third"), {25, 0, 0}, 50);
  EXPECT_NEAR(model.effort("second"), -175, 1000 * kFewOperations);
  double ground = 0;
  for (const std::string& name : model.dynamics.closureNames()) {
    ground += model.reaction(name).force.z();
  }
  EXPECT_NEAR(ground, 5300, 1e4 * kFewOperations);
}

}  // namespace
}  // namespace virtual_work_dynamics
