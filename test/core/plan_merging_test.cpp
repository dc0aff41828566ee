#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "named_results.h"
#include "newton_euler_oracle.h"
#include "plain_results.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Relative to the largest force or moment: a plan that keeps a fixed joint rounds a few more times
// on the way through it.
constexpr double kMerged = 1e-14;

double largest(const NamedResults& results, const Request& request) {
  double largest = 0;
  for (const std::string& name : request.child_axes) {
    largest =
        std::max({largest, results.child(name).force.norm(), results.child(name).torque.norm()});
  }
  return largest;
}

void expectClose(const Wrench& a, const Wrench& b, double scale) {
  EXPECT_LE((a.force - b.force).norm(), kMerged * scale);
  EXPECT_LE((a.torque - b.torque).norm(), kMerged * scale);
}

void expectMergingChangesNothing(const Mechanism& mechanism, const Scene& scene,
                                 const Motion& motion) {
  const Request movable = requestAll(mechanism);
  const NamedResults merged(mechanism, scene, movable, motion);
  const NamedResults kept(mechanism, scene, requestEveryJoint(mechanism), motion);
  const double scale = largest(merged, movable);
  EXPECT_LE((merged.effort() - kept.effort()).cwiseAbs().maxCoeff(), kMerged * scale);
  for (const std::string& name : movable.child_axes) {
    expectClose(merged.child(name), kept.child(name), scale);
    expectClose(merged.root(name), kept.root(name), scale);
    EXPECT_LE((merged.pose(name).position - kept.pose(name).position).norm(), kMerged);
    EXPECT_LE((merged.twist(name).linear - kept.twist(name).linear).norm(),
              kMerged * (1 + kept.twist(name).linear.norm()));
  }
}

TEST(PlanMerging, RequestedFixedJointsChangeNothing) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot random(seed, 16);
    const Mechanism mechanism = readUrdf(random.urdf());
    Scene scene;
    scene.static_motion = seed % 3 == 0;
    scene.applied_wrenches.resize(1);
    scene.applied_wrenches[0].link = "link_" + std::to_string(random.pick(16));
    scene.applied_wrenches[0].axes = seed % 2 == 0 ? Axes::kLink : Axes::kRoot;
    scene.applied_wrenches[0].at << 0.2, 0.1, -0.3;
    scene.applied_wrenches[0].force << 3, -2, 5;
    expectMergingChangesNothing(mechanism, scene, random.motion(mechanism));
  }
}

// Ground holds a pedestal of two welded bodies on which an arm stands, and a third beside it.
RobotBuilder onAPedestal() {
  RobotBuilder builder(5);
  builder.addInertia(0);
  Matrix3l R_PK = builder.rotation();
  builder.add(JointType::kFixed, 0, Vector3l::Zero(), R_PK, builder.vector(0.3));
  R_PK = builder.rotation();
  builder.add(JointType::kFixed, 1, Vector3l::Zero(), R_PK, builder.vector(0.3));
  builder.add(2);
  builder.add(3);
  R_PK = builder.rotation();
  builder.add(JointType::kPrismatic, 2, builder.direction(), R_PK, builder.vector(0.3));
  R_PK = builder.rotation();
  builder.add(JointType::kFixed, 0, Vector3l::Zero(), R_PK, builder.vector(0.3));
  return builder;
}

TEST(PlanMerging, BodiesThatRestOnTheRoot) {
  RobotBuilder builder = onAPedestal();
  const Mechanism mechanism = builder.build();
  for (const bool static_motion : {false, true}) {
    Scene scene;
    scene.static_motion = static_motion;
    const Motion motion = builder.motion();
    expectMergingChangesNothing(mechanism, scene, motion);
    const Request request = requestEveryJoint(mechanism);
    const NamedResults results(mechanism, scene, request, motion);
    const NewtonEulerOracle oracle(mechanism, scene, motion);
    const double scale = largest(results, request);
    for (const std::string& name : request.child_axes) {
      SCOPED_TRACE(name);
      const auto expected = oracle.childReaction(mechanism.jointIndex(name));
      expectClose(results.child(name),
                  {expected.force.cast<double>(), expected.torque.cast<double>()}, scale);
    }
    EXPECT_GT(results.child("joint_6").force.norm(), 1);
    EXPECT_EQ(results.twist("joint_2").linear.norm(), 0);
    EXPECT_EQ(results.twist("joint_2").angular.norm(), 0);
  }
}

