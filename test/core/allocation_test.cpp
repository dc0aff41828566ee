#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "allocation_guard.h"
#include "condition_kinds.h"
#include "dynamics/sample_rows.h"
#include "four_bar.h"
#include "loop_examples.h"
#include "loops/completion.h"
#include "loops/forces.h"
#include "loops/groups.h"
#include "loops/kinematics.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/passive_joints.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

TEST(AllocationGuard, SeesAllocationsInTheTest) {
  const AllocationGuard guard;
  const std::unique_ptr<int> one(new int(1));
  void* volatile two = std::malloc(10);
  std::free(two);
  EXPECT_EQ(guard.allocations(), 2u);
}

// The one that matters: allocations inside the compiled core are seen too.
TEST(AllocationGuard, SeesAllocationsInsideTheCore) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  const InverseDynamics dynamics(mechanism, Scene());
  const AllocationGuard guard;
  const Workspace workspace = dynamics.makeWorkspace();
  EXPECT_GE(guard.allocations(), 4u);
}

Scene busyScene() {
  Scene scene;
  scene.applied_wrenches.resize(2);
  for (auto& wrench : scene.applied_wrenches) {
    wrench.link = "link_3";
    wrench.force << 1, 2, 3;
  }
  scene.applied_wrenches[1].axes = Axes::kRoot;
  return scene;
}

TEST(InverseDynamics, ComputeDoesNotAllocate) {
  RandomRobot robot(5, 20);
  const Mechanism mechanism = readUrdf(robot.urdf());
  const Scene scene = busyScene();
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  request.poses = request.twists = true;
  const InverseDynamics dynamics(mechanism, scene, request);
  Workspace workspace = dynamics.makeWorkspace();
  const Motion motion = robot.motion(mechanism);
  Load load(scene);
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) {
    dynamics.compute(motion, workspace);
    load.wrenches[0].force.x() = i;
    dynamics.compute(motion, load, workspace);
  }
  EXPECT_TRUE(workspace.finite());
  EXPECT_EQ(guard.allocations(), 0u);
}

template <typename Real>
void expectLagrangeDoesNotAllocate() {
  RandomRobot robot(5, 20);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene = busyScene();
  scene.joints.push_back({"joint_1", 1, 0, 2.0, 3.0, 0.1, 4});
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  LagrangeDynamics<Real> lagrange(mechanism, scene, request);
  const Motion motion = robot.motion(mechanism);
  Load load(scene);
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) {
    lagrange.compute(motion);
    load.wrenches[0].force.x() = i;
    lagrange.compute(motion, load);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_NE(lagrange.effort()[0], 0);
}

TEST(LagrangeDynamics, ComputeDoesNotAllocate) {
  expectLagrangeDoesNotAllocate<double>();
  expectLagrangeDoesNotAllocate<long double>();
}

