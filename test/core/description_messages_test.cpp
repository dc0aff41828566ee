#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

const std::string kBody =
    "<inertial><origin xyz='0.1 0 0'/><mass value='1.2'/><inertia ixx='0.01' ixy='0' ixz='0' "
    "iyy='0.01' iyz='0' izz='0.01'/></inertial>";
const std::string kLimit = "<limit lower='-3' upper='3' effort='9' velocity='9'/>";

std::string link(const std::string& name, const std::string& content = kBody) {
  return "<link name='" + name + "'>" + content + "</link>";
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& content = "<axis xyz='0 1 0'/>" + kLimit,
                  const std::string& type = "revolute") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='0.3 0 0'/>" + content + "</joint>";
}

// Two bodies on a base; `more` stands behind them.
std::string arm(const std::string& more = "", const std::string& upper = kBody,
                const std::string& fore = kBody) {
  return "<robot name='arm'>" + link("base", "") + link("upper", upper) + link("fore", fore) +
         joint("shoulder", "base", "upper") + joint("elbow", "upper", "fore") + more + "</robot>";
}

std::string refusal(const std::string& urdf) {
  try {
    readUrdf(urdf);
  } catch (const UrdfError& error) {
    return error.what();
  }
  return "(read)";
}

std::vector<std::string> doubts(const std::string& urdf) {
  std::vector<std::string> texts;
  const Mechanism mechanism = readUrdf(urdf);
  for (const Doubt& doubt : mechanism.doubts()) texts.push_back(doubt.text);
  return texts;
}

