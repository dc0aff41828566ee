#include "generated_loops.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "generate/expression_graph.h"
#include "loop_examples.h"
#include "random_loops.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kFar = 3, kNear = 0.3;  // rad or m

// Samples about the assembly, near and far: half of them close the loops, where that is possible.
void addSamples(GeneratedLoops& loops, int count) {
  std::mt19937 generator(7);
  ClosedLoopDynamics::Workspace workspace = loops.dynamics().makeWorkspace();
  for (int i = 0; i < count; ++i) {
    Motion motion =
        loops.motionAbout(loops.dynamics().assembly(), i % 4 == 0 ? kFar : kNear, generator);
    Motion closed = motion;
    if (i % 2 == 1 && loops.dynamics().complete(closed, workspace)) motion = closed;
    loops.add(motion, generator);
  }
}

void expectSame(const GeneratedLoops::Finding& found, std::size_t least_computed) {
  EXPECT_EQ(found.compiler, "");
  EXPECT_GE(found.computed, least_computed);
  EXPECT_EQ(found.differences, 0u);
  EXPECT_EQ(found.unsaid, 0u);
  EXPECT_EQ(found.wrongly_close, 0u);
  EXPECT_EQ(found.refused_regular, 0u);
  EXPECT_EQ(found.not_zero, 0u);
}

// Bits are those of builds with fused operations; without, sums are in another order.
bool fuses() {
  return comparedInstructions() != InstructionSet::kBaseline &&
         chosenInstructionSet() != InstructionSet::kBaseline;
}

class GeneratedLoopExamples : public testing::TestWithParam<const char*> {};

TEST_P(GeneratedLoopExamples, HaveTheBitsOfCompute) {
  if (!fuses()) GTEST_SKIP() << "there are no fused operations";
  const LoopExample example(GetParam());
  for (const bool child_axes : {true, false}) {
    GeneratedLoops loops(example.mechanism, example.scene, child_axes);
    constexpr int kSamples = 500;
    addSamples(loops, kSamples);
    expectSame(loops.run("cc", std::string("-O1 ") + kStrictC), kSamples);
  }
}

INSTANTIATE_TEST_SUITE_P(All, GeneratedLoopExamples,
                         testing::Values("four_bar", "slider_crank", "planar_3rrr", "stewart_gough",
                                         "spatial_parallelogram", "andrews_squeezer",
                                         "coupled_wrist", "excavator"));

// Trees with closures of all types, cylinders, springs and dampers, whose residual coordinates are
// as many as there are freedoms.
TEST(GeneratedLoops, HaveTheBitsOfComputeForRandomScenes) {
  if (!fuses()) GTEST_SKIP() << "there are no fused operations";
  std::size_t computed = 0;
  std::set<ClosureType> types;
  for (unsigned seed = 0; seed < 32; ++seed) {
    SCOPED_TRACE(seed);
    Case random = RandomLoops(seed, seed % 2 == 1).next();
    random.scene.redundancy = Redundancy();
    random.scene.actuated.emplace();
    random.scene.free_motion = true;
    for (PointSpring& spring : random.scene.springs) spring.damping = seed % 3;
    bool made = false;
    try {
      GeneratedLoops loops(random.mechanism, random.scene, seed % 3 == 0);
      made = true;
      std::mt19937 generator(seed);
      for (int i = 0; i < 60; ++i) {
        loops.add(loops.motionAbout(random.motion.q, i % 3 == 0 ? kFar : kNear, generator),
                  generator);
      }
      const GeneratedLoops::Finding found = loops.run("cc", "-O0 ");
      expectSame(found, 0);
      computed += found.computed;
      for (const Closure& closure : random.scene.closures) types.insert(closure.type);
    } catch (const SceneError& error) {  // what touches, and loops that cannot be held
      EXPECT_FALSE(made) << error.what();
    }
  }
  EXPECT_GT(computed, 500u);
  EXPECT_GE(types.size(), 7u);
}

