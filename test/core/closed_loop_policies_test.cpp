#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "algebra/least_norms.h"
#include "closed_loop_results.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

// A few roundings.
constexpr double kTolerance = 1e-14;

Closure rod(const std::string& name, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Closure rod;
  rod.name = name;
  rod.type = ClosureType::kDistance;
  rod.parent.link = "link_0";
  rod.parent.xyz = from;
  rod.child.link = "link_1";
  rod.child.xyz = to;
  return rod;
}

// A load of 2 kg that slides along z and hangs on rods from the ceiling.
struct HangingLoad {
  HangingLoad() {
    builder.add(JointType::kPrismatic, 0, Vector3l::UnitZ(), Matrix3l::Identity(),
                Vector3l::Zero());
    builder.link(1).mass = 2;
    builder.link(1).p_KoCm_K.setZero();
    scene.actuated.emplace();
    const Eigen::Vector3d ceiling(0, 0, 1.5), load(0, 0, 0);
    scene.closures = {rod("rod_1", ceiling, load), rod("rod_2", ceiling, load),
                      rod("rod_3", ceiling, load)};
  }
  // Shares of the weight.
  Eigen::Vector3d shares() {
    ClosedLoopResults results(builder.build(), scene, Motion(1));
    EXPECT_EQ(results.dynamics.determinacy().redundant_constraints, 2);
    EXPECT_EQ(results.dynamics.determinacy().redundancy, 2);
    EXPECT_EQ(results.dynamics.effort()[0], 0);
    EXPECT_TRUE(results.rootDetermined("joint_1")[2]);
    Eigen::Vector3d shares;
    for (int i = 0; i < 3; ++i) {
      const std::string name = "rod_" + std::to_string(i + 1);
      shares[i] = results.root(name).force.z() / (2 * 9.81);
      EXPECT_EQ(results.rootDetermined(name), (Determined{true, true, false, true, true, true}));
      EXPECT_EQ(results.root(name).force.head(2).norm(), 0);
    }
    return shares;
  }
  RobotBuilder builder{1};
  Scene scene;
};

TEST(Redundancy, MinimumNormSharesEqually) {
  EXPECT_LE((HangingLoad().shares() - Eigen::Vector3d::Constant(1 / 3.0)).norm(), kTolerance);
}

TEST(Redundancy, ZeroAtRelievesTheClosuresNamed) {
  HangingLoad load;
  load.scene.redundancy.policy = RedundancyPolicy::kZeroAt;
  load.scene.redundancy.zero_at = {"rod_2"};
  EXPECT_LE((load.shares() - Eigen::Vector3d(0.5, 0, 0.5)).norm(), kTolerance);
  load.scene.redundancy.zero_at = {"rod_3", "rod_2"};
  EXPECT_LE((load.shares() - Eigen::Vector3d(1, 0, 0)).norm(), kTolerance);
  // All of them cannot be relieved; as little as possible is an equal share.
  load.scene.redundancy.zero_at = {"rod_3", "rod_2", "rod_1"};
  EXPECT_LE((load.shares() - Eigen::Vector3d::Constant(1 / 3.0)).norm(), kTolerance);
}

// Parallel rods share a load like parallel springs.
TEST(Redundancy, ParallelRodsShareAsTheirStiffness) {
  HangingLoad load;
  load.scene.redundancy.policy = RedundancyPolicy::kStiffness;
  EXPECT_LE((load.shares() - Eigen::Vector3d::Constant(1 / 3.0)).norm(), kTolerance);
  load.scene.redundancy.stiffness = {{"rod_1", 2e6}, {"rod_2", 5e6}, {"rod_3", 3e6}};
  EXPECT_LE((load.shares() - Eigen::Vector3d(0.2, 0.5, 0.3)).norm(), kTolerance);
}

// A beam on a bearing in its middle and a rod at each end: the least sum of squares over stiffness
// is what a rigid beam on three springs does.
TEST(Redundancy, StiffnessWeighsReactionsOfTheTree) {
  RobotBuilder builder(1);
  builder.add(JointType::kContinuous, 0, Vector3l::UnitY(), Matrix3l::Identity(), Vector3l::Zero());
  builder.removeInertia(1);
  Scene scene;
  scene.actuated.emplace();
  scene.closures = {rod("left", {-1, 0, 2}, {-1, 0, 0}), rod("right", {1, 0, 2}, {1, 0, 0})};
  AppliedWrench load;
  load.link = "link_1";
  load.at << 0.4, 0, 0;
  load.force << 0, 0, -100;
  scene.applied_wrenches = {load};
  scene.redundancy.policy = RedundancyPolicy::kStiffness;
  const double kl = 1, kr = 4, kb = 2.5;
  scene.redundancy.stiffness = {{"left", kl}, {"right", kr}, {"joint_1", kb}};
  const ClosedLoopResults results(builder.build(), scene, Motion(1));
  // The beam sinks by a + b x.
  Eigen::Matrix2d K;
  K << kl + kr + kb, kr - kl, kr - kl, kr + kl;
  const Eigen::Vector2d sunk = K.inverse() * Eigen::Vector2d(100, 40);
  EXPECT_NEAR(results.root("left").force.z(), kl * (sunk[0] - sunk[1]), 100 * kTolerance);
  EXPECT_NEAR(results.root("right").force.z(), kr * (sunk[0] + sunk[1]), 100 * kTolerance);
  EXPECT_NEAR(results.root("joint_1").force.z(), kb * sunk[0], 100 * kTolerance);
  EXPECT_EQ(results.dynamics.determinacy().redundant_constraints, 1);
  EXPECT_FALSE(results.rootDetermined("joint_1")[2]);
  EXPECT_TRUE(results.rootDetermined("joint_1")[0]);
}

// Later wishes do not touch earlier ones, and x stays least where nothing is wished.
TEST(LeastNorms, WishesAreMetInTheirOrder) {
  LeastNorms norms(4, 4);
  norms.start(Eigen::MatrixXd::Identity(4, 4));
  Eigen::VectorXd x(4);
  x << 1, 2, 3, 4;
  norms.costs(2) << 1, 1, 0, 0, 1, 1, 0, 0;  // x0 + x1 - 5 and x0 + x1 - 7
  norms.costOfSolution(2) << x[0] + x[1] - 5, x[0] + x[1] - 7;
  EXPECT_EQ(norms.reduce(2, x), 1);
  EXPECT_NEAR(x[0] + x[1], 6, 6 * kTolerance);
  EXPECT_EQ(norms.open(), 3);
  // x0 and x0 + x1 again: only x0 is still open.
  for (Eigen::Index j = 0; j < 3; ++j) {
    norms.costs(2)(0, j) = norms.space()(0, j);
    norms.costs(2)(1, j) = norms.space()(0, j) + norms.space()(1, j);
  }
  norms.costOfSolution(2) << x[0] - 10, x[0] + x[1];
  EXPECT_EQ(norms.reduce(2, x), 1);
  EXPECT_NEAR(x[0], 10, 10 * kTolerance);
  EXPECT_NEAR(x[1], -4, 10 * kTolerance);
  norms.finish(x);
  EXPECT_LE(x.tail(2).norm(), 4 * kTolerance);
}

}  // namespace
}  // namespace virtual_work_dynamics
