#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "transmitting_robot.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/transmissions.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// A factorization of a tree with ratios of some tens against closed forms.
constexpr double kTransmitted = 1e-12;
using Names = std::vector<std::string>;

// The reductions that the descriptions below have.
constexpr double kSimple = 250, kA1 = 20, kA2 = -25, kJ1 = 1.5, kJ2 = 0.8;
constexpr double kB1 = 60, kB2 = 45, kE1 = 1.1, kE2 = -2;
constexpr double kOffset1 = 0.2, kOffset2 = -0.7;

std::string threeTransmissions() {
  return transmissionText(
             "lead", "transmission_interface/SimpleTransmission",
             endText("joint", "slide", "", "", "0.3") + endText("actuator", "spindle", "250")) +
         // Roles and not the order say which is which.
         transmissionText("wrist", "transmission_interface/DifferentialTransmission",
                          endText("joint", "roll", "0.8", "joint2", "-0.7") +
                              endText("joint", "pitch", "1.5", "joint1", "0.2") +
                              endText("actuator", "right", "-25", "actuator2") +
                              endText("actuator", "left", "20", "actuator1")) +
         transmissionText("arm", "transmission_interface/FourBarLinkageTransmission",
                          endText("actuator", "lower", "60", "actuator1") +
                              endText("actuator", "a_remote", "45", "actuator2") +
                              endText("joint", "shoulder", "1.1", "joint1", "0.2") +
                              endText("joint", "elbow", "-2", "joint2", "-0.7"));
}

Scene sceneOf(const std::string& text) {
  return readScene(YAML::Load(text));
}

constexpr char kTerms[] = R"(
joints:
  - {name: left, rotor_inertia: 3.0e-5, damping: 0.002}
  - {name: right, rotor_inertia: 2.0e-5}
  - {name: lower, coulomb: 0.03, coulomb_velocity: 0.1}
)";

// A motion of the joints; motors follow.
Motion motionOf(const Mechanism& mechanism, int seed) {
  Motion motion(static_cast<Eigen::Index>(mechanism.coordinates().size()));
  int i = 0;
  for (const char* joint : {"slide", "shoulder", "elbow", "pitch", "roll"}) {
    const Eigen::Index at = mechanism.coordinateIndex(joint);
    ++i;
    motion.q[at] = std::sin(1.7 * i + seed);
    motion.qd[at] = 2 * std::cos(2.3 * i * seed);
    motion.qdd[at] = 5 * std::sin(0.9 * i - 3 * seed);
  }
  return motion;
}

std::vector<bool> givenJoints(const Mechanism& mechanism) {
  std::vector<bool> given(mechanism.coordinates().size(), false);
  for (const char* joint : {"slide", "shoulder", "elbow", "pitch", "roll"}) {
    given[static_cast<std::size_t>(mechanism.coordinateIndex(joint))] = true;
  }
  return given;
}

void expectNear(double found, double expected) {
  ASSERT_TRUE(std::isfinite(found));
  EXPECT_NEAR(found, expected, kTransmitted * std::max(1.0, std::abs(expected)));
}

class TransmissionsOfUrdf : public ::testing::Test {
 protected:
  TransmissionsOfUrdf()
      : described(readUrdf(transmittingRobot(threeTransmissions()))),
        robot(
            withTransmissions(described, sceneOf(std::string("urdf_transmissions: all") + kTerms))),
        found(robot.mechanism, robot.scene) {}

  Eigen::Index at(const std::string& joint) const { return robot.mechanism.coordinateIndex(joint); }
  void compute(int seed) {
    motion = motionOf(robot.mechanism, seed);
    ASSERT_TRUE(found.dynamics.complete(motion, givenJoints(robot.mechanism)));
    found.dynamics.compute(motion);
  }
  double effort(const std::string& joint) const { return found.dynamics.effort()[at(joint)]; }
  double q(const std::string& joint) const { return motion.q[at(joint)]; }

  const Mechanism described;
  const SceneOfMechanism robot;
  ClosedLoopResults found;
  Motion motion;
};

// The maps from joints to actuators that transmission_interface has for positions.
TEST_F(TransmissionsOfUrdf, ActuatorsMoveAsTransmissionInterfaceSays) {
  for (int seed = 1; seed < 5; ++seed) {
    compute(seed);
    expectNear(q("spindle"), kSimple * (q("slide") - 0.3));
    const double p1 = q("pitch") - kOffset1, p2 = q("roll") - kOffset2;
    expectNear(q("left"), kA1 * (kJ1 * p1 + kJ2 * p2));
    expectNear(q("right"), kA2 * (kJ1 * p1 - kJ2 * p2));
    const double s1 = q("shoulder") - kOffset1, s2 = q("elbow") - kOffset2;
    expectNear(q("lower"), kB1 * kE1 * s1);
    expectNear(q("a_remote"), kB2 * (s1 + kE2 * s2));
  }
}

