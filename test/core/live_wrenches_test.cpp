#include "dynamics/live_wrenches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "moving_roots.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Rotations through six joints and back: a few roundings each, relative to the largest number.
constexpr double kRounding = 1e-13;
constexpr std::int64_t kStamp = 1600000000123456789;

// Two arms of three joints on one root, each with a sensor welded to its last link.
struct TwoArms {
  TwoArms() : builder(3) {
    for (const int parent : {0, 1, 2}) builder.add(parent);
    builder.add(JointType::kFixed, 3, Vector3l::Zero(), builder.rotation(), builder.vector(0.2));
    for (const int parent : {0, 5, 6}) builder.add(parent);
    mechanism = std::make_unique<Mechanism>(builder.build());
    wrench.force << 10, -20, 5;
    wrench.torque << 1, 2, -3;
  }

  // A live wrench on a link.
  Scene live(const std::string& link) const {
    Scene scene;
    scene.applied_wrenches.resize(1);
    scene.applied_wrenches[0].name = "push";
    scene.applied_wrenches[0].link = link;
    scene.applied_wrenches[0].live = true;
    return scene;
  }

  // Its load, measured in the frame of a link.
  Load loadOf(const Scene& scene, int frame, const Motion& motion) const {
    LiveWrenches wrenches(*mechanism, scene, 0.1);
    wrenches.push(0, {kStamp, frame, wrench});
    EXPECT_FALSE(wrenches.read(kStamp));
    Load load(scene);
    wrenches.getLoad(motion, load);
    return load;
  }

  Eigen::VectorXd efforts(const Scene& scene, const Load& load, const Motion& motion) const {
    const InverseDynamics dynamics(*mechanism, scene);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, load, workspace);
    return workspace.effort();
  }

  // Poses of links by the recursion, which shares nothing with the kinematics of loops.
  Pose poseOf(const std::string& joint, const Motion& motion) const {
    Request request;
    request.root_axes = {joint};
    request.poses = true;
    const InverseDynamics dynamics(*mechanism, Scene(), request);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, workspace);
    return workspace.poses()[0];
  }

  RobotBuilder builder;
  std::unique_ptr<Mechanism> mechanism;
  Wrench wrench;
};

// What a sensor measures acts like a wrench that the scene applies to the sensor's own link.
TEST(LiveWrenches, OfASensorActAsOnItsLink) {
  TwoArms arms;
  Scene on_sensor;
  on_sensor.applied_wrenches.resize(1);
  on_sensor.applied_wrenches[0].link = "link_4";
  on_sensor.applied_wrenches[0].force = arms.wrench.force;
  on_sensor.applied_wrenches[0].torque = arms.wrench.torque;
  const Scene live = arms.live("link_3");
  for (const Motion& motion : arms.builder.motions(4)) {
    const Eigen::VectorXd expected = arms.efforts(on_sensor, Load(on_sensor), motion);
    const Eigen::VectorXd found = arms.efforts(live, arms.loadOf(live, 4, motion), motion);
    EXPECT_LE((found - expected).norm(), kRounding * expected.norm());
    EXPECT_GT((found - arms.efforts(live, Load(live), motion)).norm(), 1);
  }
}

// One that is measured on another arm or on the root is turned and moved by the poses of both.
TEST(LiveWrenches, OfOtherLinksAreMovedByTheirPoses) {
  TwoArms arms;
  const Scene live = arms.live("link_3");
  for (const Motion& motion : arms.builder.motions(4)) {
    const Pose link = arms.poseOf("joint_3", motion);
    for (const int frame : {0, 7}) {
      const Pose sensor =
          frame == 0 ? Pose() : arms.poseOf("joint_" + std::to_string(frame), motion);
      const Eigen::Vector3d force = sensor.orientation * arms.wrench.force;
      const Eigen::Vector3d moment =
          sensor.orientation * arms.wrench.torque + (sensor.position - link.position).cross(force);
      const Load load = arms.loadOf(live, frame, motion);
      const Eigen::Quaterniond to_link = link.orientation.conjugate();
      EXPECT_LE((load.wrenches[0].force - to_link * force).norm(), kRounding * force.norm());
      EXPECT_LE((load.wrenches[0].torque - to_link * moment).norm(),
                kRounding * (moment.norm() + force.norm()));
    }
  }
}