// Along lines between positions, most of which pass close to singular ones.
TEST_P(GeneratedLoopExamples, SayWhereTheRankIsInDoubtOnTheWayToSingularPositions) {
  if (!fuses()) GTEST_SKIP() << "there are no fused operations";
  const LoopExample example(GetParam());
  GeneratedLoops loops(example.mechanism, example.scene, true);
  std::mt19937 generator(17);
  const Eigen::VectorXd& assembly = loops.dynamics().assembly();
  int doubtful = 0;
  for (int i = 0; i < 6; ++i) {
    const Motion from = loops.motionAbout(assembly, kFar, generator);
    const Motion to = loops.motionAbout(assembly, kFar, generator);
    doubtful += loops.addTowardsSingular(from, to, generator);
  }
  const bool linear = example.scene.closures.empty();  // couplings alone have none
  EXPECT_GE(doubtful, linear ? 0 : 10);
  expectSame(loops.run("cc", std::string("-O1 ") + kStrictC), 0);
}

// Without fused operations sums are in another order than the library's.
TEST_P(GeneratedLoopExamples, AgreeWithinRoundingWithoutFusedOperations) {
  const LoopExample example(GetParam());
  GeneratedLoops loops(example.mechanism, example.scene, false);
  addSamples(loops, 200);
  const GeneratedLoops::Finding found = loops.run("cc", "-O1 ", false);
  EXPECT_EQ(found.compiler, "");
  EXPECT_GE(found.computed, 200u);
  EXPECT_LE(found.error, 16);  // seen: 3.5 in 20,000 samples of each
}

// A four-bar linkage whose links can come to lie in one line.
TEST(GeneratedLoops, SayWhereAPositionIsSingularOrCloseToIt) {
  if (!fuses()) GTEST_SKIP() << "there are no fused operations";
  LoopExample example("four_bar");
  example.scene.actuated = std::vector<std::string>{"rocker_joint"};
  example.scene.assembly.clear();
  for (const auto& [name, position] : fourBarAt(0)) {
    example.scene.assembly.push_back({name, static_cast<double>(position)});
  }
  GeneratedLoops loops(example.mechanism, example.scene, true);
  std::mt19937 generator(3);
  ClosedLoopDynamics::Workspace workspace = loops.dynamics().makeWorkspace();
  // Crank and coupler in line: 0.12 + 0.36 m to a pin that is 0.28 m from (0.4, 0) m.
  const double angle = std::acos((0.48 * 0.48 + 0.4 * 0.4 - 0.28 * 0.28) / (2 * 0.48 * 0.4));
  int regular = 0, close = 0, singular = 0;
  for (const double off : {0.0, 1e-16, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 3e-5, 1e-4, 1e-3, 0.1}) {
    Motion motion = loops.motionAbout(loops.dynamics().assembly(), 0, generator);
    // The crank is given here, so that the completion is regular.
    const std::vector<std::string>& names = example.mechanism.coordinateNames();
    std::vector<bool> given(3, false);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      given[i] = names[i] == "crank_joint";
      motion.q[at] = given[i] ? angle + off : names[i] == "rocker_joint" ? 2.0 : 0.0;
    }
    motion.qd.setZero();
    motion.qdd.setZero();
    loops.dynamics().complete(motion, given, workspace);
    loops.add(motion, generator);
    const Results& results = loops.workspace().results();
    const double condition = results.loops.determinacy.condition;
    ++(results.singular() || condition > 1e6 ? singular
       : condition > kCloseToSingular        ? close
                                             : regular);
  }
  EXPECT_GT(regular, 0);
  EXPECT_GT(close, 0);
  EXPECT_GT(singular, 1);
  expectSame(loops.run("cc", "-O1 "), 2);
}

TEST(GeneratedLoops, SayWhereNumbersAreNotFinite) {
  if (!fuses()) GTEST_SKIP() << "there are no fused operations";
  const LoopExample example("slider_crank");
  GeneratedLoops loops(example.mechanism, example.scene, true);
  std::mt19937 generator(3);
  Motion motion = loops.motionAbout(loops.dynamics().assembly(), 0.1, generator);
  loops.add(motion, generator);
  motion.qd[0] = 1e200;
  loops.add(motion, generator);
  motion.qd[0] = std::numeric_limits<double>::quiet_NaN();
  loops.add(motion, generator);
  motion = loops.motionAbout(loops.dynamics().assembly(), 0.1, generator);
  motion.q[0] = std::numeric_limits<double>::quiet_NaN();
  loops.add(motion, generator);
  const GeneratedLoops::Finding found = loops.run("cc", "-O1 ");
  expectSame(found, 2);
  EXPECT_EQ(found.computed, 2u);
}

