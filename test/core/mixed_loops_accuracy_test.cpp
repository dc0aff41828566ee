#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "stability/loop_scenes.h"

namespace virtual_work_dynamics {
namespace {

#ifndef VWD_HAS_REAL113

TEST(MixedLoopsAccuracy, IsJudgedWithTheStabilitySuite) {
  GTEST_SKIP() << "this compiler has no number of 113 bits";
}

#else

constexpr std::uint32_t kMixedSeed = 3;
constexpr std::size_t kMixedScenes = 400;  // the program structured_loops --mixed has any number

TEST(MixedLoopsAccuracy, AllKindsOfConditionsAgreeWithTheEquationsOfAllJoints) {
  SceneVerdict sum;
  for (std::size_t i = 1; i <= kMixedScenes; ++i) sum.include(judgeMixedScene(kMixedSeed, i));
  for (const std::string& line : sum.wrong) ADD_FAILURE() << line;
  // The scenes are what they are meant to be.
  EXPECT_GE(sum.refused, 30);
  EXPECT_GE(sum.free, 30);
  EXPECT_GE(sum.open, 10000);
  EXPECT_GE(sum.components - sum.open, 10000);
  EXPECT_GE(sum.holds, 100);
  EXPECT_LE(sum.unclear, 20);
}

// A slide and a turn of a mechanism of 1e-6 m, tied by a coupling alone: its efforts had lost three
// digits, as its length was taken for 1 m.
TEST(MixedLoopsAccuracy, JointsThatCouplingsTieSayHowLargeAMechanismIs) {
  const SceneVerdict verdict = judgeMixedScene(2, 18686);
  for (const std::string& line : verdict.wrong) ADD_FAILURE() << line;
  EXPECT_LT(verdict.condition, 100);
}

// Each kind of condition is in many of the scenes, and together with others.
TEST(MixedLoopsAccuracy, ScenesHaveAllKindsOfConditions) {
  std::vector<int> types(14, 0);
  int couplings = 0, mixed = 0, moving = 0, payloads = 0, dampers = 0;
  for (std::size_t i = 1; i <= kMixedScenes; ++i) {
    const ClosedCase loops = mixedScene(kMixedSeed, i);
    for (const Closure& closure : loops.scene.closures) {
      ++types.at(static_cast<std::size_t>(closure.type));
    }
    couplings += static_cast<int>(loops.scene.couplings.size());
    mixed += std::count(loops.kind.begin(), loops.kind.end(), ',') > 1;
    moving += loops.scene.root_moves;
    payloads += !loops.scene.payloads.empty();
    dampers += !loops.scene.springs.empty() && loops.scene.springs[0].damping > 0;
  }
  for (std::size_t type = 0; type < types.size(); ++type) EXPECT_GE(types[type], 30) << type;
  for (const int many : {couplings, mixed, moving, payloads}) EXPECT_GE(many, 100);
  EXPECT_GE(dampers, 30);
}

#endif  // VWD_HAS_REAL113

}  // namespace
}  // namespace virtual_work_dynamics
