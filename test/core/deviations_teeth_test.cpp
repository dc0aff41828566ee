// Deviations of reactions that teeth make: what presses wheels apart has the amount of what the
// teeth bear, so that reactions are linear on either flank alone. Against closed forms.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kFall = 9.81, kFlank = 0.5;
constexpr double kSmallWheel = 0.01;                  // mass of the small wheel
constexpr double kLoadsTorque = kFall * (0.3 - 0.1);  // of the loads about the large wheel's axis
constexpr double kLoadsInertia = 0.09 + 0.01 + 2e-3;  // about the same
constexpr double kLargeWheel = 0.2;

// A wheel `a` of 0.1 m drives `b` of 0.2 m, which lies above it at 45 degrees and carries two
// loads.
Mechanism gearWheels() {
  const std::string inertia =
      "<inertia ixx='1e-3' iyy='1e-3' izz='1e-3' ixy='0' ixz='0' iyz='0'/></inertial></link>";
  return readUrdf(
      "<robot name='g'><link name='world'/><link name='a'><inertial><mass value='0.01'/>" +
      inertia + "<link name='b'><inertial><origin xyz='0.3 0 0'/><mass value='1'/>" + inertia +
      "<link name='c'><inertial><origin xyz='-0.1 0 0'/><mass value='1'/>" + inertia +
      "<link name='d'><inertial><mass value='1'/>" + inertia +
      "<joint name='j_a' type='continuous'><parent link='world'/><child link='a'/>"
      "<axis xyz='0 1 0'/></joint><joint name='j_b' type='continuous'><parent link='world'/>"
      "<child link='b'/><origin xyz='0.21213203435596426 0 0.21213203435596426'/>"
      "<axis xyz='0 1 0'/></joint>"
      "<joint name='j_c' type='fixed'><parent link='b'/><child link='c'/></joint>"
      "<joint name='j_d' type='continuous'><parent link='world'/><child "
      "link='d'/></joint></robot>");
}

Scene gearedScene(const std::string& more) {
  return readScene(YAML::Load(
      "gravity: [0, 0, -9.81]\n"
      "closures: [{name: teeth, type: gear, parent: {link: a, rpy: [-1.5707963267948966, 0, 0]}, "
      "child: {link: b, rpy: [-1.5707963267948966, 0, 0]}, radii: [0.1, 0.2], "
      "pressure_angle: 0.5}]\nactuated: [j_a, j_d]\nreactions: all\n" +
      more));
}

struct TeethDeviations {
  explicit TeethDeviations(const Scene& of)
      : scene(of), mechanism(gearWheels()), deviations(mechanism, scene, request()) {}
  Request request() const {
    Request wanted;
    wanted.root_axes = {"j_a", "j_b", "teeth", "j_d", kGround};
    return wanted;
  }
  static MotionCovariance exact() {
    MotionCovariance covariance;
    covariance.coordinates.assign(3, Eigen::Matrix3d::Zero());
    return covariance;
  }
  Scene scene;
  Mechanism mechanism;
  Deviations deviations;
  Deviations::Workspace workspace = deviations.makeWorkspace();
};

// How much of a change of the tooth force is a change of the vertical force at `a`.
double verticalShareOfTeeth(bool reversed) {
  return std::sqrt(0.5) * (1 + (reversed ? 1 : -1) * std::tan(kFlank));
}

TEST(DeviationsOfTeeth, MassesOnOneFlank) {
  TeethDeviations teeth(gearedScene("tolerances: {mass: 0.1}\n"));
  teeth.deviations.computeDescription(Motion(3), teeth.workspace);
  const StandardDeviations& found = teeth.workspace.description();
  const double by_loads =
      0.1 * kFall * std::hypot(0.3, 0.1) / kLargeWheel * verticalShareOfTeeth(false);
  const double expected = std::hypot(by_loads, 0.1 * kFall * kSmallWheel);
  EXPECT_NEAR(expected, 0.4977, 1e-4);
  EXPECT_NEAR(found.root_axes[0].force.z(), expected, 1e-9);
  EXPECT_NEAR(found.effort[0], 0.1 * kFall * std::hypot(0.3, 0.1) / 2, 1e-9);
}

// Just beside where the tooth force vanishes, on either side.
TEST(DeviationsOfTeeth, AccelerationsOnEitherFlank) {
  TeethDeviations teeth(gearedScene(""));
  MotionCovariance covariance = TeethDeviations::exact();
  covariance.coordinates[0](2, 2) = 1e-4;
  for (const bool reversed : {false, true}) {
    SCOPED_TRACE(reversed);
    Motion motion(3);
    motion.qdd[1] = kLoadsTorque / kLoadsInertia + (reversed ? 0.1 : -0.1);
    motion.qdd[0] = -2 * motion.qdd[1];
    teeth.deviations.computeMotion(motion, covariance, teeth.workspace);
    const double force = 1e-2 / 2 * kLoadsInertia / kLargeWheel;
    EXPECT_NEAR(teeth.workspace.motion().root_axes[0].force.z(),
                force * verticalShareOfTeeth(reversed), 1e-9);
  }
}

TEST(DeviationsOfTeeth, WrenchesOnEitherFlank) {
  for (const bool reversed : {false, true}) {
    SCOPED_TRACE(reversed);
    Scene scene = gearedScene("");
    AppliedWrench wrench;
    wrench.link = "b";
    wrench.torque.y() = -kLoadsTorque + (reversed ? -0.1 : 0.1);
    wrench.deviation = WrenchDeviation{0, 1e-3};
    scene.applied_wrenches = {wrench};
    TeethDeviations teeth(scene);
    teeth.deviations.computeMotion(Motion(3), TeethDeviations::exact(), teeth.workspace);
    EXPECT_NEAR(teeth.workspace.motion().root_axes[0].force.z(),
                1e-3 / kLargeWheel * verticalShareOfTeeth(reversed), 1e-9);
  }
}

// Which flank bears is not known to the description's share where live wrenches act.
TEST(DeviationsOfTeeth, LiveWrenchesLeaveWhatTeethReachUnknown) {
  TeethDeviations teeth(
      gearedScene("tolerances: {mass: 0.1}\napplied_wrenches: [{name: f, link: b, live: true}]\n"));
  teeth.deviations.computeDescription(Motion(3), teeth.workspace);
  const StandardDeviations& found = teeth.workspace.description();
  EXPECT_TRUE(found.effort.allFinite());
  for (std::size_t i = 0; i < found.root_axes.size(); ++i) {
    EXPECT_EQ(std::isnan(found.root_axes[i].force.z()), i < 3) << i;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
