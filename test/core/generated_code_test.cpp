#include "virtual_work_dynamics/generated_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "generated_program.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "tested_build.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using Numbers = std::vector<double>;

// A robot in a scene, and samples of all that its function reads.
struct Case {
  Mechanism mechanism;
  Scene scene;
  Request request;
  double farthest;  // position, rad or m
};

Case caseOf(const Mechanism& mechanism, const Scene& scene, bool child_axes) {
  Case made{mechanism, scene, {}, 3};
  (child_axes ? made.request.child_axes : made.request.root_axes) =
      requestedReactions(mechanism, scene);
  return made;
}

std::vector<int> inputCounts(const Case& of) {
  const int coordinates = static_cast<int>(of.mechanism.coordinates().size());
  std::vector<int> counts(3, coordinates);
  if (of.scene.root_moves) counts.push_back(RootState::kNumbers);
  const int orientations = static_cast<int>(of.mechanism.orientations());
  if (orientations > 0) counts.push_back(4 * orientations);
  const int wrenches = static_cast<int>(of.scene.applied_wrenches.size());
  if (wrenches > 0) counts.push_back(6 * wrenches);
  return counts;
}

std::vector<int> outputCounts(const Case& of) {
  std::vector<int> counts;
  const auto add = [&](std::size_t count) {
    if (count > 0) counts.push_back(static_cast<int>(count));
  };
  add(of.request.efforts ? of.mechanism.coordinates().size() : 0);
  add(6 * of.request.child_axes.size());
  add(6 * of.request.root_axes.size());
  return counts;
}

template <typename Vector>
void append(Numbers& numbers, const Vector& vector) {
  numbers.insert(numbers.end(), vector.data(), vector.data() + vector.size());
}

// Makes a sample, appends it to `row`, and what the library computes of it to `results`.
void addSample(const Case& of, const InverseDynamics& dynamics, Workspace& workspace,
               std::mt19937& generator, Numbers& row, Numbers& results) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto fill = [&](auto& vector, double size) {
    for (Eigen::Index i = 0; i < vector.size(); ++i) vector[i] = size * uniform(generator);
    append(row, vector);
  };
  Motion motion(dynamics.coordinates(), dynamics.orientations());
  fill(motion.q, of.farthest);
  fill(motion.qd, 3);
  fill(motion.qdd, 3);
  if (of.scene.root_moves) {
    motion.root.angular_velocity = Eigen::Vector3d(uniform(generator), 1, uniform(generator));
    motion.root.angular_acceleration = Eigen::Vector3d(2, uniform(generator), -1);
    motion.root.acceleration = Eigen::Vector3d(uniform(generator), 0.5, 3);
    const RootState state = dynamics.rootState(motion.root);
    row.insert(row.end(), state.data(), state.data() + RootState::kNumbers);
  }
  for (Eigen::Quaterniond& orientation : motion.orientations) {
    orientation = Eigen::Quaterniond(uniform(generator), uniform(generator), 1, 0.5).normalized();
    append(row, orientation.coeffs());
  }
  Load load(of.scene);
  for (Wrench& wrench : load.wrenches) {
    fill(wrench.force, 5);
    fill(wrench.torque, 5);
  }
  dynamics.compute(motion, load, workspace);
  append(results, workspace.effort());
  for (const auto* wrenches : {&workspace.childAxes(), &workspace.rootAxes()}) {
    for (const Wrench& wrench : *wrenches) {
      append(results, wrench.force);
      append(results, wrench.torque);
    }
  }
}

// Numbers that are not the same bits; the sign of a zero is free.
std::size_t differences(const Numbers& made, const Numbers& expected) {
  if (made.size() != expected.size()) return std::max(made.size(), expected.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < made.size(); ++i) count += made[i] == expected[i] ? 0 : 1;
  return count;
}

// Compiles and runs the code of a case, and counts results with other bits than the library's.
void expectSameBits(const Case& of, const std::string& compiler, const std::string& options,
                    const GeneratedCodeOptions& how = {}, std::size_t samples = 203) {
  GeneratedProgram program(generateCode(of.mechanism, of.scene, of.request, how), how.name,
                           inputCounts(of), outputCounts(of));
  const InstructionSet set = comparedInstructions();
  ASSERT_EQ(program.compile(compiler, options + optionsFor(set)), "");
  const InverseDynamics dynamics(of.mechanism, of.scene, of.request, set);
  Workspace workspace = dynamics.makeWorkspace();
  std::mt19937 generator(11);
  Numbers rows, expected;
  for (std::size_t i = 0; i < samples; ++i) {
    Numbers results;
    addSample(of, dynamics, workspace, generator, rows, results);
    for (int twice = 0; twice < 2; ++twice) {
      expected.insert(expected.end(), results.begin(), results.end());
    }
  }
  EXPECT_EQ(differences(program.run(rows), expected), 0u) << "of " << expected.size();
}

