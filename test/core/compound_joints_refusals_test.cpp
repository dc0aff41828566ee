#include <gtest/gtest.h>

#include <string>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kRobot[] =
    "<robot name='r'><link name='base'/><link name='a'/><link name='b'/><link name='c'/>"
    "<joint name='j' type='continuous'><parent link='base'/><child link='a'/>"
    "<axis xyz='0 0 1'/></joint>"
    "<joint name='k' type='fixed'><parent link='a'/><child link='b'/></joint>"
    "<joint name='m' type='continuous'><parent link='b'/><child link='c'/>"
    "<mimic joint='j' multiplier='2'/></joint></robot>";

// The line that a scene with these joint types ends in.
std::string lineOf(const std::string& types, const std::string& more = "") {
  try {
    const Scene scene = readScene(YAML::Load("joint_types: [" + types + "]\n" + more));
    const Mechanism robot = withJointTypes(readUrdf(kRobot), scene);
    const Dynamics dynamics(robot, scene);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(CompoundJoints, AreRefusedInOneLine) {
  const auto expectLine = [](const std::string& types, const std::string& line) {
    EXPECT_EQ(lineOf(types), line) << types;
  };
  expectLine("{type: screw, pitch: 1}", "joint_types[0]: names no joint");
  expectLine("{name: k}", "joint_types[0]: type is missing");
  expectLine("{name: k, type: ball}",
             "joint_types[0].type: 'ball' is not one of planar, cylindrical, universal, screw, "
             "spherical, floating");
  expectLine("{name: k, type: universl}",
             "joint_types[0].type: 'universl' is not one of planar, cylindrical, universal, screw, "
             "spherical, floating; did you mean 'universal'?");
  expectLine("{name: k, type: planar, pitch: 1, axis: [0, 0, 1]}",
             "joint_types[0].pitch: only a joint of type screw has one");
  expectLine("{name: k, type: screw, axis: [0, 0, 1]}",
             "joint_types[0]: pitch is missing: a joint of type screw has one");
  expectLine("{name: k, type: screw, pitch: 1}",
             "joint_types[0]: joint 'k' has no axis in the description: axis is missing");
  expectLine("{name: k, type: universal, axis: [0, 0, 1]}",
             "joint_types[0]: axis2 is missing: a joint of type universal has one");
  expectLine("{name: k, type: cylindrical, axis: [0, 0, 1], axis2: [1, 0, 0]}",
             "joint_types[0].axis2: only a joint of type universal has one");
  expectLine("{name: k, type: universal, axis: [0, 0, 1], axis2: [0, 0, -2]}",
             "joint_types[0].axis2: is parallel to the first axis");
  expectLine("{name: j, type: universal, axis2: [0, 1e-9, 1]}",
             "joint_types[0].axis2: is parallel to the first axis");
  expectLine("{name: k, type: planar, axis: [0, 0, 0]}",
             "joint_types[0].axis: [0, 0, 0] has no direction");
  expectLine("{name: k, type: spherical, axis: [0, 0, 1]}",
             "joint_types[0].axis: a joint of type spherical has none");
  expectLine("{name: q, type: planar}",
             "joint_types[0].name: no joint 'q'; known are 'j', 'k' and 'm'");
  expectLine("{name: k, type: planar, axis: [0, 0, 1]}, {name: k, type: planar, axis: [1, 0, 0]}",
             "joint_types[1].name: 'k' is given twice");
  expectLine("{name: m, type: planar}",
             "joint_types: joint 'm': it mimics another joint, and so cannot have a type with "
             "freedoms of its own");
  expectLine("{name: j, type: planar}",
             "joint_types: joint 'm': mimics joint 'j', which has several freedoms");
  EXPECT_EQ(lineOf("{name: j, type: screw, pitch: 0.1}"), "");  // whose angle 'm' can follow
}

TEST(CompoundJoints, HaveNamesThatFitTheirUse) {
  const std::string planar = "{name: k, type: planar, axis: [0, 0, 1]}";
  EXPECT_EQ(lineOf(planar, "reactions: [k.x]"),
            "reactions[0]: 'k.x' is a part of joint 'k', whose reaction is one");
  EXPECT_EQ(lineOf(planar, "joints: [{name: k, stiffness: 1}]"),
            "joints[0].name: joint 'k' has several freedoms, name one of 'k.x', 'k.y' and "
            "'k.angle'");
  EXPECT_EQ(lineOf(planar, "reactions: [k]"), "");
  EXPECT_EQ(lineOf("{name: k, type: spherical}", "joints: [{name: k.orientation, stiffness: 1}]"),
            "joints: 'k.orientation' is a fixed joint");
  EXPECT_EQ(
      lineOf("{name: k, type: spherical}", "joints: [{name: k, stiffness: 1}]"),
      "joints[0].name: joint 'k' has several freedoms, name one of 'k.rx', 'k.ry' and 'k.rz'");
}

TEST(CompoundJoints, OfTheSceneMustBeThoseOfTheMechanism) {
  const Scene scene =
      readScene(YAML::Load("joint_types: [{name: k, type: planar, axis: [0, 0, 1]}]"));
  try {
    const Dynamics dynamics(readUrdf(kRobot), scene);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(),
                 "joint_types[0]: joint 'k' is not planar in this mechanism, withJointTypes() "
                 "makes it so");
  }
}

TEST(CompoundJoints, ShareTheirNamesWithNothing) {
  std::string text = kRobot;
  text.replace(text.find("name='k'"), 8, "name='j.slide'");
  try {
    withJointTypes(readUrdf(text), readScene(YAML::Load("joint_types: [{name: j, type: screw, "
                                                        "pitch: 1}]")));
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(),
                 "joint_types: joint 'j': the name of its part 'j.slide' is that of another joint");
  }
}

TEST(CompoundJoints, ThatArePlanarNeitherMimicNorAreMimicked) {
  const auto lineOfUrdf = [](std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    try {
      readUrdf(text);
      return std::string();
    } catch (const UrdfError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(lineOfUrdf(kRobot, "name='j' type='continuous'", "name='j' type='planar'"),
            "joint 'm': mimics joint 'j', which has several freedoms");
  EXPECT_EQ(lineOfUrdf(kRobot, "name='m' type='continuous'", "name='m' type='planar'"),
            "joint 'm': is planar and cannot mimic");
}

}  // namespace
}  // namespace virtual_work_dynamics
