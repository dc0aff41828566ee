#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <string>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/free_turn.h"
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

// These results are printed with seven digits of numbers up to 14, and moments are 2 m times
// forces: so far forces, moments and the accelerations of centres of mass agree with each other.
constexpr double kDigits = 2e-5;
// Their angular velocities and accelerations do not agree with the accelerations of the centres so
// well: by 2.4e-4, 4.2e-4 and 7.3e-4 m/s^2, which is not what printing leaves.
constexpr double kColumnsDiffer = 1e-3;

// A row of ADAMS' results, which Chrono has in data/testing/joints: of a pendulum of 1 kg whose
// centre of mass is 2 m from the joint; all vectors in axes of ground, the reaction that on ground.
struct AdamsRow {
  Eigen::Quaterniond orientation;
  Eigen::Vector3d rate, acceleration;  // rad/s, rad/s^2
  Eigen::Vector3d force, torque;
  Eigen::Vector3d of_centre;  // acceleration of the centre of mass, m/s^2
};

struct Pendulum {
  Pendulum(const std::string& types, const Eigen::Vector3d& at, const Eigen::Matrix3d& axes,
           const Eigen::Vector3d& centre, const Eigen::Vector3d& inertia)
      : R_0J(axes),
        p_KoCm_K(centre),
        scene(readScene(YAML::Load("{joint_types: [" + types + "]}"))) {
    scene.gravity = {0, 0, -9.80665};
    scene.moments_about.resize(1);
    scene.moments_about[0].name = "j";
    scene.moments_about[0].frame = JointFrame::kParent;
    std::vector<Link> links(2);
    links[0].name = "ground_link";
    links[1].name = "pendulum";
    links[1].parent_joint = 0;
    links[1].mass = 1;
    links[1].p_KoCm_K = centre.cast<long double>();
    links[1].inertia_Cm_K = inertia.cast<long double>().asDiagonal();
    std::vector<Joint> joints(1);
    joints[0].name = "j";
    joints[0].child_link = 1;
    joints[0].p_PoKo_P = at.cast<long double>();
    joints[0].R_PK = axes.cast<long double>();
    robot = std::make_unique<Mechanism>(withJointTypes(Mechanism("p", links, joints), scene));
    motion = Motion(static_cast<Eigen::Index>(robot->coordinates().size()), robot->orientations());
  }

  /// Of the freedoms nothing is actuated: their efforts vanish, and the reaction is that of ADAMS,
  /// except for what ADAMS' own columns contradict each other by: the acceleration of the centre
  /// by which the body turns, less that of its own column. This is held against Newton's law and
  /// taken out, and the rest is printed digits.
  /// @param lever the centre, from the point that moments are about
  void expect(const AdamsRow& row, const Eigen::Vector3d& slide, const Eigen::Vector3d& lever,
              double moment) {
    const Eigen::Vector3d r = row.orientation.normalized() * p_KoCm_K;
    EXPECT_LE((row.of_centre - scene.gravity + row.force).norm(), 2 * kDigits);
    const Eigen::Vector3d contradiction =
        row.acceleration.cross(r) + row.rate.cross(row.rate.cross(r)) + slide - row.of_centre;
    EXPECT_LE(contradiction.norm(), kColumnsDiffer);
    Request request;
    request.root_axes = {"j"};
    const Dynamics dynamics(*robot, scene, request);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, workspace);
    const Results& results = workspace.results();
    EXPECT_LE(results.effort.lpNorm<Eigen::Infinity>(), 2 * kColumnsDiffer);
    EXPECT_LE((results.root_axes[0].force + row.force - contradiction).norm(), 2 * kDigits)
        << results.root_axes[0].force.transpose();
    EXPECT_LE((results.root_axes[0].torque + row.torque - lever.cross(contradiction)).norm(),
              moment)
        << results.root_axes[0].torque.transpose();
  }

  Eigen::Matrix3d R_0J;
  Eigen::Vector3d p_KoCm_K;
  Scene scene;
  std::unique_ptr<Mechanism> robot;
  Motion motion;
};

