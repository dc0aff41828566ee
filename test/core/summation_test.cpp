#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "judge.h"
#include "plain_results.h"
#include "reference_113.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

#ifndef VWD_HAS_REAL113

TEST(Summation, IsMeasuredIn113Bits) {
  GTEST_SKIP() << "this compiler has no number of 113 bits";
}

#else

constexpr double kEps = std::numeric_limits<double>::epsilon();

// Children of a hub on the first joint; without them it has no mass. All at the hub's origin.
RobotBuilder star(int children) {
  RobotBuilder builder(7);
  builder.add(JointType::kRevolute, 0, Vector3l::UnitX(), Matrix3l::Identity(), {0, 0, 0});
  builder.removeInertia(1);
  for (int i = 0; i < children; ++i) {
    const int child =
        builder.add(JointType::kRevolute, 1, Vector3l::UnitZ(), Matrix3l::Identity(), {0, 0, 0});
    builder.removeInertia(child);
  }
  return builder;
}

// Small masses beside one large: added one by one to the large one, all would be lost.
TEST(Summation, HubsSumPairwise) {
  constexpr int kChildren = 1000;
  Scene scene;
  scene.gravity = {-1, 0, 0};
  scene.static_motion = true;
  scene.reactions = ReactionSelection::kNamed;
  scene.reaction_names = {"joint_1"};
  for (const int large : {2, 3, kChildren / 2, kChildren + 1}) {
    RobotBuilder builder = star(kChildren);
    for (int child = 2; child <= kChildren + 1; ++child) builder.link(child).mass = kEps / 2;
    builder.link(large).mass = 1;
    const Mechanism mechanism = builder.build();
    const InverseDynamics dynamics(mechanism, scene);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(Motion(kChildren + 1), workspace);
    const double expected = 1 + (kChildren - 1) * kEps / 2;
    // Ten levels, half a unit of the last digit each.
    EXPECT_NEAR(workspace.rootAxes()[0].force.x(), expected, 5 * kEps) << large;
  }
}

TEST(Summation, CountsEveryChildOfAHubOnce) {
  for (int children = 1; children <= 40; ++children) {
    RobotBuilder builder = star(children);
    for (int child = 2; child <= children + 1; ++child) {
      builder.addInertia(child);
      builder.joint(child).p_PoKo_P = builder.vector(0.3);
    }
    const Mechanism mechanism = builder.build();
    const std::vector<Motion> motions = builder.motions(9);
    const Scene scene;
    const Request request = requestEveryJoint(mechanism);
    Judge judge(mechanism, scene);
    for (const InstructionSet set : supportedInstructionSets()) {
      const InverseDynamics dynamics(mechanism, scene, request, set);
      BlockInverseDynamics<double> block(dynamics, 1, set);
      FencedBlock<double> arrays(block, motions, BlockLayout::kStructureOfArrays);
      arrays.compute(block);
      for (std::size_t n = 0; n < motions.size(); ++n) {
        const Errors one = judge.errorsOf(singleResults(dynamics, motions[n]), motions[n]);
        const Errors many = judge.errorsOf(arrays.sample(n), motions[n]);
        EXPECT_LE(one.over_bound, 1) << children << " children: " << one.worst;
        EXPECT_LE(many.over_bound, 1) << children << " children: " << many.worst;
      }
    }
  }
}

// A geared angle of a billion radians, rounded to double, would be off by 6e-8.
TEST(GearedAngle, IsExactAtABillionRadians) {
  RobotBuilder builder(3);
  builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), Matrix3l::Identity(), {0, 0, 0});
  builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), Matrix3l::Identity(), {0, 0, 0});
  builder.mimicFirst(0.7, 0.3);
  builder.add(JointType::kContinuous, 0, builder.direction(), builder.rotation(), {0, 0, 0});
  builder.mimicFirst(-1e3, 1e6 / 3.0);
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.gravity = {-1, 0, 0};
  scene.static_motion = true;
  const Request request = requestAll(mechanism);
  std::vector<Motion> motions;
  for (const double angle : {0.0, 1.0, 1e3, 1e6, 1.5e6, 1e9, -1e9, 3.3e9, 1e10}) {
    for (int i = 0; i < 20; ++i) {
      motions.emplace_back(1);
      motions.back().q[0] = angle * (1 + builder.uniform(-1e-3, 1e-3));
    }
  }
  for (const InstructionSet set : supportedInstructionSets()) {
    const InverseDynamics dynamics(mechanism, scene, request, set);
    BlockInverseDynamics<double> block(dynamics, 1, set);
    FencedBlock<double> arrays(block, motions, BlockLayout::kRowMajor);
    arrays.compute(block);
    for (std::size_t n = 0; n < motions.size(); ++n) {
      const Reference113 reference(mechanism, scene, motions[n]);
      const auto one = singleResults(dynamics, motions[n]).child_axes;
      const auto many = arrays.sample(n).child_axes;
      for (int joint = 0; joint < 3; ++joint) {
        const Vector113 force = reference.childAxes(joint).force;
        const double tolerance = 4 * kEps * static_cast<double>(norm(force));
        const double expected[] = {static_cast<double>(force.x), static_cast<double>(force.y),
                                   static_cast<double>(force.z)};
        for (int axis = 0; axis < 3; ++axis) {
          const std::size_t at = static_cast<std::size_t>(6 * joint + axis);
          EXPECT_NEAR(one[at], expected[axis], tolerance) << toString(set) << motions[n].q[0];
          EXPECT_NEAR(many[at], expected[axis], tolerance) << toString(set) << motions[n].q[0];
        }
      }
    }
  }
}

#endif

}  // namespace
}  // namespace virtual_work_dynamics
