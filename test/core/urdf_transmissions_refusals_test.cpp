#include <gtest/gtest.h>

#include <string>

#include "transmitting_robot.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/transmissions.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

const std::string kDifferential = "transmission_interface/DifferentialTransmission";
const std::string kJoints =
    endText("joint", "pitch", "", "joint1") + endText("joint", "roll", "", "joint2");
const std::string kActuators = endText("actuator", "left", "20", "actuator1") +
                               endText("actuator", "right", "20", "actuator2");

// The message about transmissions that a scene asks for; empty when there is none.
std::string problemOf(const std::string& transmissions, const std::string& asked = "all",
                      const std::string& more = "") {
  const Scene scene = readScene(YAML::Load("{urdf_transmissions: " + asked + more + "}"));
  const Mechanism mechanism = withJointTypes(readUrdf(transmittingRobot(transmissions)), scene);
  try {
    withTransmissions(mechanism, scene);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

std::string differentialWith(const std::string& ends) {
  return transmissionText("t", kDifferential, ends);
}

std::string simpleWith(const std::string& ends) {
  return transmissionText("t", "SimpleTransmission", ends);
}

const std::string kStart = "urdf_transmissions: transmission 't': ";

TEST(TransmissionRefusals, Types) {
  EXPECT_EQ(problemOf(differentialWith(kJoints + kActuators)), "");
  EXPECT_EQ(problemOf(transmissionText("t", "pr2_mechanism_model/WristTransmission",
                                       kJoints + kActuators)),
            kStart +
                "its type 'pr2_mechanism_model/WristTransmission' is not known; known are "
                "'SimpleTransmission', 'DifferentialTransmission' and "
                "'FourBarLinkageTransmission'");
  EXPECT_EQ(problemOf(transmissionText("t", "transmission_interface/SimpelTransmission", "")),
            kStart +
                "its type 'SimpelTransmission' is not known; did you mean "
                "'SimpleTransmission'?");
  EXPECT_EQ(problemOf("<transmission name='t' type='pr2_mechanism_model/SimpleTransmission'/>"),
            kStart +
                "its type 'pr2_mechanism_model/SimpleTransmission' is not known; known are "
                "'SimpleTransmission', 'DifferentialTransmission' and "
                "'FourBarLinkageTransmission'");
  // What is not asked for may be anything.
  EXPECT_EQ(problemOf("<transmission name='x'/>" + differentialWith(kJoints + kActuators), "[t]"),
            "");
}

TEST(TransmissionRefusals, Selections) {
  EXPECT_EQ(problemOf(""), "urdf_transmissions: the description has none");
  const std::string two = differentialWith(kJoints + kActuators);
  EXPECT_EQ(problemOf(two, "[s]"),
            "urdf_transmissions[0]: the description has no transmission 's'; known are 't'");
  EXPECT_EQ(problemOf(two, "[t, t]"), "urdf_transmissions[1]: 't' is given twice");
  EXPECT_EQ(problemOf(two + two, "[t]"),
            "urdf_transmissions[0]: the description has several transmissions 't'");
  EXPECT_EQ(problemOf(two + two),
            kStart + "its actuator 'left' is that of another transmission, too");
  EXPECT_THROW(readScene(YAML::Load("urdf_transmissions: some")), SceneError);
}

TEST(TransmissionRefusals, NumbersAndRoles) {
  const std::string slide = endText("joint", "slide", "");
  EXPECT_EQ(problemOf(simpleWith(slide + endText("actuator", "m", ""))),
            kStart + "actuator 'm' has no <mechanicalReduction>");
  EXPECT_EQ(problemOf(simpleWith(slide + endText("actuator", "m", "0"))),
            kStart + "<mechanicalReduction> of actuator 'm' is zero");
  EXPECT_EQ(problemOf(simpleWith(slide + endText("actuator", "m", "${ratio}"))),
            kStart + "<mechanicalReduction> of actuator 'm' is '${ratio}', and not a number");
  EXPECT_EQ(problemOf(simpleWith(endText("joint", "slide", "", "", "1 m") +
                                 endText("actuator", "m", "3"))),
            kStart + "<offset> of joint 'slide' is '1 m', and not a number");
  EXPECT_EQ(
      problemOf(simpleWith(slide + endText("actuator", "m", "3") + endText("actuator", "n", "3"))),
      kStart + "a SimpleTransmission has one joint and one actuator");
  EXPECT_EQ(problemOf(differentialWith(kJoints + endText("actuator", "m", "3", "actuator1"))),
            kStart + "a DifferentialTransmission has two joints and two actuators");
  EXPECT_EQ(problemOf(differentialWith(endText("joint", "pitch", "") +
                                       endText("joint", "roll", "") + kActuators)),
            kStart + "none of its joints has the <role> joint1");
  EXPECT_EQ(problemOf(differentialWith(kJoints + endText("actuator", "m", "3", "actuator1") +
                                       endText("actuator", "n", "3", "actuator1"))),
            kStart + "none of its actuators has the <role> actuator2");
  EXPECT_EQ(problemOf(differentialWith(endText("joint", "pitch", "1e300", "joint1") +
                                       endText("joint", "roll", "", "joint2") +
                                       endText("actuator", "m", "1e300", "actuator1") +
                                       endText("actuator", "n", "1", "actuator2"))),
            kStart + "its reductions overflow");
}

TEST(TransmissionRefusals, Names) {
  const std::string motor = endText("actuator", "m", "3");
  const auto with = [&](const std::string& joint) {
    return simpleWith(endText("joint", joint, "") + motor);
  };
  EXPECT_EQ(problemOf(with("slid")),
            kStart + "its joint 'slid' does not exist; did you mean 'slide'?");
  EXPECT_EQ(problemOf(with("slide"), "all", ", joint_types: [{name: slide, type: cylindrical}]"),
            kStart + "its joint 'slide' has several freedoms");
  const std::string fixed =
      "<link name='flange'/><joint name='flange_joint' type='fixed'><parent link='tool'/>"
      "<child link='flange'/></joint>";
  EXPECT_EQ(problemOf(fixed + with("flange_joint")), kStart + "its joint 'flange_joint' is fixed");
  const std::string mimic =
      "<link name='flange'/><joint name='jaw' type='continuous'><parent link='tool'/>"
      "<child link='flange'/><axis xyz='1 0 0'/><mimic joint='roll'/></joint>";
  EXPECT_EQ(problemOf(mimic + with("jaw")), kStart + "its joint 'jaw' mimics another joint");
  const auto named = [&](const std::string& name) {
    return simpleWith(endText("joint", "slide", "") + endText("actuator", name, "3"));
  };
  EXPECT_EQ(problemOf(named("elbow")), kStart + "its actuator 'elbow' has the name of a joint");
  EXPECT_EQ(problemOf(named("hand")), kStart + "its actuator 'hand' has the name of a link");
  EXPECT_EQ(problemOf(named("ground")),
            kStart + "its actuator 'ground' has a name that is reserved");
  EXPECT_EQ(problemOf(named("")), kStart + "its actuator has no name");
  EXPECT_EQ(problemOf(differentialWith(endText("joint", "pitch", "", "joint1") +
                                       endText("joint", "pitch", "", "joint2") + kActuators)),
            kStart + "joint 'pitch' is given twice");
}

// A scene whose transmissions have not been put in place is not computed without them.
TEST(TransmissionRefusals, ScenesThatStillAsk) {
  const Mechanism mechanism = readUrdf(transmittingRobot(differentialWith(kJoints + kActuators)));
  const Scene scene = readScene(YAML::Load("urdf_transmissions: all"));
  try {
    InverseDynamics dynamics(mechanism, scene, Request());
    ADD_FAILURE() << "nothing thrown";
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(),
                 "urdf_transmissions: they are not in this mechanism, withTransmissions() makes it "
                 "so");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
