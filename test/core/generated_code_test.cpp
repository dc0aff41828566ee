#include "virtual_work_dynamics/generated_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "generated_cases.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "tested_build.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

Mechanism robotWithFreeJoints() {
  RobotBuilder builder(5);
  builder.add(builder.add(builder.add(0)));
  return builder.build();
}

TEST(GeneratedCode, HasTheBitsOfComputeForRandomRobotsOfEveryJointType) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Mechanism mechanism = readUrdf(RandomRobot(seed, 9).urdf());
    SCOPED_TRACE(seed);
    expectSameBits(caseOf(mechanism, Scene(), seed % 2 == 1), "cc", std::string("-O1 ") + kStrictC);
  }
}

TEST(GeneratedCode, HasTheBitsOfComputeInMovingRootsWithWrenchesAndTerms) {
  const Mechanism mechanism = readUrdf(RandomRobot(6, 9).urdf());
  expectSameBits(caseOf(mechanism, busyScene(mechanism), false), "cc",
                 std::string("-O1 ") + kStrictC);
}

TEST(GeneratedCode, HasTheBitsOfComputeForFreeJoints) {
  Scene scene;
  JointTypeEntry entry;
  entry.joint = "joint_2";
  entry.type = CompoundType::kSpherical;
  scene.joint_types = {entry};
  const Mechanism mechanism = withJointTypes(robotWithFreeJoints(), scene);
  ASSERT_EQ(mechanism.orientations(), 1u);
  expectSameBits(caseOf(mechanism, scene, true), "cc", std::string("-O1 ") + kStrictC);
}

TEST(GeneratedCode, HasTheBitsOfComputeFarOut) {
  GeneratedCase of = caseOf(readUrdf(RandomRobot(2, 8).urdf()), Scene(), true);
  of.farthest = 2e6;  // half of the angles are beyond the polynomials' range
  expectSameBits(of, "cc", "-O1 ");
}

TEST(GeneratedCode, HasTheBitsOfComputeForMimicJointsNearAndFar) {
  std::string urdf = pendulumUrdf();
  const std::string end = "</joint>\n</robot>";
  urdf.replace(urdf.find(end), end.size(),
               "<mimic joint='joint_1' multiplier='1.3' offset='0.7'/>" + end);
  GeneratedCase of = caseOf(readUrdf(urdf), Scene(), true);
  ASSERT_EQ(of.mechanism.coordinates().size(), 1u);
  ASSERT_NE(generateCode(of.mechanism, of.scene, of.request).source.find("rest[0] ="),
            std::string::npos);
  expectSameBits(of, "cc", std::string("-O1 ") + kStrictC);
  of.farthest = 2e6;
  expectSameBits(of, "cc", "-O1 ");
}

TEST(GeneratedCode, HasTheBitsOfComputeInManyFunctions) {
  GeneratedCodeOptions how;
  how.name = "in_parts";
  how.operations_of_function = 60;
  const Mechanism mechanism = readUrdf(RandomRobot(8, 12).urdf());
  const GeneratedCase of = caseOf(mechanism, busyScene(mechanism), true);
  EXPECT_GT(generateCode(of.mechanism, of.scene, of.request, how).functions, 5u);
  expectSameBits(of, "cc", std::string("-O1 ") + kStrictC, how);
}

TEST(GeneratedCode, OfAStaticSceneReadsNoVelocities) {
  Scene scene;
  scene.static_motion = true;
  const Mechanism mechanism = readUrdf(RandomRobot(2, 8).urdf());
  const GeneratedCase of = caseOf(mechanism, scene, true);
  const std::string source = generateCode(of.mechanism, of.scene, of.request).source;
  EXPECT_EQ(source.find("qd[0]"), std::string::npos);
  EXPECT_EQ(source.find("qdd[0]"), std::string::npos);
  expectSameBits(of, "cc", std::string("-O1 ") + kStrictC);
}