// A sensor beside the origin of a link, and one that stands in the inertial frame.
TEST(LiveWrenches, OfPointsAndOfTheInertialFrameAreMovedByThem) {
  TwoArms arms;
  const Scene live = arms.live("link_3");
  std::mt19937 generator(6);
  for (Motion motion : arms.builder.motions(4)) {
    motion.root = randomRootMotion(generator);
    const Pose link = arms.poseOf("joint_3", motion);
    const Eigen::Quaterniond to_link = link.orientation.conjugate();
    const Eigen::Vector3d at(0.3, -0.2, 0.6);
    for (const int frame : {3, 7, MeasuredWrench::kInertial}) {
      SCOPED_TRACE(frame);
      // The frame in root axes.
      Pose sensor;
      if (frame > 0) sensor = arms.poseOf("joint_" + std::to_string(frame), motion);
      if (frame < 0) {
        sensor.orientation = motion.root.orientation.conjugate();
        sensor.position = -(sensor.orientation * motion.root.position);
      }
      LiveWrenches wrenches(*arms.mechanism, live, 0.1);
      wrenches.push(0, {kStamp, frame, arms.wrench, at});
      EXPECT_FALSE(wrenches.read(kStamp));
      Load load(live);
      wrenches.getLoad(motion, load);
      const Eigen::Vector3d force = sensor.orientation * arms.wrench.force;
      const Eigen::Vector3d lever = sensor.position + sensor.orientation * at - link.position;
      const Eigen::Vector3d moment = sensor.orientation * arms.wrench.torque + lever.cross(force);
      EXPECT_LE((load.wrenches[0].force - to_link * force).norm(), kRounding * force.norm());
      EXPECT_LE((load.wrenches[0].torque - to_link * moment).norm(),
                kRounding * (moment.norm() + lever.norm() * force.norm()));
    }
  }
}

TEST(LiveWrenches, AreInterpolatedAndInverted) {
  TwoArms arms;
  Scene scene = arms.live("link_3");
  for (const bool invert : {false, true}) {
    scene.applied_wrenches[0].invert = invert;
    LiveWrenches wrenches(*arms.mechanism, scene, 0.1);
    const Wrench later{{20, 0, -5}, {3, -2, 1}};
    wrenches.push(0, {kStamp, 3, arms.wrench});
    wrenches.push(0, {kStamp + 80000000, 3, later});
    Load load(scene);
    ASSERT_FALSE(wrenches.read(kStamp + 20000000));
    wrenches.getLoad(Motion(6), load);
    const double sign = invert ? -1 : 1;
    EXPECT_EQ(load.wrenches[0].force, sign * Eigen::Vector3d(12.5, -15, 2.5));
    EXPECT_EQ(load.wrenches[0].torque, sign * Eigen::Vector3d(1.5, 1, -2));
    EXPECT_FALSE(wrenches.anyHeld());
    ASSERT_FALSE(wrenches.read(kStamp + 90000000));
    EXPECT_TRUE(wrenches.anyHeld());
    wrenches.getLoad(Motion(6), load);
    EXPECT_EQ(load.wrenches[0].force, sign * later.force);
  }
}

TEST(LiveWrenches, LeaveOthersAloneAndNameWhatIsNotKnown) {
  TwoArms arms;
  Scene scene = arms.live("link_3");
  scene.applied_wrenches.push_back(scene.applied_wrenches[0]);
  scene.applied_wrenches[1].name = "pull";
  AppliedWrench constant;
  constant.link = "link_2";
  constant.force << 7, 8, 9;
  scene.applied_wrenches.insert(scene.applied_wrenches.begin(), constant);
  LiveWrenches wrenches(*arms.mechanism, scene, 0.1);
  ASSERT_EQ(wrenches.size(), 2u);
  EXPECT_EQ(wrenches.name(1), "pull");
  EXPECT_EQ(wrenches.read(kStamp), 0u);
  wrenches.push(0, {kStamp, 3, arms.wrench});
  EXPECT_EQ(wrenches.read(kStamp), 1u);
  wrenches.push(1, {kStamp, 3, arms.wrench});
  EXPECT_EQ(wrenches.read(kStamp), std::nullopt);
  Load load(scene);
  wrenches.getLoad(Motion(6), load);
  EXPECT_EQ(load.wrenches[0].force, constant.force);
  EXPECT_EQ(load.wrenches[1].force, arms.wrench.force);
  scene.applied_wrenches[2].link = "nowhere";
  EXPECT_THROW(LiveWrenches(*arms.mechanism, scene, 0.1), SceneError);
}