// Universal_Case03 at 4.85 s: the cross bears a moment. Numbers have seven digits.
TEST(CompoundJoints, OfACrossBearTheMomentThatAdamsFinds) {
  const AdamsRow row{{5.313570e-1, -6.558760e-1, 6.811230e-3, -5.361340e-1},
                     {-8.676210e-1, 7.658150e-1, -1.336140e-2},
                     {4.035480, -2.683080, 2.479440e-1},
                     {-2.837990, -2.759910, -7.987330e-1},
                     {-2.791780e-2, -3.167500e-2, -2.656700e-3},
                     {2.837990, 2.759910, -9.007920}};
  const Eigen::Matrix3d R_0J =
      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d(1, -1, 0).normalized()).toRotationMatrix();
  Pendulum pendulum("{name: j, type: universal, axis: [1, 0, 0], axis2: [0, 1, 0]}", {0, 0, 0},
                    R_0J, {0, 0, -2}, {0.1, 0.1, 0.04});
  // R = Rx(a) Ry(b) in the joint's frame, w = ad x + bd y', e = add x + bdd y' + ad bd x cross y'.
  const Eigen::Matrix3d R_0K = row.orientation.normalized().toRotationMatrix();
  const Eigen::Matrix3d R = R_0J.transpose() * R_0K;
  const Eigen::Vector3d x = R_0J.col(0), y = R_0K.col(1);
  EXPECT_NEAR(x.dot(y), 0, 2e-6);
  pendulum.motion.q << std::atan2(R(2, 1), R(1, 1)), std::atan2(R(0, 2), R(0, 0));
  pendulum.motion.qd << row.rate.dot(x), row.rate.dot(y);
  pendulum.motion.qdd << row.acceleration.dot(x), row.acceleration.dot(y);
  // Nor do the columns move as a cross does: about the normal to its axes they turn otherwise.
  AdamsRow of_cross = row;
  const double along_x = row.rate.dot(x), along_y = row.rate.dot(y);
  of_cross.rate = along_x * x + along_y * y;
  of_cross.acceleration =
      row.acceleration.dot(x) * x + row.acceleration.dot(y) * y + along_x * along_y * x.cross(y);
  EXPECT_LE((of_cross.rate - row.rate).norm(), kDigits);
  EXPECT_LE((of_cross.acceleration - row.acceleration).norm(), kColumnsDiffer);
  pendulum.expect(of_cross, {0, 0, 0}, R_0K * Eigen::Vector3d(0, 0, -2), kDigits);
}

// Spherical_Case02 at 5 s, at (1, 2, 3).
TEST(CompoundJoints, OfABallBearTheForceThatAdamsFinds) {
  const AdamsRow row{{8.213320e-3, -3.402070e-3, 9.238430e-1, 3.826680e-1},
                     {-3.391750e-9, 4.124360e-1, -2.701840e-11},
                     {2.963520e-6, -4.782860, -1.666570e-4},
                     {-5.102110e-1, 8.334210e-6, -2.482530e-1},
                     {0, 0, 0},
                     {5.102110e-1, -8.334210e-6, -9.558400}};
  const Eigen::Matrix3d R_0J =
      Eigen::AngleAxisd(-M_PI / 4, Eigen::Vector3d::UnitX()).toRotationMatrix();
  Pendulum pendulum("{name: j, type: spherical}", {1, 2, 3}, R_0J, {2, 0, 0}, {0.04, 0.1, 0.1});
  const Eigen::Quaterniond R_0K = row.orientation.normalized();
  setFreeTurn(*pendulum.robot, 0,
              {Eigen::Quaterniond(R_0J).conjugate() * R_0K, R_0K.conjugate() * row.rate,
               R_0K.conjugate() * row.acceleration},
              pendulum.motion);
  pendulum.expect(row, {0, 0, 0}, R_0K * Eigen::Vector3d(2, 0, 0), kDigits);
}

// Cylindrical_Case03 at 5 s, at (1, 2, 3): 83 m down the axis, moments about ground's marker.
TEST(CompoundJoints, OfACylinderBearTheMomentThatAdamsFinds) {
  const AdamsRow row{{6.867170e-1, -2.844470e-1, 2.560010e-1, 6.180400e-1},
                     {2.246120e-16, 1.834100, 1.834100},
                     {3.078020e-17, 2.513390e-1, 2.513390e-1},
                     {2.118870, 1.431280e1, -1.431280e1},
                     {1.754500e3, -1.298690e2, 1.298690e2},
                     {-2.118870, -1.431280e1, 4.506120}};
  const Eigen::Vector3d centre(1.209960, -5.788520e1, -5.969800e1);
  const Eigen::Vector3d at(1, 2, 3);
  const Eigen::Matrix3d R_0J =
      Eigen::AngleAxisd(-M_PI / 4, Eigen::Vector3d::UnitX()).toRotationMatrix();
  Pendulum pendulum("{name: j, type: cylindrical, axis: [0, 0, 1]}", at, R_0J, {2, 0, 0},
                    {0.04, 0.1, 0.1});
  const Eigen::Matrix3d R = R_0J.transpose() * row.orientation.normalized().toRotationMatrix();
  const Eigen::Vector3d u = R_0J.col(2);
  pendulum.motion.q << u.dot(centre - at), std::atan2(R(1, 0), R(0, 0));
  pendulum.motion.qd << 0, row.rate.dot(u);  // a slide along the axis of the turn
  const double slide = u.dot(row.of_centre);
  pendulum.motion.qdd << slide, row.acceleration.dot(u);
  // The moment is printed to 5e-3 N m, and the place of the centre to 5e-5 m with 20 N.
  pendulum.expect(row, slide * u, centre - at, 1e-2);
}

}  // namespace
}  // namespace virtual_work_dynamics
