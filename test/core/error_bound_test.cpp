#include "virtual_work_dynamics/error_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "reference_113.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// A handful of products and sums in double.
constexpr double kByHand = 1e-14;

void expectNear(double actual, double expected) {
  EXPECT_LE(std::abs(actual - expected), kByHand * expected) << actual << " for " << expected;
}

// A hinge about z, 0.3 m from the root, and on its link a slide along x, another 0.4 m away; both
// carry a point mass, and the root nothing.
RobotBuilder turningSlide() {
  RobotBuilder builder(1);
  const Matrix3l same = Matrix3l::Identity();
  builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), same, {0.3L, 0, 0});
  builder.add(JointType::kPrismatic, 1, Vector3l::UnitX(), same, {0, 0.4L, 0});
  for (const int link : {1, 2}) {
    builder.removeInertia(link);
    builder.link(link).mass = 2 * link;
    builder.link(link).p_KoCm_K << 0, 0, 0.5L * link;
  }
  builder.link(2).inertia_Cm_K.diagonal() << 2, 3, 6;  // of norm 7
  return builder;
}

Motion someMotion() {
  Motion motion(2);
  motion.q << 0.7, -0.25;
  motion.qd << -3, 2;
  motion.qdd << 5, -7;
  return motion;
}

TEST(ErrorBound, AddsUpNormsOfTheTerms) {
  const Mechanism mechanism = turningSlide().build();
  Scene scene;
  scene.gravity << 0, 0, -10;
  ErrorBound bound(mechanism, scene);
  bound.compute(someMotion());
  // Hinge: w = 3, alpha = 5, U = 14, gamma = 10. Slide: |r| = 0.4 + 0.25, gamma = 10 + 14 * 0.65 +
  // 7 + 2 * 2 * 3.
  const double gamma = 10 + 14 * 0.65 + 7 + 12;
  const double slide_force = 4 * gamma + 4 * 14, slide_moment = 4 * gamma + 14 * (7 + 4);
  const double hinge_force = 2 * 10 + 1 * 14 + slide_force;
  const double hinge_moment = 1 * 10 + 14 * 0.5 + slide_moment + 0.65 * slide_force;
  expectNear(bound.wrenches()[2].force, slide_force);
  expectNear(bound.wrenches()[2].moment, slide_moment);
  expectNear(bound.wrenches()[1].force, hinge_force);
  expectNear(bound.wrenches()[1].moment, hinge_moment);
  expectNear(bound.wrenches()[0].force, hinge_force);
  expectNear(bound.wrenches()[0].moment, hinge_moment + 0.3 * hinge_force);
  expectNear(bound.efforts()[0], hinge_moment);
  expectNear(bound.efforts()[1], slide_force);
}

// A hinge that rests without gravity: all numbers are zero but the mass and its arm of half a
// metre.
TEST(ErrorBound, CountsNumbersAsAtLeastTheSmallestNormalOne) {
  RobotBuilder builder(1);
  builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), Matrix3l::Identity(), {3, 0, 0});
  builder.removeInertia(1);
  builder.link(1).mass = 2;
  builder.link(1).p_KoCm_K << 0, 0, 0.5L;
  Scene scene;
  scene.gravity.setZero();
  ErrorBound bound(builder.build(), scene);
  bound.compute(Motion(1));
  EXPECT_EQ(bound.wrenches()[0].force, 0);
  // U = least; the hinge's gamma = 3 U; the root's own wrench is as small as its numbers.
  constexpr double kLeast = 1e-6;
  bound.compute(Motion(1), kLeast);
  const double gamma = kLeast * 3, force = 2 * gamma + 1 * kLeast;
  const double moment = 1 * gamma + 0.5 * kLeast;
  expectNear(bound.wrenches()[1].force, force);
  expectNear(bound.wrenches()[1].moment, moment);
  expectNear(bound.wrenches()[0].moment, kLeast + moment + 3 * force);
}

