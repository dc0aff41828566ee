#include <gtest/gtest.h>

#include "allocation_guard.h"
#include "four_bar.h"
#include "random_motions.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/deviations.h"

namespace virtual_work_dynamics {
namespace {

void expectNoAllocation(const Mechanism& mechanism, Scene scene, const Motion& motion) {
  scene.tolerances = {0.03, 0.1};
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const MotionCovariance covariance = randomCovariance(1, motion.q.size(), 1e-4);
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
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('B');
  expectNoAllocation(cut.mechanism, cut.scene, cut.motion(four_bar.turnings(1.1, 3.1, -4.2)));
}

}  // namespace
}  // namespace virtual_work_dynamics