// Efforts by the power that passes: those of transmission_interface, except for four-bar linkages,
// whose formulas there do not keep it.
TEST_F(TransmissionsOfUrdf, ActuatorsDeliverThePowerOfTheJoints) {
  const InverseDynamics chain(described, Scene());
  Workspace workspace = chain.makeWorkspace();
  for (int seed = 1; seed < 5; ++seed) {
    compute(seed);
    chain.compute(motionOf(described, seed), workspace);
    const auto torque = [&](const std::string& joint) {
      return workspace.effort()[described.coordinateIndex(joint)];
    };
    const auto qd = [&](const std::string& joint) { return motion.qd[at(joint)]; };
    const auto qdd = [&](const std::string& joint) { return motion.qdd[at(joint)]; };
    expectNear(effort("spindle"), torque("slide") / kSimple);
    const double t1 = torque("pitch") / kJ1, t2 = torque("roll") / kJ2;
    expectNear(effort("left"), (t1 + t2) / (2 * kA1) + 3e-5 * qdd("left") + 0.002 * qd("left"));
    expectNear(effort("right"), (t1 - t2) / (2 * kA2) + 2e-5 * qdd("right"));
    const double elbow = torque("elbow") / kE2;
    const double sign = qd("lower") > 0 ? 1 : -1;
    ASSERT_GT(std::abs(qd("lower")), 0.1);
    expectNear(effort("lower"), (torque("shoulder") - elbow) / (kB1 * kE1) + 0.03 * sign);
    expectNear(effort("a_remote"), elbow / kB2);
    double power = 0, joints = 0;
    for (const char* joint : {"slide", "shoulder", "elbow", "pitch", "roll"}) {
      EXPECT_EQ(effort(joint), 0);
      joints += torque(joint) * qd(joint);
    }
    for (const char* motor : {"spindle", "left", "right", "lower", "a_remote"}) {
      power += effort(motor) * qd(motor);
    }
    const double lost = qd("left") * (3e-5 * qdd("left") + 0.002 * qd("left")) +
                        2e-5 * qdd("right") * qd("right") + 0.03 * std::abs(qd("lower"));
    expectNear(power - lost, joints);
  }
}