TEST(GeneratedCode, TakesFewerOperationsThanThePlan) {
  const Mechanism mechanism = readUrdfFile(std::string(kSourceFolder) + "/urdf/six_axis_arm.urdf");
  const GeneratedCode code = generateCode(mechanism, Scene(), Request());
  const PlanSummary plan = InverseDynamics(mechanism, Scene(), Request()).summary();
  EXPECT_LT(code.multiplications, plan.multiplications);
  EXPECT_LT(code.additions, plan.additions);
  EXPECT_EQ(code.sines_and_cosines, plan.sines_and_cosines);
  EXPECT_EQ(code.functions, 1u);
}

// Joints of any names, one after the other.
Mechanism robotOf(const std::vector<std::string>& names) {
  RobotBuilder builder(3);
  for (std::size_t i = 0; i < names.size(); ++i) builder.add(static_cast<int>(i));
  const Mechanism plain = builder.build();
  std::vector<Joint> joints = plain.joints();
  for (std::size_t i = 0; i < names.size(); ++i) joints[i].name = names[i];
  return Mechanism("*/ int main; /*", plain.links(), joints);
}

TEST(GeneratedCode, MakesIdentifiersOfAnyNamesThatDiffer) {
  const std::vector<std::string> names = {"a-b",          "a.b",      "a_b", "A B",  "1st",  "int",
                                          "*/ #error /*", "?\?/",     "\"",  "\\",   "a\nb", "",
                                          "\xc3\xa4rmel", "a__b\x7f", "_",   "a_b_2"};
  const GeneratedCase of = caseOf(robotOf(names), Scene(), true);
  GeneratedCodeOptions how;
  how.name = "odd";
  how.origin = {"from /* \"somewhere\" */ ?\?/", "\\"};
  const GeneratedCode code = generateCode(of.mechanism, of.scene, of.request, how);
  std::string uses =
      "#include \"odd.h\"\n#include <string.h>\nint test(int place);\n"
      "int test(int place) {\n  const char *names[] = ODD_COORDINATE_NAMES;\n"
      "  switch (place) {\n";
  for (const char* constant :
       {"A_B", "A_B_2", "A_B_3", "A_B_4", "1ST", "INT", "ERROR", "NAMELESS", "NAMELESS_2",
        "NAMELESS_3", "A_B_5", "NAMELESS_4", "RMEL", "A_B_6", "NAMELESS_5", "A_B_2_2"}) {
    uses += std::string("    case ODD_Q_") + constant + ": return (int)strlen(names[place]);\n";
  }
  GeneratedCode with_uses = code;
  with_uses.source += uses + "  }\n  return 0;\n}\n";
  GeneratedProgram program(with_uses, "odd", inputCounts(of), outputCounts(of));
  EXPECT_EQ(program.compile("cc", std::string("-O0 ") + kStrictC), "");
  EXPECT_EQ(program.compile("c++", std::string("-O0 ") + kStrictCpp), "");
  expectSameBits(of, "cc", "-O1 ", how, 20);
}

std::string refusal(const Mechanism& mechanism, const Scene& scene, const Request& request,
                    const std::string& name = "robot") {
  GeneratedCodeOptions how;
  how.name = name;
  try {
    generateCode(mechanism, scene, request, how);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(GeneratedCode, IsRefusedInOneLineWhereItCannotBe) {
  const Mechanism pendulum = readUrdf(pendulumUrdf());
  Request nothing;
  nothing.efforts = false;
  EXPECT_EQ(refusal(pendulum, Scene(), nothing),
            "no code can be generated, as neither efforts nor reactions are asked for");
  EXPECT_EQ(refusal(readUrdf("<robot name='stone'><link name='stone'/></robot>"), Scene(), {}),
            "no code can be generated, as no joint moves");
  EXPECT_EQ(refusal(pendulum, Scene(), {}, "2nd"),
            "no code can be generated under the name '2nd': a letter is needed, then letters, "
            "digits and single underscores");
}

}  // namespace
}  // namespace virtual_work_dynamics