TEST(GeneratedLoops, SayWhereASpringHasNoDirection) {
  if (!fuses()) GTEST_SKIP() << "there are no fused operations";
  const LoopExample example("four_bar");
  Scene scene;
  scene.springs.resize(1);
  scene.springs[0].name = "coil";
  scene.springs[0].link_a = example.mechanism.links()[0].name;
  scene.springs[0].link_b = example.mechanism.links()[1].name;
  scene.springs[0].at_a = {0.1, 0, 0};
  scene.springs[0].at_b = {0.1, 0, 0};
  scene.springs[0].stiffness = 50;
  for (const double rest_length : {0.05, 0.0}) {
    scene.springs[0].rest_length = rest_length;
    GeneratedLoops loops(example.mechanism, scene, false);
    std::mt19937 generator(3);
    Motion motion = loops.motionAbout(loops.dynamics().assembly(), 1, generator);
    loops.add(motion, generator);
    motion.q.setZero();
    loops.add(motion, generator);
    const GeneratedLoops::Finding found = loops.run("cc", "-O1 ");
    expectSame(found, 2);
    EXPECT_EQ(found.computed, rest_length > 0 ? 2u : 4u);
  }
}

TEST(GeneratedLoops, HaveTheBitsOfComputeInManyFunctionsUnderSanitizersAndFromAllCompilers) {
  if (!fuses()) GTEST_SKIP() << "there are no fused operations";
  if (compilers().empty()) GTEST_SKIP() << "neither gcc nor clang is there";
  for (const char* name : {"planar_3rrr", "excavator"}) {
    const LoopExample example(name);
    GeneratedLoops loops(example.mechanism, example.scene, true);
    loops.divide(150);
    EXPECT_GT(loops.code().functions, 1u);
    constexpr int kSamples = 100;
    addSamples(loops, kSamples);
    for (const std::string& compiler : compilers()) {
      SCOPED_TRACE(compiler + " of " + name);
      expectSame(loops.run(compiler,
                           "-O1 -g0 -fsanitize=address,undefined,float-divide-by-zero "
                           "-fno-sanitize-recover=all "),
                 kSamples);
      expectSame(loops.run(compiler, "-O2 -std=gnu99 "), kSamples);
    }
  }
}

TEST(GeneratedLoops, AreStrictFreestandingC) {
  if (compilers().empty()) GTEST_SKIP() << "neither gcc nor clang is there";
  static const std::set<std::string> kAllowed = {
      "sin", "cos", "fma", "sqrt", "memcpy", "memset", "_GLOBAL_OFFSET_TABLE_"};
  const LoopExample example("planar_3rrr");
  GeneratedLoops loops(example.mechanism, example.scene, true);
  GeneratedProgram program(loops.code(), "robot", loops.inputs(), loops.outputs(), true);
  std::vector<std::string> choices = {"", "-DROBOT_LIBM ", "-DROBOT_FUSED=1 "};
#if defined(__x86_64__)
  for (const char* const set : {"-mavx2 -mfma ", "-mavx512f -mavx512dq -mavx512vl "}) {
    choices.emplace_back(set);
  }
#endif
  for (const std::string& compiler : compilers()) {
    for (const std::string& choice : choices) {
      std::istringstream needed(program.needs(compiler, kStrictest + choice + "-O1"));
      for (std::string line; std::getline(needed, line);) {
        EXPECT_EQ(kAllowed.count(line), 1u) << compiler << " " << choice << ": " << line;
      }
    }
  }
}

