#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "generated_cases.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

TEST(GeneratedCodeCompilers, HasTheBitsOfComputeAsCpp) {
  const Mechanism mechanism = readUrdf(RandomRobot(4, 8).urdf());
  expectSameBits(caseOf(mechanism, busyScene(mechanism), true), "c++",
                 std::string("-O2 ") + kStrictCpp);
}

TEST(GeneratedCodeCompilers, HasTheBitsOfComputeFromOtherCompilers) {
  const Mechanism mechanism = readUrdf(RandomRobot(2, 8).urdf());
  if (compilers().empty()) GTEST_SKIP() << "neither gcc nor clang is there";
  for (const std::string& compiler : compilers()) {
    SCOPED_TRACE(compiler);
    // Contraction is the compilers' default for what is not ISO C: it must not reach the results.
    expectSameBits(caseOf(mechanism, busyScene(mechanism), false), compiler, "-O2 -std=gnu99 ");
  }
}

// With -fsanitize=integer clang would tell of the bit arithmetic of the quadrants, which is meant.
TEST(GeneratedCodeCompilers, RunsUnderSanitizers) {
  if (compilers().empty()) GTEST_SKIP() << "neither gcc nor clang is there";
  GeneratedCodeOptions how;
  how.operations_of_function = 200;  // values pass from part to part
  const Mechanism mechanism = readUrdf(RandomRobot(2, 8).urdf());
  GeneratedCase of = caseOf(mechanism, busyScene(mechanism), true);
  of.farthest = 2e6;
  for (const std::string& compiler : compilers()) {
    SCOPED_TRACE(compiler);
    expectSameBits(of, compiler,
                   "-O1 -g0 -fsanitize=address,undefined,float-divide-by-zero,float-cast-overflow "
                   "-fno-sanitize-recover=all ",
                   how);
  }
}

// What a compiler warns of, or an object takes from elsewhere but sines, cosines and copies of
// memory.
std::string unwanted(GeneratedProgram& program, const std::string& compiler,
                     const std::string& options) {
  static const std::set<std::string> kAllowed = {"sin",    "cos",    "fma",
                                                 "memcpy", "memset", "_GLOBAL_OFFSET_TABLE_"};
  std::istringstream needed(program.needs(compiler, kStrictest + options + "-O1"));
  std::string text;
  for (std::string line; std::getline(needed, line);) {
    if (kAllowed.count(line) == 0) text += line + "\n";
  }
  return text;
}

// For every choice of instructions, and where values pass from function to function.
TEST(GeneratedCodeCompilers, IsStrictFreestandingC) {
  if (compilers().empty()) GTEST_SKIP() << "neither gcc nor clang is there";
  const Mechanism mechanism = readUrdf(RandomRobot(6, 6).urdf());
  const GeneratedCase of = caseOf(mechanism, busyScene(mechanism), false);
  GeneratedCodeOptions in_parts;
  in_parts.operations_of_function = 150;
  GeneratedProgram program(generateCode(mechanism, of.scene, of.request), "robot", inputCounts(of),
                           outputCounts(of));
  GeneratedProgram parts(generateCode(mechanism, of.scene, of.request, in_parts), "robot",
                         inputCounts(of), outputCounts(of));
  std::vector<std::string> choices = {"", "-DROBOT_LIBM ", "-DROBOT_FUSED=1 "};
#if defined(__x86_64__)
  for (const char* const set :
       {"-mavx2 -mfma ", "-mavx512f -mavx512dq ", "-mavx512f -mavx512dq -mavx512vl "}) {
    choices.emplace_back(set);
  }
#endif
  for (const std::string& compiler : compilers()) {
    for (const std::string& choice : choices) {
      EXPECT_EQ(unwanted(program, compiler, choice), "") << compiler << " " << choice;
    }
    EXPECT_EQ(unwanted(parts, compiler, ""), "") << compiler;
  }
}

TEST(GeneratedCodeCompilers, IsStrictFreestandingCInStaticScenes) {
  Scene scene;
  scene.static_motion = true;
  const Mechanism mechanism = readUrdf(RandomRobot(6, 6).urdf());
  const GeneratedCase of = caseOf(mechanism, scene, true);
  GeneratedProgram program(generateCode(mechanism, scene, of.request), "robot", inputCounts(of),
                           outputCounts(of));
  for (const std::string& compiler : compilers()) {
    EXPECT_EQ(unwanted(program, compiler, ""), "") << compiler;
  }
}

// One sample needs no AVX-512 in code of clang for machines that lack its vector lengths.
TEST(GeneratedCodeCompilers, HasTheBitsOfComputeWithoutVectorLengths) {
  if (!isSupported(InstructionSet::kAvx512) || compilers().empty()) {
    GTEST_SKIP() << "there is no AVX-512, or neither gcc nor clang";
  }
  const Mechanism mechanism = readUrdf(RandomRobot(7, 9).urdf());
  for (const std::string& compiler : compilers()) {
    SCOPED_TRACE(compiler);
    expectSameBits(caseOf(mechanism, busyScene(mechanism), true), compiler,
                   "-O2 -std=c99 -mavx512f -mavx512dq ");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
