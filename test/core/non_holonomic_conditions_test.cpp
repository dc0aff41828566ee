#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "condition_kinds.h"
#include "conditioned_loops.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

class NonHolonomicConditions : public testing::Test {
 protected:
  // A body that slides along x and y and turns about z, an arm on it, and a hand on that.
  static Mechanism robot(bool has_hand = false) {
    RobotBuilder builder(5);
    const Matrix3l R = Matrix3l::Identity();
    builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), R, Vector3l::Zero());
    builder.add(JointType::kPrismatic, 1, Vector3l::UnitY(), R, Vector3l::Zero());
    builder.add(JointType::kRevolute, 2, Vector3l::UnitZ(), R, Vector3l::Zero());
    builder.add(JointType::kRevolute, 3, Vector3l::UnitX(), R, {0.1L, 0.2L, 0});
    if (has_hand) builder.add(4);
    return builder.build();
  }
  static Scene sceneOf(const std::vector<std::string>& actuated) {
    Scene scene;
    scene.actuated = actuated;
    scene.assembly = {{"joint_2", 0.25}};
    return scene;
  }

  const Law speed{[](double t) { return 0.2 + 0.5 * t; }, [](double) { return 0.5; },
                  [](double) { return 0.0; }};
  const std::shared_ptr<const ConditionSet> blade = std::make_shared<Blade>(speed);
  const Mechanism mechanism = robot();
};

// qd_1 = (u + sin qd_0) / cos and its derivative; no position follows.
TEST_F(NonHolonomicConditions, NonHolonomicConditionGivesRatesWithoutPositions) {
  ConditionedLoops loops(mechanism, sceneOf({"joint_1", "joint_3", "joint_4"}), {blade});
  EXPECT_EQ(loops.assembly[1], 0.25);
  EXPECT_EQ(loops.completion.rank(loops.kinematics, std::vector<bool>(4, false)), 0);
  for (int n = 0; n < 40; ++n) {
    const double t = 0.1 * n, angle = -1.2 + 0.05 * n;
    const double s = std::sin(angle), c = std::cos(angle);
    Motion motion(4);
    motion.q << 0.3, 0.7, angle, 0.4;
    // Every other time nothing but the blade's own speed moves anything.
    if (n % 2 > 0) motion.qd << 0.8 - 0.1 * n, 0, 0.5, -0.3;
    if (n % 2 > 0) motion.qdd << -0.6, 0, 0.9, 0.2;
    loops.kinematics.setTime(t);
    ASSERT_TRUE(loops.complete(motion)) << n;
    EXPECT_EQ(motion.q[1], 0.7);
    const double u = speed.f(t), x = motion.qd[0], turn = motion.qd[2];
    const double y = (u + s * x) / c;
    EXPECT_NEAR(motion.qd[1], y, kConditionTolerance * std::max(1.0, std::abs(y)));
    const double yd =
        (speed.fd(t) + s * motion.qdd[0] + c * turn * x) / c + (u + s * x) * s * turn / (c * c);
    EXPECT_NEAR(motion.qdd[1], yd, kConditionTolerance * std::max(1.0, std::abs(yd)));
  }
}

// The blade's edge bears the whole load across it: f_1 = cos lambda, f_0 = F_0 - sin lambda.
TEST_F(NonHolonomicConditions, MultiplierBearsTheLoadAcrossTheBlade) {
  ConditionedLoops loops(mechanism, sceneOf({"joint_1", "joint_3", "joint_4"}), {blade});
  Motion motion(4);
  motion.q << 0.3, 0.7, 0.6, 0.4;
  motion.qd << 0.8, 0, 0.5, -0.3;
  motion.qdd << -0.6, 0, 0.9, 0.2;
  ASSERT_TRUE(loops.complete(motion));
  const Eigen::VectorXd tree = loops.treeEfforts(motion);
  Eigen::VectorXd expected = tree;
  expected[0] += std::tan(0.6) * tree[1];
  expected[1] = 0;
  expectNear(expected, loops.efforts(motion));
}