// What is chosen by the numbers of one motion must be so in the others.
TEST(GeneratedLoops, RequireWhatIsChosenByNumbers) {
  const double first[] = {2, 1}, other[] = {1, 2};
  const double none[] = {std::numeric_limits<double>::quiet_NaN(), 1};
  for (const bool above : {true, false}) {
    ExpressionGraph graph;
    const Term a = graph.input(0, 0), b = graph.input(0, 1);
    const auto failuresAt = [&](const double* numbers) {
      graph.setValues(0, numbers);
      return graph.valueOf(graph.failures());
    };
    graph.setValues(0, above ? first : other);
    EXPECT_EQ(graph.isAbove(a, b), above);
    EXPECT_EQ(failuresAt(first), above ? 0 : 1);
    EXPECT_EQ(failuresAt(other), above ? 1 : 0);
    EXPECT_EQ(failuresAt(none), 1);
  }
}

// Names of closures and couplings that are no identifiers, or would be the same.
TEST(GeneratedLoops, MakeIdentifiersOfAnyNames) {
  LoopExample example("slider_crank");
  Scene& scene = example.scene;
  scene.closures[0].name = "*/ #error /*";
  Coupling coupling;
  coupling.name = "a\"\nb\\";
  coupling.terms = {{"crank_joint", 1}, {"rod_joint", 0.5}};
  scene.couplings = {coupling};
  scene.free_motion = true;
  scene.actuated.emplace();
  GeneratedLoops loops(example.mechanism, scene, true);
  EXPECT_NE(loops.code().header.find("ROBOT_EFFORT_A_B ="), std::string::npos);
  EXPECT_NE(loops.code().header.find("ROBOT_R_ERROR ="), std::string::npos);
  addSamples(loops, 10);
  const GeneratedLoops::Finding found = loops.run("cc", std::string("-O0 ") + kStrictC);
  EXPECT_EQ(found.compiler, "");
  EXPECT_GE(found.computed, 10u);
  EXPECT_EQ(fuses() ? found.differences : 0, 0u);
}

std::string refusalOf(const Mechanism& mechanism, const Scene& scene, const Request& request = {}) {
  try {
    generateCode(mechanism, scene, request);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(GeneratedLoops, AreRefusedInOneLineWhereThereIsNoStraightLine) {
  const std::string no = "no code can be generated, as ";
  const LoopExample wheel("rolling_disc");
  EXPECT_EQ(refusalOf(wheel.mechanism, wheel.scene), no + "closure 'rim' touches a plane");
  const LoopExample gear("planetary_gear");
  EXPECT_NE(refusalOf(gear.mechanism, gear.scene).find("is of teeth"), std::string::npos);
  LoopExample example("four_bar");
  Request request;
  request.root_axes = {"crank_joint"};
  request.poses = true;
  EXPECT_EQ(refusalOf(example.mechanism, example.scene, request),
            no + "poses or twists are asked for in a scene with loops");
  example.scene.redundancy.policy = RedundancyPolicy::kZeroAt;
  example.scene.redundancy.zero_at = {example.scene.closures[0].name};
  EXPECT_EQ(refusalOf(example.mechanism, example.scene),
            no + "constraints are redundant: the choice that `redundancy` asks for depends on the "
                 "position (minimum_norm does not)");
  example.scene.redundancy = Redundancy();
  example.scene.actuated = std::vector<std::string>{"crank_joint", "rocker_joint"};
  EXPECT_EQ(refusalOf(example.mechanism, example.scene),
            no + "the effort of 'crank_joint' is not determined: more actuators than degrees of "
                 "freedom");
}

TEST(GeneratedLoops, SayWhatIsNotDetermined) {
  const LoopExample example("spatial_parallelogram");
  Request request;
  request.child_axes = {"ball_1", "ball_2"};
  const GeneratedCode code = generateCode(example.mechanism, example.scene, request);
  EXPECT_NE(code.header.find("Not determined by mechanics, but chosen of least norm: "),
            std::string::npos)
      << code.header.substr(0, 2000);
  const LoopExample planar("slider_crank");
  request.child_axes = {"wrist_pin"};
  EXPECT_NE(generateCode(planar.mechanism, planar.scene, request)
                .header.find("least norm: fz tx ty of wrist_pin in child axes."),
            std::string::npos);
  const GeneratedCode efforts = generateCode(planar.mechanism, planar.scene, Request());
  EXPECT_EQ(efforts.header.find("Not determined"), std::string::npos);
}

}  // namespace
}  // namespace virtual_work_dynamics
