#include <gtest/gtest.h>

#include "allocation_guard.h"
#include "dynamics/live_wrenches.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/deviations.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kStamp = 1600000000123456789;

Scene liveScene() {
  Scene scene;
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].name = "push";
  scene.applied_wrenches[0].link = "link_3";
  scene.applied_wrenches[0].live = true;
  return scene;
}

Mechanism chain(RobotBuilder& builder) {
  for (const int parent : {0, 1, 2}) builder.add(parent);
  return builder.build();
}

MeasuredWrench measured(int frame, std::int64_t stamp_ns) {
  MeasuredWrench wrench;
  wrench.stamp_ns = stamp_ns;
  wrench.frame = frame;
  wrench.value.force << 10, -20, 5;
  return wrench;
}

TEST(LiveWrenches, AreReadWithoutAllocation) {
  RobotBuilder builder(3);
  const Mechanism mechanism = chain(builder);
  const Scene scene = liveScene();
  LiveWrenches wrenches(mechanism, scene, 0.1);
  Load load(scene);
  const Motion motion = builder.motion();
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) wrenches.push(0, measured(1, kStamp + 1000 * i));
  const bool unknown = wrenches.read(kStamp + 1500).has_value();
  wrenches.getLoad(motion, load);
  const std::size_t allocations = guard.allocations();
  EXPECT_FALSE(unknown);
  EXPECT_EQ(allocations, 0u);
}

TEST(LiveWrenches, EnterDeviationsWithoutAllocation) {
  RobotBuilder builder(3);
  const Mechanism mechanism = chain(builder);
  const Scene scene = liveScene();
  LiveWrenches wrenches(mechanism, scene, 0.1);
  wrenches.push(0, measured(0, kStamp));
  ASSERT_FALSE(wrenches.read(kStamp));
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const Motion motion = builder.motion();
  MotionCovariance covariance;
  covariance.coordinates.assign(3, 1e-8 * Eigen::Matrix3d::Identity());
  const LoadLaw law = [&](const Motion& at, Load& load) { wrenches.getLoad(at, load); };
  deviations.computeMotion(motion, covariance, law, workspace);
  const AllocationGuard guard;
  deviations.computeMotion(motion, covariance, law, workspace);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace virtual_work_dynamics