TEST(ErrorBound, StaticMotionLeavesWeights) {
  const Mechanism mechanism = turningSlide().build();
  Scene scene;
  scene.gravity << 0, 0, -10;
  scene.static_motion = true;
  scene.joints = {{"joint_1", 0, 0, 9.0, 9.0, 1e-3, 9.0}};  // all of them due to motion
  ErrorBound bound(mechanism, scene);
  bound.compute(someMotion());
  expectNear(bound.wrenches()[2].force, 40);
  expectNear(bound.wrenches()[2].moment, 40);
  expectNear(bound.efforts()[0], 10 + 40 + 0.65 * 40);
  expectNear(bound.efforts()[1], 40);
}

// Nothing cancels in a single link at rest whose weight has its full lever.
TEST(ErrorBound, EqualsTheWrenchOfASingleLinkAtRest) {
  RobotBuilder builder(2);
  builder.add(JointType::kRevolute, 0, Vector3l::UnitY(), Matrix3l::Identity(), {0, 0, 0});
  builder.removeInertia(1);
  builder.link(1).mass = 3;
  builder.link(1).p_KoCm_K << 0.25L, 0, 0;
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.gravity << 0, 0, -9.5;
  const InverseDynamics dynamics(mechanism, scene);
  Workspace workspace = dynamics.makeWorkspace();
  ErrorBound bound(mechanism, scene);
  dynamics.compute(Motion(1), workspace);
  bound.compute(Motion(1));
  EXPECT_EQ(bound.wrenches()[1].force, workspace.rootAxes()[0].force.norm());
  EXPECT_EQ(bound.wrenches()[1].moment, workspace.rootAxes()[0].torque.norm());
  EXPECT_EQ(bound.efforts()[0], std::abs(workspace.effort()[0]));
}

TEST(ErrorBound, CountsAppliedWrenches) {
  const Mechanism mechanism = turningSlide().build();
  Scene scene;
  scene.gravity.setZero();
  scene.applied_wrenches.resize(2);
  for (AppliedWrench& applied : scene.applied_wrenches) {
    applied.link = "link_2";
    applied.at << 0, 0, 2;
    applied.force << 3, 0, 4;
    applied.torque << -7, 0, 0;
  }
  scene.applied_wrenches[1].axes = Axes::kRoot;
  ErrorBound bound(mechanism, scene);
  bound.compute(Motion(2));
  expectNear(bound.wrenches()[2].force, 2 * 5);
  expectNear(bound.wrenches()[2].moment, 2 * (7 + 2 * 5));
  expectNear(bound.wrenches()[1].moment, 2 * (7 + 2 * 5) + 0.4 * 2 * 5);
}

void expectEqual(const ErrorBound& a, const ErrorBound& b) {
  ASSERT_EQ(a.wrenches().size(), b.wrenches().size());
  for (std::size_t i = 0; i < a.wrenches().size(); ++i) {
    EXPECT_EQ(a.wrenches()[i].force, b.wrenches()[i].force);
    EXPECT_EQ(a.wrenches()[i].moment, b.wrenches()[i].moment);
  }
  EXPECT_EQ(a.efforts(), b.efforts());
}

TEST(ErrorBound, CountsTheWrenchesOfALoad) {
  const Mechanism mechanism = turningSlide().build();
  Scene scene;
  scene.applied_wrenches.resize(2);
  scene.applied_wrenches[0].link = "link_1";
  scene.applied_wrenches[0].force << 9, 9, 9;
  scene.applied_wrenches[1].link = "link_2";
  scene.applied_wrenches[1].at << 0, 0, 2;
  ErrorBound given(mechanism, scene), own(mechanism, scene);
  own.compute(someMotion());
  Load load;
  load.wrenches = {{{0, 0, 1}, {0, 8, 0}}, {{3, 0, 4}, {-7, 0, 0}}};
  scene.applied_wrenches[0].force << 0, 0, 1;
  scene.applied_wrenches[0].torque << 0, 8, 0;
  scene.applied_wrenches[1].force << 3, 0, 4;
  scene.applied_wrenches[1].torque << -7, 0, 0;
  ErrorBound compiled(mechanism, scene);
  for (int i = 0; i < 2; ++i) {  // is not added twice
    given.compute(someMotion());
    expectEqual(given, own);
    compiled.compute(someMotion());
    given.compute(someMotion(), load);
    expectEqual(given, compiled);
  }
  scene.applied_wrenches.clear();
  ErrorBound without(mechanism, scene);
  without.compute(someMotion());
  expectNear(given.wrenches()[2].force, without.wrenches()[2].force + 5);
  expectNear(given.wrenches()[2].moment, without.wrenches()[2].moment + 7 + 2 * 5);
  load.wrenches.resize(3);
  EXPECT_THROW(given.compute(someMotion(), load), SceneError);
  load.wrenches.resize(1);
  EXPECT_THROW(given.compute(someMotion(), load), SceneError);
}