TEST(Certifier, CheckDoesNotAllocate) {
  RandomRobot robot(5, 20);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene = busyScene();
  scene.joints = {{mechanism.coordinateNames()[0], 1, 2, 3.0, 4.0, 5, 6}};
  Certifier certifier(mechanism, scene);
  ErrorBound bound(mechanism, scene);
  const Motion motion = robot.motion(mechanism);
  const Eigen::VectorXd effort = Eigen::VectorXd::Ones(motion.q.size());
  const Wrench ground;
  Load load(scene);
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) {
    load.wrenches[0].force.x() = i;
    EXPECT_GT(certifier.check(motion, effort, ground).largest(), 0);
    EXPECT_GT(certifier.check(motion, load, effort, ground).largest(), 0);
    bound.compute(motion);
    bound.compute(motion, load);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

/// An over-actuated linkage with a spring and an applied wrench, so that every step of the solution
/// is taken, at an ordinary position and at its change point.
class BusyLinkage : public testing::Test {
 protected:
  BusyLinkage() {
    FourBar four_bar;
    four_bar.lengths = {0.3L, 0.8L, 0.3L, 0.8L};
    cut_ = std::make_unique<FourBar::Cut>(four_bar.cut('D'));
    cut_->scene.assembly = {{"A", 1.0}, {"B", -1.0}, {"C", 1.0}};
    PointSpring spring;
    spring.link_a = "base";
    spring.link_b = "coupler";
    spring.stiffness = 3;
    cut_->scene.springs = {spring};
    AppliedWrench push;
    push.link = "rocker";
    push.force << 1, 2, 3;
    cut_->scene.applied_wrenches = {push};
    request_.child_axes = request_.root_axes = {"A", "B", "C", "D", "ground"};
    request_.poses = request_.twists = true;
    motion_ = cut_->motion({{{0.9, 1, 2}, {0, 0, 0}, {0.9, 1, 2}}});
  }

  /// Calls `compute` with what compiles the linkage under each policy, once with the crank actuated
  /// and once with the closure, too.
  template <typename Compute>
  void withEachPolicy(const Compute& compute) {
    for (const RedundancyPolicy policy : {RedundancyPolicy::kMinimumNorm, RedundancyPolicy::kZeroAt,
                                          RedundancyPolicy::kStiffness}) {
      for (const bool both : {false, true}) {
        cut_->scene.actuated = std::vector<std::string>{"A"};
        if (both) cut_->scene.actuated->push_back("D");
        cut_->scene.redundancy.policy = policy;
        cut_->scene.redundancy.zero_at = {"D"};
        compute(both);
      }
    }
  }

  std::unique_ptr<FourBar::Cut> cut_;
  Request request_;
  Motion motion_;
  const Motion change_point_{3};
};

void expectEveryStepWasTaken(const Results& results, int redundancy, bool both) {
  EXPECT_EQ(redundancy, both ? 4 : 3);
  EXPECT_EQ(results.loops.determinacy.free_motions, both ? 0 : 1);
  EXPECT_TRUE(results.finite());
}

TEST_F(BusyLinkage, ClosedLoopDynamicsDoesNotAllocate) {
  withEachPolicy([&](bool both) {
    const ClosedLoopDynamics dynamics(cut_->mechanism, cut_->scene, request_);
    ClosedLoopDynamics::Workspace workspace = dynamics.makeWorkspace();
    const Results& results = workspace.results();
    const std::vector<bool> given{true, false, false};
    Load load(cut_->scene);
    const AllocationGuard guard;
    EXPECT_TRUE(dynamics.complete(motion_, given, workspace));
    EXPECT_TRUE(dynamics.complete(motion_, workspace));
    EXPECT_TRUE(dynamics.completeFromCloseBy(motion_, workspace));
    dynamics.compute(motion_, workspace);
    const int redundancy = results.loops.determinacy.redundancy;
    load.wrenches[0].force.x() = 7;
    dynamics.compute(motion_, load, workspace);
    dynamics.compute(change_point_, load, workspace);
    dynamics.compute(change_point_, workspace);
    EXPECT_EQ(guard.allocations(), 0u);
    expectEveryStepWasTaken(results, redundancy, both);
  });
}

TEST_F(BusyLinkage, DynamicsDoesNotAllocate) {
  withEachPolicy([&](bool both) {
    const Dynamics dynamics(cut_->mechanism, cut_->scene, request_);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    const Results& results = workspace.results();
    Load load(cut_->scene), tree_load(dynamics.tree());
    const AllocationGuard guard;
    EXPECT_TRUE(dynamics.complete(motion_, workspace));
    EXPECT_TRUE(dynamics.completeFromCloseBy(motion_, workspace));
    dynamics.compute(motion_, workspace);
    const int redundancy = results.loops.determinacy.redundancy;
    dynamics.compute(change_point_, load, workspace);
    dynamics.compute(change_point_, workspace);
    dynamics.getTreeLoad(results, tree_load);
    EXPECT_EQ(guard.allocations(), 0u);
    expectEveryStepWasTaken(results, redundancy, both);
    EXPECT_GT(tree_load.wrenches.size(), load.wrenches.size());
  });
}

// A way that is halved, and one that leads out of reach.
TEST_F(BusyLinkage, PassiveJointsDoNotAllocate) {
  withEachPolicy([&](bool both) {
    if (both) return;  // where a closure is actuated, all joints must be given
    const Dynamics dynamics(cut_->mechanism, cut_->scene, request_);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    PassiveJoints passive(cut_->mechanism, dynamics);
    Motion far = motion_;
    far.q[0] = 2.5;
    const AllocationGuard guard;
    EXPECT_TRUE(passive.complete(motion_, dynamics, workspace));
    EXPECT_TRUE(passive.complete(far, dynamics, workspace));
    EXPECT_GT(passive.searches(), 1);
    far.q.setZero();
    EXPECT_FALSE(passive.complete(far, dynamics, workspace));  // the change point
    EXPECT_EQ(guard.allocations(), 0u);
  });
}

TEST(PassiveJoints, OfAPoseDoNotAllocate) {
  const std::string source = VWD_SOURCE_DIR;
  const Mechanism mechanism = readUrdfFile(source + "/urdf/stewart_gough.urdf");
  const Scene scene = readSceneFile(source + "/config/stewart_gough_scene.yaml");
  const Dynamics dynamics(mechanism, scene, {false, {}, {}, false, false});
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Given given;
  given.coordinates.assign(mechanism.coordinates().size(), false);
  given.links = {mechanism.linkIndex("platform")};
  PassiveJoints passive(mechanism, dynamics, given);
  Motion motion(dynamics.coordinates()), driven(7);
  driven.q << platformPose(0.4L).p.cast<double>(),
      Eigen::Quaternion<long double>(platformPose(0.4L).R).cast<double>().coeffs();
  const AllocationGuard guard;
  EXPECT_TRUE(passive.complete(motion, driven, dynamics, workspace));
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Dynamics, OfAnOpenChainDoesNotAllocate) {
  RandomRobot robot(5, 20);
  const Mechanism mechanism = readUrdf(robot.urdf());
  const Scene scene = busyScene();
  const Dynamics dynamics(mechanism, scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  PassiveJoints passive(mechanism, dynamics);
  Motion motion = robot.motion(mechanism);
  Load load(scene), tree_load(scene);
  const AllocationGuard guard;
  EXPECT_TRUE(passive.complete(motion, dynamics, workspace));
  EXPECT_TRUE(dynamics.complete(motion, workspace));
  EXPECT_TRUE(dynamics.completeFromCloseBy(motion, workspace));
  dynamics.compute(motion, workspace);
  dynamics.compute(motion, load, workspace);
  dynamics.getTreeLoad(workspace.results(), tree_load);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_TRUE(workspace.results().finite());
}

TEST(SampleRows, ComputeAndReadDoNotAllocate) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('D');
  Scene open = cut.scene;
  open.closures.clear();
  open.actuated.reset();
  open.assembly.clear();
  constexpr std::size_t kRows = 40;
  MotionTable table;
  table.joints = cut.mechanism.coordinateNames();
  table.times.resize(kRows);
  table.positions = table.velocities = table.accelerations = Eigen::MatrixXd::Zero(kRows, 3);
  for (std::size_t n = 0; n < kRows; ++n) {
    const Motion motion = cut.motion(four_bar.turnings(0.02L * n, 1, 2));
    table.positions.row(static_cast<Eigen::Index>(n)) = motion.q;
    table.velocities.row(static_cast<Eigen::Index>(n)) = motion.qd;
    table.accelerations.row(static_cast<Eigen::Index>(n)) = motion.qdd;
  }
  for (const Scene* scene : {&std::as_const(open), &cut.scene}) {
    for (const int threads : {1, 2}) {
      const Dynamics dynamics(cut.mechanism, *scene);
      SampleRows rows(dynamics, 20, threads);
      double sum = 0;
      const AllocationGuard guard;
      rows.compute(table, 0, 20);
      rows.compute(table, 20, 20);
      for (std::size_t i = 0; i < 20; ++i) sum += rows.read(i).effort[0];
      EXPECT_EQ(guard.allocations(), 0u);
      EXPECT_NE(sum, 0);
    }
  }
}

// Conditions without wrenches, one of them redundant, and one without a position.
TEST(LoopKinematics, OtherConditionsDoNotAllocate) {
  RobotBuilder builder(5);
  for (int i = 0; i < 4; ++i) builder.add(i);
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.actuated = {"joint_1", "joint_3"};
  const LoopScene resolved = resolveLoopScene(mechanism, scene);
  const Law speed{[](double t) { return 0.2 + 0.5 * t; }, [](double) { return 0.5; },
                  [](double) { return 0.0; }};
  const auto gear = std::make_shared<Gear>(mechanism, 3, 1, 2.0, 0.1);
  LoopKinematics kinematics(mechanism, ConditionSets{std::make_shared<Blade>(speed), gear, gear});
  const std::vector<LoopGroup> groups = loopGroups(mechanism, kinematics);
  LoopCompletion completion(mechanism, kinematics, groups, 1e-10, 1);
  ASSERT_EQ(groups.size(), 1u);
  LoopForces forces(mechanism, kinematics, resolved, groups[0], 1);
  const std::vector<Wrench> reactions(4);
  const Eigen::VectorXd load = Eigen::VectorXd::Ones(4);
  Motion motion(4);
  const AllocationGuard guard;
  EXPECT_TRUE(completion.complete(kinematics, motion, resolved.actuated));
  forces.setPosition();
  forces.solve(load, reactions);
  for (Eigen::Index i = 0; i < forces.directions(); ++i) forces.direction(i);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(forces.directions(), 1);
}

template <typename Real>
void expectBlocksDoNotAllocate(BlockLayout layout, int threads) {
  RandomRobot robot(5, 20);
  const Mechanism mechanism = readUrdf(robot.urdf());
  const Scene scene = busyScene();
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  request.poses = request.twists = true;
  const InverseDynamics dynamics(mechanism, scene, request);
  BlockInverseDynamics<Real> block(dynamics, threads);
  constexpr std::size_t kSamples = 101;
  const std::size_t reactions = request.root_axes.size();
  const std::vector<Real> motion(block.coordinates() * kSamples, Real(0.5));
  std::vector<Real> effort(motion.size()), child_axes(6 * reactions * kSamples),
      root_axes(child_axes.size()), poses(2 * child_axes.size()), twists(child_axes.size());
  const MotionBlock<Real> in{kSamples, motion.data(), motion.data(), motion.data()};
  const ResultBlock<Real> out{effort.data(), child_axes.data(), root_axes.data(), poses.data(),
                              twists.data()};
  Load load(scene);
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) {
    block.compute(layout, in, out);
    load.wrenches[1].force.x() = i;
    block.compute(layout, in, load, out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_NE(effort.back(), 0);
}

TEST(BlockInverseDynamics, ComputeDoesNotAllocate) {
  for (const BlockLayout layout : {BlockLayout::kStructureOfArrays, BlockLayout::kRowMajor}) {
    for (const int threads : {1, 2}) {
      expectBlocksDoNotAllocate<double>(layout, threads);
      expectBlocksDoNotAllocate<float>(layout, threads);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