// A mass that is divided among welded links is one mass.
TEST(PlanMerging, WeldedPartsAreOneBody) {
  RobotBuilder builder = chainOf(2);
  const Motion motion = builder.motion();
  const NamedResults whole(builder.build(), Scene(), requestAll(builder.build()), motion);
  const Link body = builder.link(2);
  for (int i = 0; i < 3; ++i) {
    builder.add(JointType::kFixed, 2 + i, Vector3l::Zero(), Matrix3l::Identity(), {0.1, -0.2, 0.3});
  }
  for (int i = 2; i <= 5; ++i) {  // quarters of the body, each in the frame of its link
    Link& part = builder.link(i);
    part.mass = body.mass / 4;
    part.p_KoCm_K = body.p_KoCm_K - (i - 2) * Vector3l(0.1, -0.2, 0.3);
    part.inertia_Cm_K = body.inertia_Cm_K / 4;
  }
  const Mechanism divided = builder.build();
  const NamedResults parts(divided, Scene(), requestAll(divided), motion);
  for (const char* name : {"joint_1", "joint_2"}) {
    expectClose(parts.child(name), whole.child(name), whole.child("joint_1").force.norm());
  }
  EXPECT_EQ(parts.summary().bodies, 3u);
  EXPECT_EQ(parts.summary().multiplications, whole.summary().multiplications);
}

TEST(PlanMerging, ReactionsRequestedTwiceAreRefused) {
  const Mechanism mechanism = chainOf(3).build();
  for (const bool child : {true, false}) {
    Request request;
    (child ? request.child_axes : request.root_axes) = {"joint_1", kGround, "joint_1"};
    try {
      const InverseDynamics dynamics(mechanism, Scene(), request);
      FAIL();
    } catch (const SceneError& error) {
      EXPECT_STREQ(error.what(), "reactions[2]: 'joint_1' is named twice");
    }
  }
  Request request;
  request.child_axes = request.root_axes = {"joint_1"};  // once in either axes
  EXPECT_NO_THROW(InverseDynamics(mechanism, Scene(), request));
}

TEST(PlanMerging, DroppedActiveComponentsAreDroppedInBothAxes) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    RandomRobot random(seed, 14);
    const Mechanism mechanism = readUrdf(random.urdf());
    const Motion motion = random.motion(mechanism);
    const Request request = requestEveryJoint(mechanism);
    Scene scene;
    const NamedResults full(mechanism, scene, request, motion);
    scene.include_active = false;
    const NamedResults dropped(mechanism, scene, request, motion);
    EXPECT_EQ(dropped.effort(), full.effort());
    for (const std::string& name : request.child_axes) {
      SCOPED_TRACE(name);
      Wrench expected = full.child(name);
      const int k = mechanism.jointIndex(name);
      if (k >= 0 && mechanism.joints()[k].coordinate >= 0) {
        const Eigen::Vector3d axis = mechanism.joints()[k].axis_K.cast<double>();
        const bool slides = mechanism.joints()[k].type == JointType::kPrismatic;
        Eigen::Vector3d& vector = slides ? expected.force : expected.torque;
        vector -= axis * axis.dot(vector);
      }
      const double scale = full.child(name).force.norm() + full.child(name).torque.norm();
      expectClose(dropped.child(name), expected, scale);
      const Eigen::Matrix3d R_0K = full.pose(name).orientation.toRotationMatrix();
      expectClose(dropped.root(name), {R_0K * expected.force, R_0K * expected.torque}, scale);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