// Newton's method goes by the gear alone, in one step and one that finds no more to do, although
// the blade lets y not move.
TEST_F(NonHolonomicConditions, PositionsFollowConditionsThatHaveThem) {
  const ConditionSets sets = {blade, std::make_shared<Gear>(mechanism, 3, 1, 2.0, 0.1)};
  ConditionedLoops loops(mechanism, sceneOf({"joint_1", "joint_3", "joint_4"}), sets);
  Eigen::VectorXd q(4);
  q << 0.3, 0.3, 0.6, 0.4;
  ASSERT_TRUE(loops.completion.close(loops.kinematics, q, loops.resolved.actuated));
  EXPECT_NEAR(q[1], 0.15, kConditionTolerance);
  EXPECT_LE(loops.completion.steps(), 2);
  EXPECT_EQ(loops.completion.rank(loops.kinematics, std::vector<bool>(4, false)), 1);
  // Both conditions on the speed of y: they contradict each other.
  Motion motion(4);
  motion.q = q;
  EXPECT_FALSE(loops.complete(motion));
  motion.qd[3] = 2 * speed.f(0) / std::cos(0.6);
  motion.qdd[3] = 2 * speed.fd(0) / std::cos(0.6);
  EXPECT_TRUE(loops.complete(motion));
}

// A group of conditions without positions has nothing to say while another is being closed.
TEST_F(NonHolonomicConditions, BladeAloneDoesNotDisturbOtherLoops) {
  const Mechanism with_hand = robot(true);
  const ConditionSets sets = {blade, std::make_shared<Gear>(with_hand, 4, 3, 2.0, 0.1)};
  ConditionedLoops loops(with_hand, sceneOf({"joint_1", "joint_3", "joint_4"}), sets);
  ASSERT_EQ(loops.groups.size(), 2u);
  Motion motion(5);
  motion.q << 0.3, 0.7, 0.6, 0.4, 0;
  ASSERT_TRUE(loops.complete(motion));
  EXPECT_GT(loops.completion.steps(), 0);
  EXPECT_EQ(motion.q[1], 0.7);
  EXPECT_NEAR(motion.q[4], 0.9, kConditionTolerance);
  EXPECT_NEAR(motion.qd[1], speed.f(0) / std::cos(0.6), kConditionTolerance);
}

// When only the blade restricts y, y stays as near as the gear lets it and moves as the blade
// demands.
TEST_F(NonHolonomicConditions, GearAndBladeTogetherDetermineTheMotion) {
  const ConditionSets sets = {blade, std::make_shared<Gear>(mechanism, 3, 1, 2.0, 0.1)};
  ConditionedLoops loops(mechanism, sceneOf({"joint_1", "joint_3"}), sets);
  Motion motion(4);
  motion.q << 0.3, 0.7, 0.6, 0.4;
  motion.qd << 0.8, 0, 0.5, 0;
  ASSERT_TRUE(loops.complete(motion));
  EXPECT_NEAR(motion.q[3], 2 * motion.q[1] + 0.1, kConditionTolerance);
  const double y = (speed.f(0) + std::sin(0.6) * 0.8) / std::cos(0.6);
  EXPECT_NEAR(motion.qd[1], y, kConditionTolerance);
  EXPECT_NEAR(motion.qd[3], 2 * y, kConditionTolerance);
  // Residuals are those of closures, of which there are none; the rows of the conditions vanish.
  loops.kinematics.setMotion(motion);
  EXPECT_LE(loops.kinematics.phi().cwiseAbs().maxCoeff(), kConditionTolerance);
  EXPECT_LE(loops.kinematics.rates().cwiseAbs().maxCoeff(), kConditionTolerance);
  EXPECT_LE(loops.kinematics.accelerations().cwiseAbs().maxCoeff(), kConditionTolerance);
}

}  // namespace
}  // namespace virtual_work_dynamics
