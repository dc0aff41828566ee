#include <gtest/gtest.h>

#include "stability/loop_scenes.h"

namespace virtual_work_dynamics {
namespace {

#ifndef VWD_HAS_REAL113

TEST(StructuredLoops, AreJudgedWithTheStabilitySuite) {
  GTEST_SKIP() << "this compiler has no number of 113 bits";
}

#else

constexpr std::uint32_t kSeed = 1;
constexpr std::size_t kScenes = 600;  // the program structured_loops has any number

TEST(StructuredLoops, HaveTheEffortsReactionsRanksAndFlagsOfTheEquationsOfAllJoints) {
  SceneVerdict sum;
  for (std::size_t i = 1; i <= kScenes; ++i) sum.include(judgeScene(kSeed, i));
  for (const std::string& line : sum.wrong) ADD_FAILURE() << line;
  // The scenes are what they are meant to be.
  EXPECT_GE(sum.refused, 50);
  EXPECT_GE(sum.singular, 2);
  EXPECT_GE(sum.open, 1000);
  EXPECT_GE(sum.components - sum.open, 10000);
  EXPECT_LE(sum.unclear, 30);
}

#endif  // VWD_HAS_REAL113

}  // namespace
}  // namespace virtual_work_dynamics
