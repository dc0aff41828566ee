#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <string>

#include "power_balance.h"
#include "sample_robots.h"
#include "tested_build.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Balance of double efforts: rounding of a few hundred terms, cancelling in mimic chains.
constexpr long double kPowerTolerance = 1e-12L;

// Returns the worst residual over twenty states.
long double worstResidual(const std::string& urdf, unsigned seed) {
  const Mechanism mechanism = readUrdf(urdf);
  RandomRobot source(seed, 2);
  Scene scene;
  scene.gravity = {3.1, -2.2, -9.81};  // oblique, so that its power is never zero
  const InverseDynamics dynamics(mechanism, scene);
  Workspace workspace = dynamics.makeWorkspace();
  long double worst = 0;
  for (int i = 0; i < 20; ++i) {
    const Motion motion = source.motion(mechanism);
    dynamics.compute(motion, workspace);
    const PowerBalance balance(mechanism, scene, motion, workspace.effort());
    EXPECT_GT(balance.scale, 0);
    EXPECT_TRUE(std::isfinite(static_cast<double>(balance.residual())));
    worst = std::max(worst, balance.residual());
  }
  return worst;
}

void expectBalance(const std::string& name, long double worst) {
  EXPECT_LE(worst, kPowerTolerance) << name;
  std::cout << "  residual of " << name << ": " << static_cast<double>(worst) << "\n";
}

std::string fileText(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(PowerBalance, HoldsForThePendulum) {
  expectBalance("the pendulum", worstResidual(pendulumUrdf(), 1));
}

TEST(PowerBalance, HoldsForRandomTrees) {
  long double worst = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    worst = std::max(worst, worstResidual(RandomRobot(seed, 15).urdf(), seed));
  }
  expectBalance("random trees", worst);
}

TEST(PowerBalance, HoldsForTheExampleArm) {
  expectBalance("the arm",
                worstResidual(fileText(std::string(kSourceFolder) + "/urdf/six_axis_arm.urdf"), 3));
}

class SharedRobot : public ::testing::TestWithParam<const char*> {};

TEST_P(SharedRobot, BalancesPower) {
  const std::string path = std::string(kSharedData) + "/robots/" + GetParam() + ".urdf";
  const std::string urdf = fileText(path);
  if (urdf.empty()) GTEST_SKIP() << path << " is not there";
  expectBalance(GetParam(), worstResidual(urdf, 5));
}

INSTANTIATE_TEST_SUITE_P(PowerBalance, SharedRobot,
                         ::testing::Values("ur5", "tiago_no_hand", "hyq"));

}  // namespace
}  // namespace virtual_work_dynamics
