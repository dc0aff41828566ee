#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "power_balance.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Balance of double efforts: rounding of a few hundred terms, cancelling in mimic chains.
constexpr long double kPowerTolerance = 1e-12L;

void expectBalance(const std::string& urdf, unsigned seed) {
  const Mechanism mechanism = readUrdf(urdf);
  RandomRobot source(seed, 2);
  const Scene scene;
  const InverseDynamics dynamics(mechanism, scene);
  Workspace workspace = dynamics.makeWorkspace();
  long double worst = 0;
  for (int i = 0; i < 20; ++i) {
    const Motion motion = source.motion(mechanism);
    dynamics.compute(motion, workspace);
    const PowerBalance balance(mechanism, scene, motion, workspace.effort());
    ASSERT_GT(balance.scale, 0);
    ASSERT_TRUE(std::isfinite(static_cast<double>(balance.residual())));
    worst = std::max(worst, balance.residual());
  }
  EXPECT_LE(worst, kPowerTolerance) << mechanism.name();
  ::testing::Test::RecordProperty("residual_of_" + mechanism.name(),
                                  std::to_string(static_cast<double>(worst * 1e18L)) + "e-18");
}

std::string fileText(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(PowerBalance, HoldsForThePendulum) {
  expectBalance(pendulumUrdf(), 1);
}

TEST(PowerBalance, HoldsForRandomTrees) {
  for (unsigned seed = 1; seed <= 40; ++seed) expectBalance(RandomRobot(seed, 15).urdf(), seed);
}

TEST(PowerBalance, HoldsForTheExampleArm) {
  expectBalance(fileText(std::string(VWD_SOURCE_DIR) + "/urdf/six_axis_arm.urdf"), 3);
}

class SharedRobot : public ::testing::TestWithParam<const char*> {};

TEST_P(SharedRobot, BalancesPower) {
  const std::string path = std::string(VWD_SHARED_DATA) + "/robots/" + GetParam() + ".urdf";
  const std::string urdf = fileText(path);
  if (urdf.empty()) GTEST_SKIP() << path << " is not there";
  expectBalance(urdf, 5);
}

INSTANTIATE_TEST_SUITE_P(PowerBalance, SharedRobot,
                         ::testing::Values("ur5", "tiago_no_hand", "hyq"));

}  // namespace
}  // namespace virtual_work_dynamics
