#include <gtest/gtest.h>

#include "allocation_guard.h"
#include "four_bar.h"
#include "random_motions.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {
namespace {

void expectNoAllocation(const Mechanism& mechanism, Scene scene, const Motion& motion) {
  scene.tolerances = {0.03, 0.1};
  scene.root_moves = true;
  AppliedWrench wrench;
  wrench.link = mechanism.links().back().name;
  wrench.deviation = WrenchDeviation{1, 0.1};
  scene.applied_wrenches = {wrench};
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  MotionCovariance covariance = randomCovariance(1, motion.q.size(), 1e-4);
  covariance.root.diagonal().setConstant(1e-6);
  covariance.turns.assign(mechanism.orientations(), TurnCovariance::Identity() * 1e-6);
  covariance.wrenches = wrenchCovariances(scene);
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) {
    deviations.computeMotion(motion, covariance, workspace);
    deviations.computeDescription(motion, workspace);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(workspace.motion().effort.maxCoeff(), 0);
  EXPECT_GT(workspace.description().effort.maxCoeff(), 0);
}

TEST(Deviations, ComputingDoesNotAllocate) {
  RobotBuilder builder = chainOf(7);
  expectNoAllocation(builder.build(), Scene(), builder.motion());
  Scene scene;
  scene.joint_types.push_back({"joint_3", CompoundType::kSpherical, {}, {}, {}});
  const Mechanism turning = withJointTypes(builder.build(), scene);
  expectNoAllocation(turning, scene,
                     Motion(static_cast<Eigen::Index>(turning.coordinates().size()), 1));
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('B');
  expectNoAllocation(cut.mechanism, cut.scene, cut.motion(four_bar.turnings(1.1, 3.1, -4.2)));
}

}  // namespace
}  // namespace virtual_work_dynamics