TEST(ErrorBound, CountsJointTermsAndGears) {
  RobotBuilder builder = turningSlide();
  builder.add(JointType::kRevolute, 2, Vector3l::UnitX(), Matrix3l::Identity(), {0, 0, 0});
  builder.removeInertia(3);
  builder.link(3).mass = 1;
  builder.link(3).p_KoCm_K << 0, 1, 0;
  builder.mimicFirst(-2, -0.5);
  const Mechanism mechanism = builder.build();
  Scene scene;
  ErrorBound without(mechanism, scene);
  scene.joints = {{"joint_3", 10, -4, 20.0, 30.0, 1e-3, 40}};
  ErrorBound with(mechanism, scene);
  without.compute(someMotion());
  with.compute(someMotion());
  // w = 3 + 6, alpha = 5 + 10 + 6 * 3
  const double gamma = 9.81 + 14 * 0.65 + 7 + 12;
  expectNear(without.wrenches()[3].force, gamma + (81 + 33));
  expectNear(without.wrenches()[3].moment, gamma + (81 + 33));
  expectNear(without.efforts()[0], without.wrenches()[1].moment + 2 * without.wrenches()[3].moment);
  expectNear(with.efforts()[0] - without.efforts()[0],
             2 * (10 * (2 * 0.7 + 0.5 + 4) + 20 * 2 * 3 + 30 + 40 * 2 * 5));
  EXPECT_EQ(with.efforts()[1], without.efforts()[1]);
}

TEST(ErrorBound, RefusesWhatInverseDynamicsRefuses) {
  const Mechanism mechanism = turningSlide().build();
  ErrorBound bound(mechanism, Scene());
  EXPECT_THROW(bound.compute(Motion(1)), MotionError);
  Motion motion(2);
  motion.qdd.resize(3);
  EXPECT_THROW(bound.compute(motion), MotionError);
  Scene scene;
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].link = "nowhere";
  EXPECT_THROW(ErrorBound(mechanism, scene), SceneError);
  scene.applied_wrenches.clear();
  scene.joints.resize(1);
  scene.joints[0].joint = "nowhere";
  EXPECT_THROW(ErrorBound(mechanism, scene), SceneError);
}

std::vector<int> depthsOf(const std::vector<int>& parents) {
  RobotBuilder builder(3);
  for (const int parent : parents) builder.add(parent);
  return ErrorBound(builder.build(), Scene()).depths();
}

TEST(ErrorBound, DepthOfAChainIsItsLengthFromEveryJoint) {
  EXPECT_EQ(depthsOf({}), (std::vector<int>{1}));
  EXPECT_EQ(depthsOf({0, 1, 2, 3}), (std::vector<int>{5, 4, 4, 4, 4}));
}

TEST(ErrorBound, DepthOfAStarGrowsWithTheLogarithm) {
  for (const int arms : {1, 2, 3, 4, 5, 8, 9, 1000}) {
    const std::vector<int> depths = depthsOf(std::vector<int>(arms, 0));
    EXPECT_EQ(depths[0], 2 + static_cast<int>(std::ceil(std::log2(arms)))) << arms;
    EXPECT_EQ(depths.back(), 1);
  }
}

