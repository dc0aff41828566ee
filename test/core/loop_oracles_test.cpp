#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lagrange_multipliers_oracle.h"
#include "loop_examples.h"
#include "maximal_coordinates_oracle.h"
#include "random_loops.h"

namespace virtual_work_dynamics {
namespace {

// Lagrange's equations round their results to double, and what they are given as wrenches: some eps
// of the largest component, times what the loops at random positions amplify, which is below 100.
constexpr double kOracles = 1e-13;

// The oracles of closed loops are checked here against each other, so that a difference from
// ClosedLoopDynamics is not theirs.
TEST(LoopOracles, MaximalCoordinatesAgreeWithLagrangesMultipliers) {
  RandomLoops random(31);
  int solved = 0, determined = 0, undetermined = 0;
  for (int i = 0; i < 300; ++i) {
    const Case loops = random.next();
    const MaximalCoordinatesOracle maximal(loops.mechanism, loops.scene, loops.motion);
    if (maximal.freeMotions() > 0) continue;
    ++solved;
    EXPECT_LE(maximal.residual(), kOracles) << "case " << i;
    const LagrangeMultipliersOracle lagrange(loops.mechanism, loops.scene, loops.motion);
    std::vector<std::string> names{kGround};
    for (const Joint& joint : loops.mechanism.joints()) names.push_back(joint.name);
    for (const Closure& closure : loops.scene.closures) names.push_back(closure.name);
    double scale = 1, difference = 0;
    for (const std::string& name : names) {
      const auto expected = maximal.rootAxes(name);
      const Wrench wrench = lagrange.rootAxes(name);
      for (int k = 0; k < 6; ++k) {
        if (!expected.determined[static_cast<std::size_t>(k)]) {
          ++undetermined;
          continue;
        }
        ++determined;
        const double value = k < 3 ? wrench.force[k] : wrench.torque[k - 3];
        scale = std::max(scale, std::abs(value));
        difference =
            std::max(difference, static_cast<double>(std::abs(value - expected.wrench[k])));
      }
    }
    for (std::size_t k = 0; k < loops.mechanism.coordinates().size(); ++k) {
      const auto effort = maximal.effort(static_cast<int>(k));
      if (!effort.determined) continue;
      const double value = lagrange.effort(static_cast<Eigen::Index>(k));
      difference = std::max(difference, static_cast<double>(std::abs(value - effort.value)));
    }
    EXPECT_LE(difference, kOracles * scale) << "case " << i;
    // Undetermined or not: what one finds solves the other's equations.
    EXPECT_LE(maximal.violationBy([&](const std::string& n) { return lagrange.rootAxes(n); }),
              kOracles * scale)
        << "case " << i;
  }
  EXPECT_GE(solved, 100);
  EXPECT_GE(determined, 1000);
  EXPECT_GE(undetermined, 1000);
}

// Finds what is determined by a criterion other than the null space.
TEST(LoopOracles, DeterminedIsWhatTheRankNeeds) {
  struct Example {
    const char* name;
    Positions (*positions)(long double);
    int undetermined;  // components in root axes, of all joints, closures and "ground"
  };
  // Planar: the force and two moments out of the plane in every joint, closures included. In space:
  // see SpatialParallelogram in closed_loop_free_bodies_test.cpp.
  for (const Example& entry :
       {Example{"four_bar", fourBarAt, 4 * 3}, Example{"slider_crank", sliderCrankAt, 4 * 3},
        Example{"planar_3rrr", planar3rrrAt, 9 * 3},
        Example{"spatial_parallelogram", parallelogramAt, 2 * 3 + 2}}) {
    const LoopExample example(entry.name);
    const Motion motion = motionAt(example.mechanism, entry.positions, 0.55);
    const MaximalCoordinatesOracle oracle(example.mechanism, example.scene, motion);
    std::vector<std::string> names{kGround};
    for (const Joint& joint : example.mechanism.joints()) names.push_back(joint.name);
    for (const Closure& closure : example.scene.closures) names.push_back(closure.name);
    int undetermined = 0;
    for (const std::string& name : names) {
      for (int i = 0; i < 6; ++i) {
        const bool determined = oracle.rankDropsWithout(name, i);
        EXPECT_EQ(determined, oracle.rootAxes(name).determined[static_cast<std::size_t>(i)])
            << entry.name << ": " << name << ", component " << i;
        undetermined += !determined;
      }
    }
    EXPECT_EQ(undetermined, entry.undetermined) << entry.name;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