// A force F that is measured on the root has the lever from the elbow to it: when the shoulder is
// uncertain, so is the elbow's effort.
TEST(LiveWrenches, OfOtherLinksMakeEffortsUncertain) {
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), R, Vector3l::Zero());
  builder.add(JointType::kContinuous, 1, Vector3l::UnitZ(), R, Vector3l(0.5L, 0, 0));
  for (const int link : {1, 2}) builder.removeInertia(link);
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].name = "push";
  scene.applied_wrenches[0].link = "link_2";
  scene.applied_wrenches[0].live = true;
  LiveWrenches wrenches(mechanism, scene, 0.1);
  MeasuredWrench measured{kStamp, 0, {}};
  measured.value.force << 30, -40, 0;
  wrenches.push(0, measured);
  ASSERT_FALSE(wrenches.read(kStamp));
  Request request;
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  Motion motion(2);
  motion.q << -0.6, -1.1;
  MotionCovariance covariance;
  covariance.coordinates.assign(2, Eigen::Matrix3d::Zero());
  const double deviation = 1e-4;
  covariance.coordinates[0](0, 0) = deviation * deviation;
  const LoadLaw law = [&](const Motion& at, Load& load) { wrenches.getLoad(at, load); };
  deviations.computeMotion(motion, covariance, law, workspace);
  // The elbow at 0.5 (cos, sin) moves by 0.5 (-sin, cos) per radian.
  const double slope = 0.5 * (std::sin(-0.6) * -40 + std::cos(-0.6) * 30);
  // Differences over 1e-4 rad err by half of it, relative.
  EXPECT_NEAR(workspace.motion().effort[1], deviation * std::abs(slope), 1e-4 * deviation * 25);
  // The shoulder's lever is fixed on the root.
  EXPECT_NEAR(workspace.motion().effort[0], 0, 1e-9);
}

// A force F along inertial axes at a point of them: where the root's attitude is uncertain, so are
// its direction and lever. A hinge at the root's origin, about z.
TEST(LiveWrenches, OfTheInertialFrameMakeEffortsUncertainByTheAttitude) {
  RobotBuilder builder(1);
  builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), Matrix3l::Identity(), Vector3l::Zero());
  for (const int link : {0, 1}) builder.removeInertia(link);
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.root_moves = true;
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].name = "push";
  scene.applied_wrenches[0].link = "link_1";
  scene.applied_wrenches[0].live = true;
  LiveWrenches wrenches(mechanism, scene, 0.1);
  MeasuredWrench measured;
  measured.stamp_ns = kStamp;
  measured.frame = MeasuredWrench::kInertial;
  measured.value.force << 30, -40, 20;
  measured.value.torque << 3, 5, -4;
  wrenches.push(0, measured);
  ASSERT_FALSE(wrenches.read(kStamp));
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  Motion motion(1);
  motion.root.position << 0.4, -0.7, 0.2;
  MotionCovariance covariance{{Eigen::Matrix3d::Zero()}};
  covariance.root.diagonal().head<3>() << 1e-8, 4e-8, 9e-8;
  const LoadLaw law = [&](const Motion& at, Load& load) { wrenches.getLoad(at, load); };
  deviations.computeMotion(motion, covariance, law, workspace);
  // The moment about the root's origin, of which the axis z turns away by (y, -x) per radian.
  const Eigen::Vector3d moment =
      measured.value.torque - motion.root.position.cross(measured.value.force);
  const double expected = std::hypot(1e-4 * moment.y(), 2e-4 * moment.x());
  ASSERT_GT(expected, 1e-3);
  EXPECT_NEAR(workspace.motion().effort[0], expected, 1e-3 * expected);
}

TEST(LiveWrenches, NamesAreChecked) {
  TwoArms arms;
  const auto messageOf = [&](const Scene& scene) -> std::string {
    try {
      InverseDynamics(*arms.mechanism, scene);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "accepted";
  };
  Scene scene = arms.live("link_3");
  EXPECT_EQ(messageOf(scene), "accepted");
  scene.applied_wrenches.push_back(scene.applied_wrenches[0]);
  EXPECT_EQ(messageOf(scene), "applied_wrenches[1].name: 'push' is given twice");
  scene.applied_wrenches[1].name.clear();
  EXPECT_EQ(messageOf(scene), "applied_wrenches[1]: a live wrench needs a name");
  scene.applied_wrenches[1].live = false;
  EXPECT_EQ(messageOf(scene), "accepted");
  scene.applied_wrenches[1].invert = true;
  EXPECT_EQ(messageOf(scene), "applied_wrenches[1]: invert: only a live wrench is inverted");
}

}  // namespace
}  // namespace virtual_work_dynamics