TEST(ErrorBound, DepthOfABinaryTreeCountsItsForks) {
  // Two levels of forks: 0 -> 1 (-> 2, 3), 4 (-> 5, 6).
  EXPECT_EQ(depthsOf({0, 1, 1, 0, 4, 4}), (std::vector<int>{5, 3, 2, 2, 3, 2, 2}));
}

// The longest path by joints is not the deepest where another has a hub.
TEST(ErrorBound, DepthIsTheLargestSumOverPaths) {
  // 1 -> 2 -> 3 (-> 4, 5, 6, 7, 8), and 1 -> 9 -> 10 -> 11 -> 12.
  const std::vector<int> depths = depthsOf({0, 1, 2, 3, 3, 3, 3, 3, 1, 9, 10, 11});
  EXPECT_EQ(depths[3], 2 + 1 + 3 + 1);
  EXPECT_EQ(depths[9], 1 + 4);
  EXPECT_EQ(depths[1], 1 + 1 + 1 + 1 + 3 + 1);
  EXPECT_EQ(depths[0], 1 + depths[1]);
}

TEST(ErrorBound, DepthOfAnEffortIsThatOfItsDeepestJoint) {
  RobotBuilder builder = chainOf(1);
  builder.add(0);
  builder.add(2);
  builder.add(3);
  builder.add(0);
  builder.joint(2).mimics = true;
  builder.joint(2).coordinate = 0;
  builder.joint(3).coordinate = 1;
  builder.joint(4).coordinate = 2;
  builder.joint(5).coordinate = 3;
  const ErrorBound bound(builder.build(), Scene());
  EXPECT_EQ(bound.effortDepths(), (std::vector<int>{3, 3, 3, 1}));
}

#ifdef VWD_HAS_REAL113

// A sum of norms may equal the norm of the sum, except for its own rounding.
constexpr double kOwnRounding = 1e-13;

// Every magnitude is at least that of what is summed.
void expectBounds(const Mechanism& mechanism, const Scene& scene, const Motion& motion) {
  ErrorBound bound(mechanism, scene);
  bound.compute(motion);
  const Reference113 truth(mechanism, scene, motion);
  const auto expectBound = [](double magnitude_of_sum, Real113 value, const char* what) {
    ASSERT_TRUE(std::isfinite(magnitude_of_sum));
    EXPECT_LE(static_cast<double>(value), magnitude_of_sum * (1 + kOwnRounding)) << what;
  };
  for (int k = -1; k < static_cast<int>(mechanism.joints().size()); ++k) {
    const Reference113::Wrench wrench = truth.rootAxes(k);
    expectBound(bound.wrenches()[k + 1].force, norm(wrench.force), "force");
    expectBound(bound.wrenches()[k + 1].moment, norm(wrench.torque), "moment");
  }
  const std::vector<Real113> efforts = truth.efforts();
  for (std::size_t c = 0; c < efforts.size(); ++c) {
    expectBound(bound.efforts()[c], magnitude(efforts[c]), "effort");
  }
}

TEST(ErrorBound, BoundsTheWrenchesOfRandomTrees) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    RandomRobot robot(seed, 1 + static_cast<int>(seed) % 17);
    const Mechanism mechanism = readUrdf(robot.urdf());
    Scene scene;
    scene.gravity << 1.5, -3, 9;
    scene.static_motion = seed % 5 == 0;
    scene.applied_wrenches.resize(seed % 3);
    for (AppliedWrench& applied : scene.applied_wrenches) {
      applied.link = mechanism.links()[robot.pick(static_cast<int>(mechanism.links().size()))].name;
      applied.at << robot.uniform(-1, 1), robot.uniform(-1, 1), 0.5;
      applied.force << robot.uniform(-30, 30), robot.uniform(-30, 30), 8;
      applied.torque << robot.uniform(-9, 9), 2, robot.uniform(-9, 9);
      applied.axes = seed % 2 ? Axes::kLink : Axes::kRoot;
    }
    for (const double scale : {0.01, 1.0, 100.0}) {
      expectBounds(mechanism, scene, robot.motion(mechanism, scale));
    }
  }
}

#endif  // VWD_HAS_REAL113

}  // namespace
}  // namespace virtual_work_dynamics