// The same robot with motors in the description and couplings in the scene.
TEST_F(TransmissionsOfUrdf, EqualWhatIsWrittenByHandBitByBit) {
  std::string motors;
  const auto motor = [&](const std::string& name, const std::string& link) {
    motors += "<link name='" + name + "'/><joint name='" + name +
              "' type='continuous'><parent link='" + link + "'/><child link='" + name +
              "'/><axis xyz='0 0 1'/></joint>";
  };
  motor("spindle", "base");
  motor("left", "fore");
  motor("right", "fore");
  motor("lower", "sled");
  motor("a_remote", "sled");
  const Mechanism written = readUrdf(transmittingRobot(motors));
  ASSERT_EQ(written.coordinateNames(), robot.mechanism.coordinateNames());
  const Scene scene = sceneOf(std::string(R"(
couplings:
  - {name: lead.spindle, offset: -75, terms: [{name: spindle, factor: 1}, {name: slide, factor: -250}]}
  - name: wrist.left
    offset: 5.2
    terms: [{name: left, factor: 1}, {name: pitch, factor: -30}, {name: roll, factor: -16}]
  - name: wrist.right
    offset: 21.5
    terms: [{name: right, factor: 1}, {name: pitch, factor: 37.5}, {name: roll, factor: -20}]
  - {name: arm.lower, offset: -13.2, terms: [{name: lower, factor: 1}, {name: shoulder, factor: -66}]}
  - name: arm.a_remote
    offset: -72
    terms: [{name: a_remote, factor: 1}, {name: shoulder, factor: -45}, {name: elbow, factor: 90}]
actuated: [spindle, left, right, lower, a_remote]
given: [slide, shoulder, elbow, pitch, roll]
reactions: [slide, shoulder, elbow, pitch, roll]
)") + kTerms);
  ASSERT_EQ(robot.scene.couplings.size(), scene.couplings.size());
  for (std::size_t i = 0; i < scene.couplings.size(); ++i) {
    const Coupling &read = robot.scene.couplings[i], &by_hand = scene.couplings[i];
    EXPECT_EQ(read.name, by_hand.name);
    ASSERT_EQ(read.terms.size(), by_hand.terms.size());
    for (std::size_t k = 0; k < read.terms.size(); ++k) {
      EXPECT_EQ(read.terms[k].name, by_hand.terms[k].name);
      EXPECT_NEAR(read.terms[k].value, by_hand.terms[k].value, 1e-14) << read.name;
    }
    EXPECT_NEAR(*read.offset, *by_hand.offset, 1e-13) << read.name;
  }
  Scene rounded = scene;  // products of reductions, as the description has them
  rounded.couplings = robot.scene.couplings;
  ClosedLoopResults by_hand(written, rounded);
  EXPECT_EQ(by_hand.dynamics.request().child_axes, found.dynamics.request().child_axes);
  for (int seed = 1; seed < 5; ++seed) {
    compute(seed);
    Motion same = motionOf(written, seed);
    ASSERT_TRUE(by_hand.dynamics.complete(same, givenJoints(written)));
    EXPECT_EQ(same.q, motion.q);
    EXPECT_EQ(same.qdd, motion.qdd);
    by_hand.dynamics.compute(same);
    EXPECT_EQ(by_hand.dynamics.effort(), found.dynamics.effort());
    for (const std::string& joint : by_hand.dynamics.request().child_axes) {
      EXPECT_EQ(by_hand.child(joint).force, found.child(joint).force) << joint;
      EXPECT_EQ(by_hand.child(joint).torque, found.child(joint).torque) << joint;
    }
  }
}

TEST_F(TransmissionsOfUrdf, NamesGoFromJointsToActuators) {
  const auto with = [&](const std::string& scene) {
    return withTransmissions(described, sceneOf(scene)).scene;
  };
  // In the order of the description, whose joints are one chain.
  EXPECT_EQ(robot.scene.given, Names({"slide", "shoulder", "elbow", "pitch", "roll"}));
  EXPECT_EQ(robot.scene.actuated, Names({"spindle", "lower", "a_remote", "left", "right"}));
  EXPECT_EQ(robot.scene.reaction_names, *robot.scene.given);
  EXPECT_EQ(robot.scene.actuators_of.at("roll"), Names({"left", "right"}));
  const Scene wrist = with("urdf_transmissions: [wrist]");
  EXPECT_EQ(wrist.actuated, Names({"slide", "shoulder", "elbow", "left", "right"}));
  EXPECT_EQ(wrist.given, Names({"slide", "shoulder", "elbow", "pitch", "roll"}));
  EXPECT_EQ(wrist.couplings.size(), 2u);
  EXPECT_EQ(wrist.transmission_names, Names());
  // Motors that a scene names already, and what it says of motions, stay.
  const Scene named =
      with("{urdf_transmissions: [wrist], actuated: [right, pitch, elbow], given: [left, right]}");
  EXPECT_EQ(named.actuated, Names({"right", "left", "elbow"}));
  EXPECT_EQ(named.given, Names({"left", "right"}));
  const Scene motors = with("{urdf_transmissions: [wrist], actuated: [right, left]}");
  EXPECT_EQ(motors.given, Names({"pitch", "roll"}));
  EXPECT_EQ(with("reactions: none").transmissions, TransmissionSelection::kNone);
  EXPECT_EQ(with("{urdf_transmissions: all, reactions: none}").reactions, ReactionSelection::kNone);
}

// Drives say how joints or motors move, and motions give the rest.
TEST_F(TransmissionsOfUrdf, WhatDrivesMoveIsNotGiven) {
  const auto given = [&](const std::string& driven, const std::string& more = "") {
    const Scene scene = sceneOf("{urdf_transmissions: all" + more + ", drives: [{name: " + driven +
                                ", law: polynomial, coefficients: [0, 1]}]}");
    const SceneOfMechanism made = withTransmissions(described, scene);
    const Dynamics judged(made.mechanism, made.scene, Request());  // refuses too much or little
    return made.scene.given.value_or(Names());
  };
  EXPECT_EQ(given("slide"), Names({"shoulder", "elbow", "pitch", "roll"}));
  EXPECT_EQ(given("spindle"), Names({"shoulder", "elbow", "pitch", "roll"}));
  EXPECT_EQ(given("right"), Names({"slide", "shoulder", "elbow", "roll"}));
  EXPECT_EQ(given("lower"), Names({"slide", "elbow", "pitch", "roll"}));
  EXPECT_EQ(given("a_remote"), Names({"slide", "elbow", "pitch", "roll"}));
  EXPECT_EQ(given("elbow", ", actuated: [lower, a_remote, slide, left, right]"),
            Names({"shoulder", "slide", "pitch", "roll"}));
}

// A drive moves the joint, and its motors deliver what it takes.
TEST_F(TransmissionsOfUrdf, MotorsDeliverWhatDrivesOfJointsTake) {
  for (const char* actuated : {"", ", actuated: [shoulder, elbow, pitch, roll]"}) {
    const SceneOfMechanism driven = withTransmissions(
        described, sceneOf(std::string("{urdf_transmissions: all") + actuated +
                           ", drives: [{name: slide, law: polynomial, coefficients: [0, 1]}, "
                           "{name: pitch, law: polynomial, coefficients: [0, 1]}]}"));
    ClosedLoopResults results(driven.mechanism, driven.scene);
    const InverseDynamics chain(described, Scene());
    Workspace workspace = chain.makeWorkspace();
    chain.compute(motionOf(described, 2), workspace);
    Motion moving = motionOf(driven.mechanism, 2);
    ASSERT_TRUE(results.dynamics.complete(moving, givenJoints(driven.mechanism)));
    results.dynamics.compute(moving);
    const Eigen::VectorXd &found_here = results.dynamics.effort(), &torque = workspace.effort();
    const auto here = [&](const char* name) { return driven.mechanism.coordinateIndex(name); };
    const auto there = [&](const char* name) { return described.coordinateIndex(name); };
    for (const char* name : {"slide", "pitch"}) EXPECT_EQ(found_here[here(name)], 0);
    expectNear(found_here[here("spindle")], torque[there("slide")] / kSimple);
    expectNear(found_here[here("left")],
               (torque[there("pitch")] / kJ1 + torque[there("roll")] / kJ2) / (2 * kA1));
  }
}

// Joints that nothing holds are given, too; where positions do not follow everything is.
TEST_F(TransmissionsOfUrdf, MotionsGiveAllThatDoesNotFollow) {
  const SceneOfMechanism loose = withTransmissions(
      described, sceneOf("{urdf_transmissions: [lead], actuated: [slide, elbow], free_motion: "
                         "true}"));
  EXPECT_EQ(loose.scene.given, Names({"slide", "shoulder", "elbow", "pitch", "roll"}));
  const Dynamics dynamics(loose.mechanism, loose.scene, Request());
  EXPECT_EQ(std::count(dynamics.residuals().begin(), dynamics.residuals().end(), true), 3);
  const SceneOfMechanism belt = withTransmissions(
      described, sceneOf("{urdf_transmissions: [lead], couplings: [{name: belt, rate_only: true, "
                         "terms: [{name: pitch, factor: 1}, {name: roll, factor: 2}]}]}"));
  EXPECT_FALSE(belt.scene.given.has_value());
  const Given given = Dynamics(belt.mechanism, belt.scene, Request()).given();
  EXPECT_EQ(std::count(given.coordinates.begin(), given.coordinates.end(), false), 0);
}

TEST_F(TransmissionsOfUrdf, DoubtsSayWhatIsRead) {
  const auto texts = [](const Mechanism& mechanism) {
    std::vector<std::string> all;
    for (const Doubt& doubt : mechanism.doubts()) all.push_back(doubt.text);
    return all;
  };
  const std::string unread = "> is not read: it couples the joints ";
  const std::string advice =
      "; efforts are those at the joints, not at its motors, and where it ties joints to one "
      "another, urdf_transmissions in the scene says so";
  const std::string wrist =
      "element <transmission name='wrist'" + unread + "'roll' and 'pitch'" + advice;
  const std::string arm =
      "element <transmission name='arm'" + unread + "'shoulder' and 'elbow'" + advice;
  EXPECT_EQ(texts(described), (std::vector<std::string>{wrist, arm}));
  EXPECT_EQ(texts(robot.mechanism),
            (std::vector<std::string>{
                "transmissions 'lead', 'wrist' and 'arm' are read: efforts are those of their "
                "actuators 'spindle', 'left', 'right', 'lower' and 'a_remote', not of the joints "
                "that these move"}));
  EXPECT_TRUE(robot.mechanism.transmissions().empty());
  const SceneOfMechanism one = withTransmissions(described, sceneOf("urdf_transmissions: [arm]"));
  EXPECT_EQ(texts(one.mechanism).front(), wrist);
  EXPECT_EQ(texts(one.mechanism).size(), 2u);
  EXPECT_EQ(one.mechanism.transmissions().size(), 2u);
}

// Motors beside joints that mimic, and parts of joints with several freedoms, change nothing else.
TEST(TransmissionsOfUrdfs, MotorsLeaveTheRestOfTheRobotAsItIs) {
  const std::string text = transmittingRobot(
      "<link name='jaw'><inertial><mass value='0.2'/><inertia ixx='1e-3' iyy='1e-3' izz='1e-3' "
      "ixy='0' ixz='0' iyz='0'/></inertial></link>"
      "<joint name='jaw' type='prismatic'><parent link='hand'/><child link='jaw'/>"
      "<axis xyz='0 1 0'/><mimic joint='roll' multiplier='0.02' offset='0.1'/>"
      "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>" +
      transmissionText("a", "SimpleTransmission",
                       endText("joint", "elbow.angle2", "") + endText("actuator", "A", "7")) +
      transmissionText("b", "SimpleTransmission",
                       endText("joint", "roll", "") + endText("actuator", "b", "-3")));
  const Scene scene = sceneOf(
      "{urdf_transmissions: all, joint_types: [{name: elbow, type: universal, axis: [1, 0, 0], "
      "axis2: [0, 1, 0]}]}");
  const Mechanism typed = withJointTypes(readUrdf(text), scene);
  const SceneOfMechanism robot = withTransmissions(typed, scene);
  EXPECT_EQ(robot.mechanism.joint(robot.mechanism.jointIndex("A")).parent_link,
            robot.mechanism.linkIndex("upper"));
  EXPECT_EQ(robot.mechanism.joint(robot.mechanism.jointIndex("b")).parent_link,
            robot.mechanism.linkIndex("hand"));
  Scene open = scene;
  open.transmissions = TransmissionSelection::kNone;
  Request request;
  request.child_axes = {"slide", "elbow", "jaw", "roll"};
  const InverseDynamics chain(typed, open, request);
  Workspace workspace = chain.makeWorkspace();
  Motion motion(6), all(8);
  for (const std::string& name : typed.coordinateNames()) {
    const Eigen::Index i = typed.coordinateIndex(name);
    const Eigen::Index k = robot.mechanism.coordinateIndex(name);
    motion.q[i] = all.q[k] = std::sin(1.0 + static_cast<double>(i));
    motion.qd[i] = all.qd[k] = std::cos(2.0 * static_cast<double>(i));
    motion.qdd[i] = all.qdd[k] = 3 * std::sin(3.0 * static_cast<double>(i));
  }
  chain.compute(motion, workspace);
  ClosedLoopResults found(robot.mechanism, robot.scene);
  std::vector<bool> given(8, true);
  for (const char* motor : {"A", "b"}) {
    given[static_cast<std::size_t>(robot.mechanism.coordinateIndex(motor))] = false;
  }
  ASSERT_TRUE(found.dynamics.complete(all, given));
  found.dynamics.compute(all);
  const auto at = [&](const std::string& name) { return robot.mechanism.coordinateIndex(name); };
  expectNear(all.q[at("A")], 7 * all.q[at("elbow.angle2")]);
  expectNear(found.dynamics.effort()[at("A")],
             workspace.effort()[typed.coordinateIndex("elbow.angle2")] / 7);
  expectNear(found.dynamics.effort()[at("b")],
             workspace.effort()[typed.coordinateIndex("roll")] / -3);
  expectNear(found.dynamics.effort()[at("pitch")],
             workspace.effort()[typed.coordinateIndex("pitch")]);
  for (std::size_t i = 0; i < chain.request().child_axes.size(); ++i) {
    const std::string& name = chain.request().child_axes[i];
    EXPECT_LE((found.child(name).force - workspace.childAxes()[i].force).norm(), 1e-11) << name;
  }
}

// Half of a differential, whose other joint a loop's closure could hold: both motors carry it.
TEST_F(TransmissionsOfUrdf, PassiveJointsOfADifferentialStayPassive) {
  const SceneOfMechanism half = withTransmissions(
      described, sceneOf("{urdf_transmissions: [wrist], actuated: [slide, shoulder, elbow, roll], "
                         "given: [slide, shoulder, elbow, pitch, roll]}"));
  ClosedLoopResults results(half.mechanism, half.scene);
  Motion at_rest = motionOf(half.mechanism, 3);
  ASSERT_TRUE(results.dynamics.complete(at_rest, givenJoints(half.mechanism)));
  results.dynamics.compute(at_rest);
  EXPECT_EQ(results.dynamics.effort()[half.mechanism.coordinateIndex("pitch")], 0);
  EXPECT_NE(results.dynamics.effort()[half.mechanism.coordinateIndex("right")], 0);
}

}  // namespace
}  // namespace virtual_work_dynamics