Mechanism robotWithFreeJoints() {
  RobotBuilder builder(5);
  builder.add(builder.add(builder.add(0)));
  return builder.build();
}

Scene busyScene(const Mechanism& mechanism) {
  Scene scene;
  scene.gravity = {0.3, -1, -9.6};
  scene.root_moves = true;
  const std::string& last = mechanism.links().back().name;
  AppliedWrench wrench;
  wrench.link = last;
  wrench.at = {0.1, -0.2, 0.3};
  wrench.axes = Axes::kRoot;
  wrench.force = {1, 2, 3};
  scene.applied_wrenches.push_back(wrench);
  wrench.axes = Axes::kLink;
  scene.applied_wrenches.push_back(wrench);
  JointTerms terms;
  terms.joint = mechanism.joint(mechanism.coordinates().front()).name;
  terms.stiffness = 3;
  terms.rest = 0.4;
  terms.damping = 0.2;
  terms.coulomb = 0.7;
  terms.coulomb_velocity = 2;
  terms.rotor_inertia = 0.05;
  terms.offset = -0.6;
  scene.joints = {terms};
  return scene;
}

TEST(GeneratedCode, HasTheBitsOfComputeForRandomRobotsOfEveryJointType) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Mechanism mechanism = readUrdf(RandomRobot(seed, 9).urdf());
    SCOPED_TRACE(seed);
    expectSameBits(caseOf(mechanism, Scene(), seed % 2 == 1), "cc", std::string("-O1 ") + kStrictC);
  }
}

TEST(GeneratedCode, HasTheBitsOfComputeAsCpp) {
  const Mechanism mechanism = readUrdf(RandomRobot(4, 8).urdf());
  expectSameBits(caseOf(mechanism, busyScene(mechanism), true), "c++",
                 std::string("-O2 ") + kStrictCpp);
}

TEST(GeneratedCode, HasTheBitsOfComputeFromOtherCompilers) {
  const Mechanism mechanism = readUrdf(RandomRobot(2, 8).urdf());
  int compilers = 0;
  for (const char* const compiler : {"gcc", "clang", "clang-14"}) {
    if (!isThere(compiler)) continue;
    ++compilers;
    SCOPED_TRACE(compiler);
    // Contraction is the compilers' default for what is not ISO C: it must not reach the results.
    expectSameBits(caseOf(mechanism, busyScene(mechanism), false), compiler, "-O2 -std=gnu99 ");
  }
  if (compilers == 0) GTEST_SKIP() << "neither gcc nor clang is there";
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
  Case of = caseOf(readUrdf(RandomRobot(2, 8).urdf()), Scene(), true);
  of.farthest = 2e6;  // half of the angles are beyond the polynomials' range
  expectSameBits(of, "cc", "-O1 ");
}

TEST(GeneratedCode, HasTheBitsOfComputeForMimicJointsNearAndFar) {
  std::string urdf = pendulumUrdf();
  const std::string end = "</joint>\n</robot>";
  urdf.replace(urdf.find(end), end.size(),
               "<mimic joint='joint_1' multiplier='1.3' offset='0.7'/>" + end);
  Case of = caseOf(readUrdf(urdf), Scene(), true);
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
  const Case of = caseOf(mechanism, busyScene(mechanism), true);
  EXPECT_GT(generateCode(of.mechanism, of.scene, of.request, how).functions, 5u);
  expectSameBits(of, "cc", std::string("-O1 ") + kStrictC, how);
}

TEST(GeneratedCode, RunsUnderSanitizers) {
  const Mechanism mechanism = readUrdf(RandomRobot(2, 8).urdf());
  Case of = caseOf(mechanism, busyScene(mechanism), true);
  of.farthest = 2e6;
  expectSameBits(of, "cc", "-O1 -g0 -fsanitize=address,undefined -fno-sanitize-recover=all ");
}

TEST(GeneratedCode, OfAStaticSceneReadsNoVelocities) {
  Scene scene;
  scene.static_motion = true;
  const Mechanism mechanism = readUrdf(RandomRobot(2, 8).urdf());
  const Case of = caseOf(mechanism, scene, true);
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
  const Case of = caseOf(robotOf(names), Scene(), true);
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
  const std::string why = ": the forces take a factorization whose steps depend on the position";
  Scene scene;
  scene.closures.resize(1);
  scene.closures[0].name = "loop";
  EXPECT_EQ(refusal(pendulum, scene, {}),
            "no code can be generated, as closure 'loop' closes a loop" + why);
  scene = Scene();
  scene.springs.resize(1);
  scene.springs[0].name = "coil";
  EXPECT_EQ(refusal(pendulum, scene, {}),
            "no code can be generated, as spring 'coil' acts between two points" + why);
  scene = Scene();
  scene.actuated = std::vector<std::string>{"joint_1"};
  EXPECT_EQ(refusal(pendulum, scene, {}),
            "no code can be generated, as not all joints are actuated" + why);
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
