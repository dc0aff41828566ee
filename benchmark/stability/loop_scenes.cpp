#include "stability/loop_scenes.h"

#ifdef VWD_HAS_REAL113

#include <algorithm>

#include "base/number_text.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Within this factor of the rank's tolerance either answer may be the right one.
constexpr long double kUnclear = 100;
// Size of all loops over that of the mechanism. The exact equations compare moments with forces by
// the size of the mechanism, the package by that of the loops: further apart than this, they call
// different changes rounding errors.
constexpr long double kSmall = 1e-4L;

bool isUnclear(const MaximalCoordinatesOracle& oracle, long double tolerance) {
  const auto near = [&](long double pivot) {
    return pivot > tolerance / kUnclear && pivot < tolerance * kUnclear;
  };
  return near(oracle.leastCounted()) || near(oracle.largestLeftOut());
}

SceneVerdict judgeRefusal(const MaximalCoordinatesOracle& oracle, double tolerance,
                          const std::string& reason) {
  SceneVerdict verdict;
  if (oracle.freeMotions() > 0) {
    verdict.refused = 1;
  } else if (isUnclear(oracle, tolerance)) {
    verdict.unclear = 1;
  } else {
    verdict.wrong.push_back("refused: " + reason);
  }
  return verdict;
}

SceneVerdict judgeCase(const ClosedCase& loops) {
  const MaximalCoordinatesOracle oracle(loops.mechanism, loops.scene, loops.motion,
                                        loops.scene.redundancy.rank_tolerance);
  if (!loops.scene.closures.empty() && oracle.sizeOfLoops() < kSmall) {
    SceneVerdict verdict;
    verdict.small = 1;
    return verdict;
  }
  LoopVerdict found;
  Eigen::Index residuals = 0;
  try {
    LoopJudge judge(loops.mechanism, loops.scene);
    found = judge.judgeForces(loops.motion);
    residuals = judge.residuals();
  } catch (const SceneError& error) {
    return judgeRefusal(oracle, loops.scene.redundancy.rank_tolerance, error.what());
  }
  SceneVerdict verdict;
  verdict.free = residuals > 0;
  // In a singular position more moves than what is free in others.
  if (loops.scene.free_motion && residuals + found.free_motions != oracle.freeMotions() &&
      !isUnclear(oracle, loops.scene.redundancy.rank_tolerance)) {
    verdict.wrong.push_back(std::to_string(residuals) + " residuals and " +
                            std::to_string(found.free_motions) + " free motions instead of " +
                            std::to_string(oracle.freeMotions()));
  }
  verdict.singular = found.free_motions > 0;
  verdict.unborne = found.unborne;
  verdict.unclear = !found.clear;
  verdict.components = found.components;
  verdict.open = found.open;
  verdict.holds = found.holds;
  verdict.condition = found.condition;
  if (found.clear) verdict.over_bound = found.errors.over_bound;
  if (found.apart > 0) {
    verdict.wrong.push_back(std::to_string(found.apart) + " wrong: " + found.worst_apart);
  } else if (!(verdict.over_bound <= 1)) {
    verdict.wrong.push_back(numberText(verdict.over_bound) + " times the bound: " +
                            found.errors.worst + ", condition " + numberText(found.condition));
  }
  return verdict;
}

SceneVerdict judgeNumbered(const ClosedCase& loops, std::size_t index) {
  SceneVerdict verdict = judgeCase(loops);
  verdict.scenes = 1;
  for (std::string& line : verdict.wrong) {
    line = "scene " + std::to_string(index) + " (" + loops.kind + "): " + line;
  }
  return verdict;
}

// Seeds of neighbours must not lie close to each other: 32-bit numbers that are mixed.
std::uint32_t mixedSeed(std::uint32_t seed, std::size_t index) {
  std::uint32_t mixed = seed * 2654435761u + static_cast<std::uint32_t>(index);
  mixed = (mixed ^ (mixed >> 16)) * 0x7feb352du;
  mixed = (mixed ^ (mixed >> 15)) * 0x846ca68bu;
  return mixed ^ (mixed >> 16);
}

}  // namespace

void SceneVerdict::include(const SceneVerdict& other) {
  scenes += other.scenes;
  refused += other.refused;
  singular += other.singular;
  free += other.free;
  unborne += other.unborne;
  small += other.small;
  unclear += other.unclear;
  components += other.components;
  open += other.open;
  holds += other.holds;
  over_bound = std::max(over_bound, other.over_bound);
  condition = std::max(condition, other.condition);
  wrong.insert(wrong.end(), other.wrong.begin(), other.wrong.end());
}

ClosedCase structuredScene(std::uint32_t seed, std::size_t index) {
  return StructuredLoops(mixedSeed(seed, index)).next();
}

SceneVerdict judgeScene(std::uint32_t seed, std::size_t index) {
  return judgeNumbered(structuredScene(seed, index), index);
}

ClosedCase mixedScene(std::uint32_t seed, std::size_t index) {
  return MixedLoops(mixedSeed(seed, index)).next();
}

SceneVerdict judgeMixedScene(std::uint32_t seed, std::size_t index) {
  return judgeNumbered(mixedScene(seed, index), index);
}

}  // namespace virtual_work_dynamics

#endif  // VWD_HAS_REAL113
