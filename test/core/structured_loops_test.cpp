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

// Its loop holds a fixed link with a lever of 1e-11 m: forces of 2e10 N, of which many do, have a
// moment that is determined, and that the choice among them changes by 0.2 N m.
TEST(StructuredLoops, MomentsOfForcesThatAreChosenDifferentlyAreJudgedByTheirLever) {
  for (const std::string& line : judgeScene(kSeed, 56680).wrong) ADD_FAILURE() << line;
}

// Springs that pull with a hundredth of what they would over their rest length, in mechanisms
// without other loads of that size: the digits that those lengths share are lost.
TEST(StructuredLoops, ForcesOfSpringsAreJudgedByTheLengthsThatTheyCompare) {
  for (const std::size_t scene : {13576, 4447}) {
    for (const std::string& line : judgeScene(11, scene).wrong) ADD_FAILURE() << line;
  }
}

// Mechanisms of 3e5 m with slides that are off an axis by 1e-12: what that does to forces of 1e20 N
// is there, as it is in one of a metre.
TEST(StructuredLoops, RowsThatSlidesHardlyMoveAlongAreNotLeftOut) {
  for (const std::size_t scene : {63797, 64199, 87920}) {
    const SceneVerdict verdict = judgeScene(2, scene);
    for (const std::string& line : verdict.wrong) ADD_FAILURE() << line;
    EXPECT_LT(verdict.over_bound, 0.1);
  }
}

// A universal joint beside the axis of another by 2e-11 m, in a mechanism of 0.3 m: its force turns
// that joint with a lever which is all of the loop and nothing to the exact equations.
TEST(StructuredLoops, MomentsInTinyLoopsAreJudgedByTheirExtent) {
  const SceneVerdict verdict = judgeScene(21, 78404);
  for (const std::string& line : verdict.wrong) ADD_FAILURE() << line;
  EXPECT_EQ(verdict.small, 0);
  EXPECT_EQ(verdict.unclear, 0);
}

#endif  // VWD_HAS_REAL113

}  // namespace
}  // namespace virtual_work_dynamics
