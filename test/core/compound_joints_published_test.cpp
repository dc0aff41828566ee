#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Numbers that other programs' tests publish, closed forms of one line each, in double.
constexpr double kClosedForm = 1e-14;

// A body of 1 kg and 1 kg m^2 about its centre, the origin, in the space of a scene without
// gravity.
struct OneBody {
  OneBody(const std::string& type, const std::string& more)
      : scene(readScene(YAML::Load("{gravity: [0, 0, 0], joint_types: [{name: j, type: " + type +
                                   more + "}], reactions: [j]}"))),
        robot(withJointTypes(
            readUrdf("<robot name='one'><link name='base'/><link name='body'><inertial>"
                     "<mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
                     "</inertial></link><joint name='j' type='fixed'><parent link='base'/>"
                     "<child link='body'/></joint></robot>"),
            scene)),
        motion(static_cast<Eigen::Index>(robot.coordinates().size())) {}

  void pushBy(const Eigen::Vector3d& torque, const Eigen::Vector3d& force) {
    AppliedWrench wrench;
    wrench.link = "body";
    wrench.axes = Axes::kRoot;
    wrench.force = force;
    wrench.torque = torque;
    scene.applied_wrenches = {wrench};
  }

  const Results& compute() {
    Request request;
    request.root_axes = {"j"};
    request.poses = true;
    dynamics = std::make_unique<Dynamics>(robot, scene, request);
    workspace = std::make_unique<Dynamics::Workspace>(dynamics->makeWorkspace());
    dynamics->compute(motion, *workspace);
    return workspace->results();
  }

  Scene scene;
  Mechanism robot;
  Motion motion;
  std::unique_ptr<Dynamics> dynamics;
  std::unique_ptr<Dynamics::Workspace> workspace;
};

// Drake, multibody/tree/test/planar_mobilizer_test.cc, ProjectSpatialForce: tau = (1, 2, 3).
TEST(CompoundJoints, OfAPlaneProjectForcesAsDrakeDoes) {
  OneBody body("planar", ", axis: [0, 0, 1]");
  body.pushBy({1, 2, 3}, {1, 2, 3});
  body.motion.q << 0.3, -0.2, 0.7;
  const Eigen::VectorXd& effort = body.compute().effort;
  EXPECT_NEAR(effort[0], -1, kClosedForm);
  EXPECT_NEAR(effort[1], -2, kClosedForm);
  EXPECT_NEAR(effort[2], -3, kClosedForm);
}

// Drake, universal_mobilizer_test.cc: at (1, 0.5), torque (1, 2, 3): tau = (1, 2 cos 1 + 3 sin 1).
TEST(CompoundJoints, OfACrossProjectTorquesAsDrakeDoes) {
  OneBody body("universal", ", axis: [1, 0, 0], axis2: [0, 1, 0]");
  body.pushBy({1, 2, 3}, {0, 0, 0});
  body.motion.q << 1, 0.5;
  const Eigen::VectorXd& effort = body.compute().effort;
  EXPECT_NEAR(effort[0], -1, kClosedForm);
  EXPECT_NEAR(effort[1], -3.6050175661599690, kClosedForm);
}

// Drake, screw_mobilizer_test.cc: pitch 0.01, torque = force = (1, 2, 3).
TEST(CompoundJoints, OfAScrewProjectForcesAsDrakeDoes) {
  OneBody body("screw", ", axis: [0.36, -0.48, 0.8], pitch: 0.01");
  body.pushBy({1, 2, 3}, {1, 2, 3});
  EXPECT_NEAR(body.compute().effort[0], -1.8028647889756541, kClosedForm);
}

// gazebo-classic, test/integration/joint_screw.cc: 35 / (I + m / pitch^2) = 17.5 for 1 rad/m, where
// the body advances by -angle / pitch: in m per revolution -2 pi.
TEST(CompoundJoints, OfAScrewAccelerateAsInGazebo) {
  OneBody body("screw", ", axis: [1, 0, 0], pitch: -6.283185307179586");
  body.motion.q << 0.8;
  body.motion.qdd << 17.5;
  const Results& results = body.compute();
  EXPECT_NEAR(results.effort[0], 35, 35 * kClosedForm);
  EXPECT_NEAR(results.poses[0].position.x(), -0.8, kClosedForm);
}

// DART, unittests test_ScrewJoint.cpp: 0.1 at pi is 0.05, 1.23 at 4.5 pi is 2.7675.
TEST(CompoundJoints, OfAScrewAdvanceAsInDart) {
  OneBody small("screw", ", axis: [0, 0, 1], pitch: 0.1");
  small.motion.q << M_PI;
  EXPECT_NEAR(small.compute().poses[0].position.z(), 0.05, kClosedForm);
  OneBody large("screw", ", axis: [0, 0, 1], pitch: 1.23");
  large.motion.q << 4.5 * M_PI;
  EXPECT_NEAR(large.compute().poses[0].position.z(), 2.7675, kClosedForm);
}

// What a thread bears: five components are its own, and moment and force along the axis do no work.
TEST(CompoundJoints, OfAScrewBearNoWork) {
  OneBody body("screw", ", axis: [0, 0, 1], pitch: 0.5");
  body.scene.include_active = false;
  body.pushBy({1, 2, 3}, {4, 5, 6});
  const Wrench& borne = body.compute().root_axes[0];
  EXPECT_EQ(borne.force, Eigen::Vector3d(-4, -5, -6));
  EXPECT_NEAR(borne.torque.z() + borne.force.z() * 0.5 / (2 * M_PI), 0, kClosedForm);
  EXPECT_NEAR(borne.torque.z(), 6 * 0.5 / (2 * M_PI), kClosedForm);
}

}  // namespace
}  // namespace virtual_work_dynamics
