#include "virtual_work_dynamics/urdf_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {
namespace {

std::string link(const std::string& name, const std::string& mass = "1",
                 const std::string& moments = "1 1 1", const std::string& origin = "") {
  double ixx = 0, iyy = 0, izz = 0;
  std::sscanf(moments.c_str(), "%lf %lf %lf", &ixx, &iyy, &izz);
  return "<link name='" + name + "'><inertial>" + origin + "<mass value='" + mass +
         "'/><inertia ixx='" + std::to_string(ixx) + "' iyy='" + std::to_string(iyy) + "' izz='" +
         std::to_string(izz) + "' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& rest = "<axis xyz='0 0 1'/>") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><limit lower='-1' upper='1' effort='1' velocity='1'/>" +
         rest + "</joint>";
}

std::string robot(const std::string& content) {
  return "<robot name='r'>" + content + "</robot>";
}

std::string oneJoint(const std::string& type, const std::string& rest) {
  return robot(link("a") + link("b") + joint("j", type, "a", "b", rest));
}

// The message of what readUrdf throws; empty when it does not.
std::string refusal(const std::string& urdf) {
  try {
    readUrdf(urdf);
  } catch (const UrdfError& error) {
    return error.what();
  }
  return "";
}

void expectRefusal(const std::string& urdf, const std::string& part) {
  const std::string message = refusal(urdf);
  EXPECT_NE(message.find(part), std::string::npos) << "message: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << "more than one line: " << message;
}

int doubtsWith(const Mechanism& mechanism, const std::string& part) {
  int count = 0;
  for (const Doubt& doubt : mechanism.doubts()) {
    count += doubt.text.find(part) != std::string::npos;
  }
  return count;
}

TEST(UrdfReader, LimitsAreThoseOfTheDescription) {
  const auto limits = [](const std::string& type, const std::string& limit) {
    const Mechanism read = readUrdf(robot(link("a") + link("b") + "<joint name='j' type='" + type +
                                          "'><parent link='a'/><child link='b'/>"
                                          "<axis xyz='0 0 1'/><limit effort='1' velocity='1' " +
                                          limit + "/></joint>"));
    return Eigen::Vector2d(read.joints()[0].lower, read.joints()[0].upper);
  };
  EXPECT_EQ(limits("revolute", "lower='-0.5' upper='5'"), Eigen::Vector2d(-0.5, 5));
  EXPECT_EQ(limits("prismatic", "lower='1' upper='2'"), Eigen::Vector2d(1, 2));
  EXPECT_EQ(limits("revolute", ""), Eigen::Vector2d(0, 0));
  EXPECT_EQ(limits("revolute", "lower='2' upper='1'"), Eigen::Vector2d(0, 0));
  EXPECT_EQ(limits("continuous", "lower='-1' upper='1'"), Eigen::Vector2d(0, 0));
}

TEST(UrdfReader, LimitsOfEffortAndSpeedAreThoseOfTheDescriptionAndZeroIsNone) {
  const auto limits = [](const std::string& type, const std::string& limit) {
    const Mechanism read = readUrdf(robot(
        link("a") + link("b") + "<joint name='j' type='" + type +
        "'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' " +
        limit + "/></joint>"));
    return Eigen::Vector2d(read.joints()[0].effort_limit, read.joints()[0].velocity_limit);
  };
  EXPECT_EQ(limits("revolute", "effort='738' velocity='2.5'"), Eigen::Vector2d(738, 2.5));
  EXPECT_EQ(limits("continuous", "effort='12' velocity='0'"), Eigen::Vector2d(12, 0));
  EXPECT_EQ(limits("prismatic", "effort='-1' velocity='3'"), Eigen::Vector2d(0, 3));
  EXPECT_EQ(limits("fixed", "effort='5' velocity='5'"), Eigen::Vector2d(0, 0));
}

TEST(UrdfReader, OrdersDepthFirstByJointName) {
  const Mechanism mechanism =
      readUrdf(robot(link("base") + link("z") + link("a") + link("m") + link("tip") +
                     joint("j_z", "revolute", "base", "z") + joint("j_b", "fixed", "base", "a") +
                     joint("j_m", "prismatic", "a", "m") + joint("j_a", "continuous", "z", "tip")));
  std::vector<std::string> names;
  for (const Joint& each : mechanism.joints()) names.push_back(each.name);
  EXPECT_EQ(names, (std::vector<std::string>{"j_b", "j_m", "j_z", "j_a"}));
  EXPECT_EQ(mechanism.coordinateNames(), (std::vector<std::string>{"j_m", "j_z", "j_a"}));
  EXPECT_EQ(mechanism.links()[0].name, "base");
  EXPECT_EQ(mechanism.links()[2].name, "m");
  EXPECT_EQ(mechanism.joints()[3].parent_link, 3);
  EXPECT_EQ(mechanism.joints()[1].type, JointType::kPrismatic);
}

TEST(UrdfReader, KeepsTheRootLinksInertia) {
  const Mechanism mechanism = readUrdf(oneJoint("revolute", "<axis xyz='0 0 1'/>"));
  EXPECT_EQ(mechanism.links()[0].mass, 1);
}

TEST(UrdfReader, RotatesInertialFramesByTheTextsAngles) {
  const Mechanism mechanism = readUrdf(
      robot(link("a", "2", "1 2 2.5", "<origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/>")));
  const Link& a = mechanism.links()[0];
  EXPECT_EQ(a.p_KoCm_K, Vector3l(1, 2, 3));
  // A quarter turn about z swaps the moments about x and y; the double nearest to pi/2 misses it by
  // 6.1e-17, and so do the products of inertia.
  EXPECT_NEAR(static_cast<double>(a.inertia_Cm_K(0, 0)), 2, 1e-15);
  EXPECT_NEAR(static_cast<double>(a.inertia_Cm_K(1, 1)), 1, 1e-15);
  EXPECT_NEAR(static_cast<double>(a.inertia_Cm_K(0, 1)), -6.123233995736766e-17, 1e-19);
}

TEST(UrdfReader, AppliesRollPitchYawAboutFixedAxes) {
  const Mechanism mechanism =
      readUrdf(oneJoint("fixed", "<origin rpy='0.3 -0.7 1.9' xyz='0 0 0'/>"));
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(1.9, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(-0.7, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  EXPECT_LE((mechanism.joints()[0].R_PK.cast<double>() - expected).norm(), 1e-15);
}

TEST(UrdfReader, ResolvesMimicChains) {
  const Mechanism mechanism = readUrdf(
      robot(link("a") + link("b") + link("c") + link("d") + joint("j1", "revolute", "a", "b") +
            joint("j2", "revolute", "b", "c",
                  "<axis xyz='0 0 1'/><mimic joint='j3' multiplier='2' offset='0.5'/>") +
            joint("j3", "revolute", "c", "d",
                  "<axis xyz='0 0 1'/><mimic joint='j1' multiplier='-3' offset='0.25'/>")));
  EXPECT_EQ(mechanism.coordinateNames(), std::vector<std::string>{"j1"});
  const Joint& j2 = mechanism.joints()[1];
  EXPECT_TRUE(j2.mimics);
  EXPECT_EQ(j2.coordinate, 0);
  EXPECT_EQ(j2.multiplier, -6);
  EXPECT_EQ(j2.offset, 1.0);  // 2 * 0.25 + 0.5
}

TEST(UrdfReader, NormalisesAxesWithADoubt) {
  const Mechanism mechanism = readUrdf(oneJoint("revolute", "<axis xyz='0 3 4'/>"));
  EXPECT_LE((mechanism.joints()[0].axis_K - Vector3l(0, 0.6L, 0.8L)).norm(), 1e-18L);
  EXPECT_EQ(doubtsWith(mechanism, "'j'"), 1);
  EXPECT_FALSE(mechanism.doubts().front().about_inertia);
}

TEST(UrdfReader, RefusesBrokenDescriptions) {
  expectRefusal("", "empty");
  expectRefusal("not xml", "broken");
  expectRefusal("<robot name='r'>", "broken");
  expectRefusal(robot(link("a") + link("b")), "links 'a' and 'b' are all roots");
  expectRefusal(robot(link("a") + link("b") + joint("j", "revolute", "a", "nowhere")), "nowhere");
  expectRefusal(robot(link("a", "heavy")), "heavy");
}

TEST(UrdfReader, RefusesWhatIsNoTreeByName) {
  const std::string links = link("a") + link("b") + link("c") + link("d");
  expectRefusal(robot(links + joint("i", "revolute", "a", "b") + joint("j", "revolute", "a", "d") +
                      joint("k", "revolute", "a", "c") + joint("l", "revolute", "b", "c")),
                "link 'c': is the child of two joints, 'k' and 'l'");
  expectRefusal(robot(links + joint("i", "revolute", "a", "b") + joint("j", "revolute", "c", "d") +
                      joint("k", "revolute", "d", "c")),
                "link 'c': its parents form a loop");
  expectRefusal(robot(link("a") + link("b") + joint("j", "revolute", "b", "b")),
                "link 'b': its parents form a loop");
  expectRefusal(robot(link("a") + link("b") + joint("j", "revolute", "a", "b") +
                      joint("k", "revolute", "b", "b")),
                "link 'b': is the child of two joints");
  expectRefusal(robot(link("a") + link("b") + joint("", "revolute", "a", "b")), "link 'b'");
  // urdfdom would not free these links, which own one another.
  expectRefusal(robot(link("a") + link("b") + joint("j", "revolute", "a", "b") +
                      joint("k", "revolute", "b", "a")),
                "");
}

TEST(UrdfReader, ReadsVeryLongChains) {
  constexpr int kLinks = 100000;  // a recursive walk would exhaust the stack
  std::string content = link("l0");
  for (int i = 1; i < kLinks; ++i) {
    const std::string number = std::to_string(i);
    content += "<link name='l" + number + "'/>" +
               joint("j" + number, "fixed", "l" + std::to_string(i - 1), "l" + number, "");
  }
  EXPECT_EQ(readUrdf(robot(content)).links().size(), static_cast<std::size_t>(kLinks));
}

// Each joint mimics the next one; following every chain by itself would take days.
TEST(UrdfReader, ResolvesVeryLongMimicChains) {
  constexpr int kJoints = 100000;
  std::string content = link("l0");
  for (int i = 1; i <= kJoints; ++i) {
    const std::string number = std::to_string(i);
    const std::string mimic =
        i == kJoints ? ""
                     : "<mimic joint='j" + std::to_string(i + 1) + "' multiplier='-1' offset='1'/>";
    content += "<link name='l" + number + "'/>" +
               joint("j" + number, "continuous", "l0", "l" + number, "<axis xyz='0 0 1'/>" + mimic);
  }
  const Mechanism mechanism = readUrdf(robot(content));
  const Joint& first = mechanism.joint(mechanism.jointIndex("j1"));
  EXPECT_EQ(mechanism.coordinateNames(), std::vector<std::string>{"j100000"});
  EXPECT_EQ(first.multiplier, -1);  // an odd number of signs
  EXPECT_EQ(first.offset, 1);
}

TEST(UrdfReader, RefusesImpossibleNumbersByName) {
  expectRefusal(robot(link("a", "-1")), "'a': mass -1 kg");
  expectRefusal(robot(link("a", "-1e-9")), "'a': mass -1e-09 kg");
  expectRefusal(robot(link("a", "nan")), "link 'a': mass");
  expectRefusal(robot(link("a", "1e999")), "link 'a': mass");
  expectRefusal(oneJoint("revolute", "<axis xyz='0 0 0'/>"), "'j': axis (0, 0, 0)");
  expectRefusal(oneJoint("prismatic", "<axis xyz='0 0 0'/>"), "'j': axis (0, 0, 0)");
}

TEST(UrdfReader, RefusesUnsupportedJointsByName) {
  expectRefusal(oneJoint("flying", ""), "'j': type 'flying' is not one of");
  expectRefusal(oneJoint("planar", "<axis xyz='0 0 0'/>"), "'j': axis (0, 0, 0)");
  expectRefusal(robot(link("a") + link("b") + joint("ground", "revolute", "a", "b")), "'ground'");
}

TEST(UrdfReader, RefusesBadMimicsByName) {
  const std::string axis = "<axis xyz='0 0 1'/>";
  const auto mimicking = [&](const std::string& first, const std::string& second) {
    return robot(link("a") + link("b") + link("c") +
                 joint("j1", "revolute", "a", "b", axis + "<mimic joint='" + first + "'/>") +
                 joint("j2", second == "fixed" ? "fixed" : "revolute", "b", "c",
                       second == "fixed" ? "" : axis + "<mimic joint='" + second + "'/>"));
  };
  expectRefusal(mimicking("j2", "j1"), "'j1': its <mimic> leads in a cycle");
  expectRefusal(mimicking("j1", "j1"), "'j1': its <mimic> leads in a cycle");
  expectRefusal(mimicking("elbow", "j1"), "'elbow'");
  expectRefusal(mimicking("j2", "fixed"), "mimics fixed joint 'j2'");
}

std::string chain(const std::string& moments) {
  return robot(link("a") + link("b", "1", moments) + joint("j", "revolute", "a", "b"));
}

TEST(UrdfReader, DoubtsImpossibleInertias) {
  EXPECT_EQ(readUrdf(chain("1 1 1")).doubts().size(), 0u);
  EXPECT_EQ(readUrdf(chain("0 1 1")).doubts().size(), 0u);  // slender rod
  EXPECT_EQ(readUrdf(chain("0 0 0")).doubts().size(), 0u);  // point
  EXPECT_EQ(doubtsWith(readUrdf(chain("-0.5 1 1")), "link 'b': negative principal moment"), 1);
  EXPECT_EQ(doubtsWith(readUrdf(chain("3 1 1")), "link 'b': principal moments"), 1);
  EXPECT_TRUE(readUrdf(chain("3 1 1")).doubts().front().about_inertia);
}

TEST(UrdfReader, TriangleToleranceIsOneBillionthOfTheTrace) {
  const auto withExcess = [](double excess) {
    char izz[40];
    std::snprintf(izz, sizeof izz, "%.17g", 2 + excess);
    std::string urdf = chain("1 1 7");
    urdf.replace(urdf.find("izz='7.000000'"), 14, std::string("izz='") + izz + "'");
    return readUrdf(urdf).doubts().size();
  };
  EXPECT_EQ(withExcess(3e-9), 0u);  // trace 4
  EXPECT_EQ(withExcess(5e-9), 1u);
}

TEST(UrdfReader, DoubtsMasslessMovingLeavesOnly) {
  const std::string massless = "<link name='m'/>";
  EXPECT_EQ(doubtsWith(readUrdf(robot(link("a") + massless + joint("j", "revolute", "a", "m"))),
                       "moved by joint 'j' but has no mass"),
            1);
  // Welded to something: no body of its own.
  EXPECT_TRUE(
      readUrdf(robot(link("a") + massless + joint("j", "fixed", "a", "m"))).doubts().empty());
  // In the middle of a chain a massless link passes its motion on to what follows.
  EXPECT_TRUE(readUrdf(robot(link("a") + massless + link("b") + joint("j", "revolute", "a", "m") +
                             joint("k", "revolute", "m", "b")))
                  .doubts()
                  .empty());
  // The mass of the moving body sits on a welded link.
  EXPECT_TRUE(readUrdf(robot(link("a") + massless + link("b") + joint("j", "revolute", "a", "m") +
                             joint("k", "fixed", "m", "b")))
                  .doubts()
                  .empty());
}

TEST(UrdfReader, StrictScenesRefuseDoubtfulInertias) {
  Scene scene;
  scene.strict_inertia = true;
  EXPECT_NO_THROW(InverseDynamics(readUrdf(chain("1 1 1")), scene));
  try {
    const InverseDynamics dynamics(readUrdf(chain("3 1 1")), scene);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("link 'b'"), std::string::npos);
  }
}

TEST(UrdfReader, NamesUnreadableFiles) {
  EXPECT_THROW(readUrdfFile("/nowhere/robot.urdf"), FileError);
  EXPECT_THROW(readUrdfFile("/tmp"), FileError);
}

}  // namespace
}  // namespace virtual_work_dynamics
