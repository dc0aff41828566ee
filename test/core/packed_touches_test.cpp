#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "dynamics/sample_rows.h"
#include "loop_examples.h"
#include "motion_tables.h"
#include "result_differences.h"
#include "stability/mixed_loops.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kTouchingRows = 24;
constexpr std::uint32_t kTouchingSeed = 5;
constexpr int kTouchingScenes = 120;

// Positions near some position and any velocities: conditions are violated by what residuals say.
std::vector<Motion> motionsNear(const Eigen::VectorXd& q, double step) {
  std::vector<Motion> motions(kTouchingRows, Motion(q.size()));
  for (std::size_t n = 0; n < motions.size(); ++n) {
    const auto phase = static_cast<double>(n);
    motions[n].q = q;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const auto own = static_cast<double>(i);
      motions[n].q[i] += step * std::sin(phase + 0.7 * own);
      motions[n].qd[i] = std::cos(2 * phase + own);
      motions[n].qdd[i] = 9 * std::sin(3 * phase - own);
    }
  }
  return motions;
}

/// What results of rows and of single samples were met with.
struct Met {
  std::size_t rows = 0, reversed_teeth = 0, chosen = 0;
  std::size_t holds[6] = {};
};

void expectRowsOfSamples(const std::string& name, const Dynamics& dynamics,
                         const std::vector<Motion>& motions, Met& met) {
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  SampleRows rows(dynamics, motions.size());
  rows.compute(tableOfMotions(motions), 0, motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    dynamics.compute(motions[i], workspace);
    EXPECT_EQ(differences(rows.read(i), workspace.results()), "") << name << ' ' << i;
    ++met.rows;
    for (const Hold hold : workspace.results().loops.holds) ++met.holds[static_cast<int>(hold)];
    const Determinacy& determinacy = workspace.results().loops.determinacy;
    if (determinacy.redundancy > determinacy.redundant_constraints) ++met.chosen;
  }
}

void expectRowsOfScene(const std::string& name, const Mechanism& mechanism, const Scene& scene,
                       double step, Met& met) {
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  for (const bool residuals : {false, true}) {
    for (const int more : {0, 1, 2}) {
      request.residuals = residuals;
      request.poses = request.twists = more > 0;
      request.determinacy = more > 1;
      const Dynamics dynamics(mechanism, scene, request);
      expectRowsOfSamples(name, dynamics, motionsNear(dynamics.assembly(), step), met);
    }
  }
}

TEST(PackedTouches, ExamplesAreThoseOfSingleSamples) {
  Met met;
  for (const char* name : {"mobile_manipulator", "biped", "planetary_gear", "rolling_disc"}) {
    const LoopExample example(name);
    expectRowsOfScene(name, example.mechanism, example.scene, 0.05, met);
  }
  const std::string folder = std::string(kSourceFolder) + "/config/";
  expectRowsOfScene("one hip", LoopExample("biped").mechanism,
                    readSceneFile(folder + "biped_passive_hip_scene.yaml"), 0.05, met);
  // The biped chooses among efforts; with one hip, forces are inside cones and outside of them.
  EXPECT_GT(met.chosen, 0U);
  for (const Hold hold : {Hold::kHolds, Hold::kWrongWay, Hold::kOutsideCone, Hold::kNotDecidable}) {
    EXPECT_GT(met.holds[static_cast<int>(hold)], 0U) << static_cast<int>(hold);
  }
}

// Turned as its teeth roll, a gear is closed except for roundings, which count as none.
TEST(PackedTouches, RoundingsOfTeethThatFitAreNoGaps) {
  const LoopExample gear("planetary_gear");
  const double rolling[] = {1, -3.5, -3.5, -3.5, 10.0 / 3};  // by turn of the carrier
  std::vector<Motion> motions(kTouchingRows, Motion(5));
  for (std::size_t n = 0; n < motions.size(); ++n) {
    for (Eigen::Index i = 0; i < 5; ++i) {
      motions[n].q[i] = (0.1 + 0.37 * static_cast<double>(n)) * rolling[i];
    }
  }
  Request request;
  request.residuals = true;
  const Dynamics dynamics(gear.mechanism, gear.scene, request);
  Met met;
  expectRowsOfSamples("gear", dynamics, motions, met);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motions.back(), workspace);
  for (const ClosureResidual& residual : workspace.results().loops.residuals) {
    EXPECT_EQ(residual.position, 0);
  }
}

// A sole that is named twice: how its two share what it presses with is open, and nothing else is.
// Open ones stand before the one that is judged, after it, or on both sides; where one of the two
// slips, only their normal forces are open.
TEST(PackedTouches, ASoleBesideTwinsIsJudgedByItsOwnForces) {
  const LoopExample biped("biped");
  const Scene one_hip =
      readSceneFile(std::string(kSourceFolder) + "/config/biped_passive_hip_scene.yaml");
  const Closure left = one_hip.closures.at(0), right = one_hip.closures.at(1);
  Closure twin = left, slips = left;
  twin.name = slips.name = "twin";
  slips.touch.slip = Slip::kAll;
  slips.touch.friction.reset();
  for (const auto& closures :
       {std::vector<Closure>{right, left, twin}, std::vector<Closure>{left, right, twin},
        std::vector<Closure>{left, twin, right}, std::vector<Closure>{slips, right, left},
        std::vector<Closure>{left, slips, right}}) {
    Scene scene = one_hip;
    scene.closures = closures;
    Met met;
    expectRowsOfScene("twins", biped.mechanism, scene, 0.05, met);
    EXPECT_EQ(met.chosen, 0U);
    EXPECT_EQ(met.holds[static_cast<int>(Hold::kNotDecidable)], 2 * met.rows);
    for (const Hold hold : {Hold::kHolds, Hold::kWrongWay, Hold::kOutsideCone}) {
      EXPECT_GT(met.holds[static_cast<int>(hold)], 0U) << static_cast<int>(hold);
    }
  }
}

// Of random scenes those without conditions that packs do not serve.
TEST(PackedTouches, RandomScenesAreThoseOfSingleSamples) {
  MixedLoops source(kTouchingSeed);
  Met met;
  for (int i = 0; i < kTouchingScenes; ++i) {
    ClosedCase random = source.next();
    Scene& scene = random.scene;
    scene.couplings.clear();
    scene.springs.clear();
    scene.drives.clear();
    try {
      const Dynamics tried(random.mechanism, scene, Request());
      if (tried.orientations() > 0 || scene.root_moves) continue;
    } catch (const Error&) {
      continue;  // what was left out made it whole
    }
    expectRowsOfScene("scene " + std::to_string(i), random.mechanism, scene, 1e-3, met);
  }
  EXPECT_GT(met.rows, 1000U);
}

}  // namespace
}  // namespace virtual_work_dynamics