std::string theDoubt(const std::string& urdf) {
  const std::vector<std::string> texts = doubts(urdf);
  EXPECT_EQ(texts.size(), 1u);
  return texts.empty() ? "(none)" : texts.front();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(DescriptionMessages, AGoodRobotIsNotDoubted) {
  EXPECT_EQ(doubts(arm()), std::vector<std::string>{});
}

// As bullet's humanoid: eight capsules, which urdfdom does not know, and one spherical joint.
TEST(DescriptionMessages, TheCauseStandsAloneAndGeometryIsNotSpokenOf) {
  const std::string capsule =
      "<visual><geometry><capsule radius='0.1' length='0.3'/></geometry></visual>"
      "<collision><geometry><mesh/></geometry><origin rpy='x'/></collision>";
  EXPECT_EQ(doubts(arm("<material/>", kBody + capsule, capsule + kBody)),
            std::vector<std::string>{});
  EXPECT_EQ(refusal(arm(link("head", capsule) + joint("neck", "upper", "head", "", "spherical"),
                        kBody + capsule, capsule + kBody)),
            "joint 'neck': type 'spherical' is not one of revolute, continuous, prismatic, fixed, "
            "planar, floating; 'joint_types' of a scene makes a joint of another type spherical");
}

TEST(DescriptionMessages, EachRefusalNamesItsCause) {
  const std::pair<const char*, const char*> spoilt[] = {
      {"<mass value='heavy'/>", "link 'upper': mass 'heavy' is not a finite number"},
      {"<mass value='1,2'/>",
       "link 'upper': mass '1,2' is not a finite number; numbers have a decimal point, and blanks "
       "between them"},
      {"<mass value='inf'/>", "link 'upper': mass 'inf' is not a finite number"},
      {"<mass/>", "link 'upper': <mass> has no value"},
      {"", "link 'upper': <inertial> has no <mass>"}};
  for (const auto& [mass, message] : spoilt) {
    EXPECT_EQ(refusal(replaced(arm(), "<mass value='1.2'/>", mass)), message);
  }
  EXPECT_EQ(refusal(replaced(arm(), " izz='0.01'", "")), "link 'upper': <inertia> has no izz");
  EXPECT_EQ(refusal(replaced(arm(), "xyz='0.1 0 0'", "xyz='0.1 0'")),
            "link 'upper': origin xyz '0.1 0' is not three finite numbers");
  EXPECT_EQ(refusal(replaced(arm(), "xyz='0.3 0 0'", "rpy='0 0 up'")),
            "joint 'shoulder': origin rpy '0 0 up' is not three finite numbers");
  EXPECT_EQ(refusal(replaced(arm(), "revolute", "Revolute")),
            "joint 'shoulder': type 'Revolute' is not one of revolute, continuous, prismatic, "
            "fixed, planar, floating; did you mean 'revolute'?");
  EXPECT_EQ(refusal(replaced(arm(), kLimit, "")),
            "joint 'shoulder': a revolute joint needs a <limit>; without limits its type is "
            "continuous");
  EXPECT_EQ(refusal(replaced(arm(), "<parent link='base'/>", "<parent>base</parent>")),
            "joint 'shoulder': <parent> names no link; 'base' as text is SDF, write <parent "
            "link=...>");
  EXPECT_EQ(refusal(replaced(arm(), "<parent link='base'/>", "<parent link='bse'/>")),
            "joint 'shoulder': no link 'bse'; did you mean 'base'?");
  EXPECT_EQ(refusal(arm(link("palm") + link("thumb"))),
            "links 'base', 'palm' and 'thumb' are all roots: a robot is one tree, so joints have "
            "to connect them");
  EXPECT_EQ(refusal(arm(link("fore"))), "link 'fore': is described twice");
  EXPECT_EQ(refusal(arm(joint("elbow", "upper", "fore"))), "joint 'elbow': is described twice");
  EXPECT_EQ(refusal("<robot name='r'><link/></robot>"), "the link in line 1: has no name");
  EXPECT_EQ(refusal("<robot name='r'><link name='a'></robot>"),
            "robot description is broken: not well-formed XML: line 1: mismatched element");
  EXPECT_EQ(refusal("<sdf version='1.6'><model name='m'/></sdf>"),
            "this is SDF (its root element is <sdf>), not URDF");
  EXPECT_EQ(refusal(arm(link("tip") +
                        joint("wrist", "fore", "tip", kLimit + "<mimic joint='shoudler'/>"))),
            "joint 'wrist': mimics unknown joint 'shoudler'; did you mean 'shoulder'?");
}

TEST(DescriptionMessages, BlanksAroundNumbersAreNoFault) {
  const std::string urdf = replaced(replaced(arm(), "value='1.2'", "value=' 1.2 '"),
                                    "xyz='0.3 0 0'", "xyz='\n 0.3\t0\n 0 '");
  EXPECT_EQ(doubts(urdf), std::vector<std::string>{});
  EXPECT_EQ(readUrdf(urdf).joints()[0].p_PoKo_P[0], 0.3);
  EXPECT_EQ(readUrdf(urdf).links()[1].mass, 1.2);
}

TEST(DescriptionMessages, XacroIsRecognised) {
  const std::string how = "): expand it first, rosrun xacro xacro FILE > robot.urdf";
  const std::string space = " xmlns:xacro='http://wiki.ros.org/xacro'";
  EXPECT_EQ(refusal("<robot" + space +
                    "><xacro:macro name='arm'><link name='${p}base'/></xacro:macro></robot>"),
            "this is a xacro file (it has <xacro:macro name='arm'>" + how);
  EXPECT_EQ(refusal("<robot" + space + "></robot>"),
            "this is a xacro file (it has xmlns:xacro, but no link of its own" + how);
  EXPECT_EQ(refusal("<robot" + space + "><link name='world'/></robot>"),
            "this is a xacro file (it has xmlns:xacro, but no name" + how);
  // One that describes a link beside its macros is not that link.
  EXPECT_EQ(refusal("<robot name='r'" + space +
                    "><xacro:include filename='x'/><link name='world'/></robot>"),
            "this is a xacro file (it has <xacro:include>" + how);
  EXPECT_EQ(refusal(replaced(arm(), "name='upper'", "name='${prefix}upper'")),
            "this is a xacro file (it has '${prefix}upper'" + how);
  EXPECT_EQ(refusal(replaced(arm(), "value='1.2'", "value='${m * 2}'")),
            "this is a xacro file (it has '${m * 2}'" + how);
  // Expanded files keep the name space.
  EXPECT_EQ(doubts(replaced(arm(), "<robot", "<robot" + space)), std::vector<std::string>{});
  EXPECT_EQ(theDoubt(arm("<xacro:gripper prefix='a_'/>")),
            "element <xacro:gripper> is not read: it is left of a xacro file; rosrun xacro xacro "
            "FILE > robot.urdf expands it");
}

TEST(DescriptionMessages, WhatClosesLoopsIsNamedWithWhatToWrite) {
  EXPECT_EQ(
      theDoubt(arm("<loop_joint name='k' type='continuous'><axis xyz='0 1 0'/><link1 "
                   "link='fore' xyz='0.2 0 0'/><link2 link='upper' xyz='0 0 1'/></loop_joint>")),
      "element <loop_joint name='k'> is not read: the loop stays open; in the scene, "
      "closures: [{name: k, type: revolute, parent: {link: fore, xyz: [0.2, 0, 0]}, child: "
      "{link: upper, xyz: [0, 0, 1]}}] with z of both frames along the axis closes it");
  EXPECT_EQ(theDoubt(arm("<constraint name='k' type='spherical'><parent link='fore'/>"
                         "<parent_origin xyz='0.2 0 0'/><child link='upper'/></constraint>")),
            "element <constraint name='k'> is not read: the loop stays open; in the scene, "
            "closures: [{name: k, type: spherical, parent: {link: fore, xyz: [0.2, 0, 0]}, child: "
            "{link: upper}}] closes it");
  EXPECT_EQ(theDoubt(arm("<gazebo><joint name='k' type='ball'><parent>fore</parent>\n<child> upper "
                         "</child></joint></gazebo>")),
            "element <joint name='k'> in <gazebo> is not read: a loop that it closes stays open; "
            "in the scene, closures: [{name: k, type: spherical, parent: {link: fore}, child: "
            "{link: upper}}] and its place on both links (xyz) closes it");
  // Fixing the robot to the world, as it is anyway.
  EXPECT_EQ(doubts(arm("<gazebo><joint name='f' type='fixed'><parent>world</parent><child>base"
                       "</child></joint></gazebo>")),
            std::vector<std::string>{});
}

TEST(DescriptionMessages, CouplingsAreNamed) {
  const std::string one = "<transmission name='t'><joint name='elbow'/><actuator name='m'/>";
  EXPECT_EQ(doubts(arm(one + "</transmission>")), std::vector<std::string>{});
  EXPECT_EQ(theDoubt(arm(one + "<joint name='shoulder'/></transmission>")),
            "element <transmission name='t'> is not read: it couples the joints 'elbow' and "
            "'shoulder'; efforts are those at the joints, not at its motors, and where it ties "
            "joints to one another, <mimic> in the joint or couplings in the scene say so");
  EXPECT_EQ(theDoubt(arm("<gazebo><plugin><joint>elbow</joint><mimicJoint>tip</mimicJoint>"
                         "</plugin></gazebo>")),
            "element <mimicJoint> in <gazebo> is not read: joint 'elbow' does not follow 'tip'; "
            "<mimic> in the joint says that it does");
  EXPECT_EQ(theDoubt(arm("<gazebo reference='elbow'><springStiffness>12</springStiffness>"
                         "</gazebo>")),
            "element <springStiffness> in <gazebo> is not read; in the scene, joints: [{name: "
            "elbow, stiffness: 12, rest: ...}] is a spring in the joint");
}

TEST(DescriptionMessages, MisspeltElementsAndAttributesAreNamed) {
  EXPECT_EQ(theDoubt(arm("<Link name='tip'/>")),
            "element <Link name='tip'> is not read; did you mean <link>?");
  EXPECT_EQ(theDoubt(arm("<group name='g'><link name='tip'/></group>")),
            "element <group name='g'> is not read, nor are links and joints in it: they have to "
            "stand in <robot>");
  EXPECT_EQ(theDoubt(arm("", kBody + "<mass value='3'/>")),
            "link 'upper': <mass> is not read: it has to stand in <inertial>");
  EXPECT_EQ(theDoubt(arm("", kBody + kBody)),
            "link 'upper': has more than one <inertial>, the first is used");
  EXPECT_EQ(theDoubt(replaced(arm(), kLimit, kLimit + "<mimick joint='elbow'/>")),
            "joint 'shoulder': element <mimick> is not read; did you mean <mimic>?");
  EXPECT_EQ(theDoubt(replaced(arm(), "<limit lower=", "<limit soft='0' lowr=")),
            "joint 'shoulder': attribute 'lowr' of <limit> is not read; did you mean 'lower'?");
  // Elements of other programs are none of this one's business.
  EXPECT_EQ(doubts(arm("<sensor name='s'/><drake:collision_filter_group/><frame name='f'/>"
                       "<safety/><material name='m'/>")),
            std::vector<std::string>{});
}

TEST(DescriptionMessages, ManyUnreadElementsAreCounted) {
  std::string loops;
  for (int i = 0; i < 5000; ++i) loops += "<loop_joint/>";
  const std::vector<std::string> texts = doubts(arm(loops));
  ASSERT_EQ(texts.size(), 21u);
  EXPECT_EQ(texts.back(), "4980 more elements are not read");
}

std::string body(const std::string& mass, const std::string& moment, const std::string& xyz) {
  return "<inertial><origin xyz='" + xyz + "'/><mass value='" + mass + "'/><inertia ixx='" +
         moment + "' ixy='0' ixz='0' iyy='" + moment + "' iyz='0' izz='" + moment +
         "'/></inertial>";
}

TEST(DescriptionMessages, UnitsOfInertiasAreDoubtedByName) {
  EXPECT_EQ(theDoubt(arm("", body("1.2", "11467", "0.1 0 0"))),
            "link 'upper': radius of gyration 97.75 m on a robot of 0.6 m: is its inertia of "
            "1.147e+04 in g mm^2 or g cm^2 or kg mm^2 instead of kg m^2?");
  EXPECT_EQ(theDoubt(arm("", body("1.2", "114.67", "0.1 0 0"))),
            "link 'upper': radius of gyration 9.775 m on a robot of 0.6 m: is its inertia of 114.7 "
            "in g cm^2 or kg mm^2 or kg cm^2 instead of kg m^2?");
  // pincher_arm: 1e-5 kg.
  EXPECT_EQ(theDoubt(arm("", body("1e-5", "1", "0 0 0"))),
            "link 'upper': radius of gyration 316.2 m on a robot of 0.6 m: is its inertia of 1 in "
            "g mm^2 or g cm^2 or kg mm^2 instead of kg m^2?");
  EXPECT_EQ(theDoubt(arm("", kBody, body("1e-9", "1e9", "0 0 0"))),
            "link 'fore': radius of gyration 1e+09 m on a robot of 0.6 m: is its mass or its "
            "inertia of 1e+09 kg m^2 wrong?");
  const Mechanism doubtful = readUrdf(arm("", body("1.2", "11467", "0 0 0")));
  ASSERT_EQ(doubtful.doubts().size(), 1u);
  EXPECT_TRUE(doubtful.doubts().front().about_inertia);
}

TEST(DescriptionMessages, LengthsInMillimetresAreDoubted) {
  EXPECT_EQ(theDoubt(arm("", body("1.2", "0.01", "120 0 0"))),
            "link 'upper': centre of mass 120 m from its origin on a robot of 0.6 m: is it in mm?");
  EXPECT_EQ(theDoubt(replaced(arm(), "xyz='0.3 0 0'", "xyz='300 0 0'")),
            "joint 'shoulder': its origin is 300 m from that of its parent: is it in mm?");
  // Neither a place in a map nor one link in millimetres hides the others.
  const std::string map = link("map", "") +
                          "<joint name='at' type='fixed'><parent link='map'/>"
                          "<child link='base'/><origin xyz='4000 1500 0'/></joint>";
  EXPECT_EQ(doubts(arm(map)), std::vector<std::string>{});
  EXPECT_EQ(doubts(arm(map, body("1.2", "0.01", "120 0 0"))).size(), 1u);
  EXPECT_EQ(
      doubts(replaced(arm("", body("1.2", "11467", "0 0 0")), "xyz='0.3 0 0'", "xyz='300 0 0'"))
          .size(),
      2u);
}

// With all joints in one place the size of a robot is not known: only what is far is doubted.
TEST(DescriptionMessages, RobotsOfUnknownSizeAreHardlyDoubted) {
  const auto pendulum = [](const std::string& inertial) {
    return "<robot name='p'>" + link("base", "") + link("bob", inertial) +
           "<joint name='j' type='continuous'><parent link='base'/><child link='bob'/>"
           "<axis xyz='0 1 0'/></joint></robot>";
  };
  EXPECT_EQ(doubts(pendulum(body("5", "1", "0 0 -15"))), std::vector<std::string>{});
  EXPECT_EQ(theDoubt(pendulum(body("1.2", "0.01", "120 0 0"))),
            "link 'bob': centre of mass 120 m from its origin on a robot whose joints are all in "
            "one place: is it in mm?");
}

// A bracket that is moved by a millimetre carries a long beam.
TEST(DescriptionMessages, SmallOffsetsOfLargePartsAreNotDoubted) {
  EXPECT_EQ(
      doubts("<robot name='p'>" + link("base", "") + link("beam", body("3", "0.09", "0 0 0.5")) +
             "<joint name='j' type='continuous'><parent link='base'/><child link='beam'/>"
             "<origin xyz='0 0 0.001'/><axis xyz='0 1 0'/></joint></robot>"),
      std::vector<std::string>{});
}

TEST(DescriptionMessages, MassesInGramsAreDoubted) {
  EXPECT_EQ(theDoubt(arm("", body("1200", "0.01", "0.1 0 0"), body("900", "0.01", "0.1 0 0"))),
            "link 'upper': mass 1200 kg, the heaviest of a robot of 0.6 m and 2100 kg, more than "
            "steel of that size weighs: is it in g?");
  // A heavy industrial arm.
  EXPECT_EQ(doubts(arm("", body("400", "20", "0.1 0 0"), body("250", "9", "0.1 0 0"))),
            std::vector<std::string>{});
}

std::string slidingMachine(const std::string& first, const std::string& second, double travel) {
  const std::string limits = "<axis xyz='0 0 1'/><limit lower='0' upper='" +
                             std::to_string(travel) + "' effort='9' velocity='9'/>";
  const std::string text = "<robot name='s'>" + link("base", "") + link("x", first) +
                           link("y", second) + joint("jx", "base", "x", limits, "prismatic") +
                           joint("jy", "x", "y", limits, "prismatic") + "</robot>";
  return replaced(replaced(text, "xyz='0.3 0 0'", "xyz='0 0 0'"), "xyz='0.3 0 0'", "xyz='0 0 0'");
}

// How far it travels is the size of a Cartesian machine; bodies without extent have none.
TEST(DescriptionMessages, MassesOfSlidesAreJudgedByTheirTravel) {
  const std::string carriage = body("400", "1", "0 0 0"), tool = body("150", "1", "0 0 0");
  EXPECT_EQ(doubts(slidingMachine(carriage, tool, 3)), std::vector<std::string>{});
  EXPECT_EQ(doubts(slidingMachine(body("1500", "0", "0 0 0"), tool, 30)),
            std::vector<std::string>{});
  EXPECT_EQ(doubts(slidingMachine(body("1500", "0", "0 0 0"), body("9", "0", "0 0 0"), 0.1)),
            std::vector<std::string>{});
  EXPECT_EQ(doubts(slidingMachine(carriage, tool, 0)), std::vector<std::string>{});
  EXPECT_EQ(theDoubt(slidingMachine(body("1500", "1", "0 0 0"), tool, 0.2)),
            "link 'x': mass 1500 kg, the heaviest of a robot of 0.4 m and 1650 kg, more than steel "
            "of that size weighs: is it in g?");
}

// The hub of a wind turbine is 87.6 m above its foot, and the tower weighs accordingly.
TEST(DescriptionMessages, LargeMachinesAreNotInMillimetres) {
  const auto tower = [](const char* mass) {
    return "<robot name='t'>" + link("base", "") + link("tower", body(mass, "1.7e8", "0 0 40")) +
           link("rotor", body("110000", "3.8e7", "0 0 0")) +
           "<joint name='foot' type='fixed'><parent link='base'/><child link='tower'/></joint>"
           "<joint name='yaw' type='continuous'><parent link='tower'/><child link='rotor'/>"
           "<origin xyz='0 0 87.6'/><axis xyz='0 0 1'/></joint></robot>";
  };
  EXPECT_EQ(doubts(tower("347460")), std::vector<std::string>{});
}

TEST(DescriptionMessages, DegreesAreDoubted) {
  EXPECT_EQ(theDoubt(replaced(arm(), "lower='-3' upper='3'", "lower='-170' upper='170'")),
            "joint 'shoulder': limits from -170 to 170 rad: are they degrees?");
  EXPECT_EQ(theDoubt(replaced(arm(), "lower='-3' upper='3'", "lower='-90' upper='135'")),
            "joint 'shoulder': limits from -90 to 135 rad: are they degrees?");
  EXPECT_EQ(theDoubt(replaced(arm(), "xyz='0.3 0 0'", "xyz='0.3 0 0' rpy='0 -90 0'")),
            "joint 'shoulder': origin rpy '0 -90 0' rad: are they degrees?");
  for (const char* limits :
       {"lower='-6.28' upper='6.28'", "lower='-100' upper='100'", "lower='0' upper='31.4'",
        "lower='-1e6' upper='1e6'", "lower='0' upper='60'", "lower='0' upper='125'",
        "lower='0' upper='150'", "lower='-2' upper='150'"}) {
    EXPECT_EQ(doubts(replaced(arm(), "lower='-3' upper='3'", limits)), std::vector<std::string>{});
  }
}

TEST(DescriptionMessages, NamesAreEscapedAndCut) {
  const std::string odd = "a&#10;b\x1b[31m";
  EXPECT_EQ(refusal("<robot name='r'>" + link(odd) + link(odd) + "</robot>"),
            "link 'a\\nb\\x1b[31m': is described twice");
  const std::string name(100000, 'x');
  EXPECT_EQ(refusal("<robot name='r'>" + link(name) + link(name) + "</robot>"),
            "link '" + std::string(60, 'x') + "...': is described twice");
}

// Two parsers read a name: what one of them knows of it, the other finds.
TEST(DescriptionMessages, OddNamesAreReadAsTheyAre) {
  for (int code = 1; code < 256; ++code) {
    const std::string name = " a&#" + std::to_string(code) + ";b" +
                             (code < 128 ? "" : std::string(1, static_cast<char>(code)));
    const std::string urdf =
        replaced(replaced(arm(), "joint name='shoulder'", "joint name='" + name + "'"),
                 "xyz='0.3 0 0'", "xyz='0.3 0 0' rpy='0 0 1'");
    const Mechanism mechanism = readUrdf(urdf);
    const Joint& shoulder = mechanism.joint(0);
    EXPECT_NEAR(static_cast<double>(shoulder.R_PK(1, 0)), std::sin(1.0), 1e-15) << code;
    EXPECT_EQ(shoulder.name.substr(0, 2), " a") << code;
    if (code < 128) {
      EXPECT_EQ(shoulder.name, std::string(" a") + static_cast<char>(code) + "b");
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
