// Deviations where rates follow from fewer coordinates than positions do: what ties velocities
// alone leaves every position with an error of its own.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "deviation_sources.h"
#include "random_motions.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using deviation_sources::expectSpread;
using deviation_sources::kDraws;
using deviation_sources::Sources;

std::string tiedBody(const std::string& name) {
  return "<link name='" + name +
         "'><inertial><origin xyz='0.1 0.05 -0.02'/><mass value='1'/><inertia ixx='0.1' "
         "iyy='0.12' izz='0.15' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}

std::string tiedJoint(const std::string& type, const std::string& parent, const std::string& child,
                      const std::string& at, const std::string& axis) {
  return "<joint name='j_" + child + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + at + "'/><axis xyz='" + axis +
         "'/><limit effort='100' velocity='100' lower='-10' upper='10'/></joint>";
}

Mechanism tiedPendulums() {
  return readUrdf("<robot name='r'><link name='world'/>" + tiedBody("a") + tiedBody("b") +
                  tiedBody("c") + tiedJoint("continuous", "world", "a", "0 0 0", "0 1 0") +
                  tiedJoint("continuous", "world", "b", "0 1 0", "0 1 0") +
                  tiedJoint("continuous", "world", "c", "0 2 0", "0 1 0") + "</robot>");
}

// A platform on two wheels, of which each has its own position.
Mechanism wheeledPlatform() {
  return readUrdf("<robot name='r'><link name='world'/>" + tiedBody("x") + tiedBody("y") +
                  tiedBody("base") + tiedBody("left") + tiedBody("right") +
                  tiedJoint("prismatic", "world", "x", "0 0 0", "1 0 0") +
                  tiedJoint("prismatic", "x", "y", "0 0 0", "0 1 0") +
                  tiedJoint("continuous", "y", "base", "0 0 0", "0 0 1") +
                  tiedJoint("continuous", "base", "left", "0 0.2 0", "0 1 0") +
                  tiedJoint("continuous", "base", "right", "0 -0.2 0", "0 1 0") + "</robot>");
}

Scene tiedScene(const std::string& text) {
  return readScene(YAML::Load(text));
}

// Every deviation against the spread of results of motions whose positions are drawn, follow from
// each other by `tie`, and whose rates follow from those of the actuated joints.
void expectTiedSpread(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                      double size, const std::function<void(Motion&)>& tie) {
  const Request request = deviation_sources::everything(mechanism, scene);
  const ClosedLoopDynamics dynamics(mechanism, scene, request);
  ClosedLoopDynamics::Workspace workspace = dynamics.makeWorkspace();
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace computed = deviations.makeWorkspace();
  Sources sources(7);
  sources.ofCoordinates(motion.q.size(), size);
  const auto complete = [&](Motion& of) {
    tie(of);
    return dynamics.complete(of, dynamics.actuated(), workspace);
  };
  Motion mean = motion;
  ASSERT_TRUE(complete(mean));
  deviations.computeMotion(mean, sources.covariance, computed);
  Spread spread;
  for (int i = 0; i < kDraws; ++i) {
    Motion drawn = sources.motion(mechanism, mean);
    ASSERT_TRUE(complete(drawn));
    dynamics.compute(drawn, workspace);
    spread.add(numbersOf(workspace.results()));
  }
  expectSpread(numbersOf(computed.motion()), spread);
}

const char* const kTiedRates =
    "couplings: [{name: k, terms: [{name: j_a, factor: 1}, {name: j_b, factor: -1}], "
    "rate_only: true}]\n";

// The torque at `a` bears the weight of `b`, too, a sine of its position.
TEST(DeviationsOfRatesAlone, ThePositionThatFollowsNothingCounts) {
  const Mechanism mechanism = tiedPendulums();
  const Scene scene = tiedScene(std::string(kTiedRates) + "actuated: [j_a, j_c]\n");
  const Deviations deviations(mechanism, scene, {});
  EXPECT_EQ(deviations.independent(), (std::vector<bool>{true, true, true}));
  Deviations::Workspace workspace = deviations.makeWorkspace();
  MotionCovariance covariance;
  covariance.coordinates.assign(3, Eigen::Matrix3d::Zero());
  covariance.coordinates[1](0, 0) = 1e-4;
  Motion motion(3);
  motion.q << 0.3, 0.8, 0;
  deviations.computeMotion(motion, covariance, workspace);
  // The derivative of m g (0.1 cos q - 0.02 sin q), to the first order of the shift.
  const double slope = 9.81 * (0.1 * std::sin(0.8) + 0.02 * std::cos(0.8));
  EXPECT_NEAR(workspace.motion().effort[0], 1e-2 * slope, 1e-5);
  // By itself, the rate of `b` follows.
  covariance.coordinates[1] = Eigen::Vector3d(0, 1, 1).asDiagonal();
  deviations.computeMotion(motion, covariance, workspace);
  EXPECT_EQ(workspace.motion().effort[0], 0);
}

TEST(DeviationsOfRatesAlone, CouplingsMatchDrawnMotions) {
  Motion motion(3);
  motion.q << 0.3, 0.8, 1.6;
  motion.qd << 1.2, 0, 0;
  motion.qdd << -0.7, 0, 0;
  // Beside it a coupling of positions, whose `c` follows from `b`.
  expectTiedSpread(
      tiedPendulums(),
      tiedScene("couplings:\n- {name: k, terms: [{name: j_a, factor: 1}, "
                "{name: j_b, factor: -1}], rate_only: true}\n"
                "- {name: l, terms: [{name: j_b, factor: 2}, {name: j_c, factor: -1}]}\n"
                "actuated: [j_a]\n"),
      motion, 10, [](Motion& of) { of.q[2] = 2 * of.q[1]; });
}

TEST(DeviationsOfRatesAlone, WheelsMatchDrawnMotions) {
  Motion motion(5);
  motion.q << 0.3, 0.2, 0.5, 0.1, 0.2;
  motion.qd << 0, 0, 0, 9, 12;
  motion.qdd << 0, 0, 0, 3, -5;
  const std::string wheel =
      ", axis: [0, 1, 0], radius: 0.09, normal: false, plane: {link: world, point: [0, 0, -0.09]}}";
  expectTiedSpread(
      wheeledPlatform(),
      tiedScene("gravity: [1, 2, -9.81]\nrolling: [{name: l, link: left" + wheel +
                ", {name: r, link: right" + wheel + "]\nactuated: [j_left, j_right]\n"),
      motion, 3, [](Motion&) {});
}

}  // namespace
}  // namespace virtual_work_dynamics
