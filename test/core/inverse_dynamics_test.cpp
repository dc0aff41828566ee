#include "virtual_work_dynamics/inverse_dynamics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "newton_euler_oracle.h"
#include "pendulum_closed_form.h"
#include "result_differences.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
// Two evaluations in different order of one formula of a few hundred terms.
constexpr double kOracleTolerance = 500 * kEps;
// Closed forms of the paper, evaluated in double.
constexpr double kClosedForm = 1e-14;

#define EXPECT_CLOSE(value, expected, tolerance)                            \
  do {                                                                      \
    const double value_ = static_cast<double>(value);                       \
    const double expected_ = static_cast<double>(expected);                 \
    ASSERT_TRUE(std::isfinite(value_)) << #value;                           \
    EXPECT_NEAR(value_, expected_, (tolerance)) << #value " vs " #expected; \
  } while (false)

TEST(InverseDynamics, PendulumMatchesEquations57And58) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  const InverseDynamics dynamics(mechanism, pendulumScene());
  Workspace workspace = dynamics.makeWorkspace();
  for (int i = 0; i <= 60; ++i) {
    const Motion motion = pendulumMotion(0.1 * i);
    dynamics.compute(motion, workspace);
    const Eigen::Vector2d expected = equation57(motion, Pendulum());
    EXPECT_CLOSE(workspace.effort()[0], expected[0], kClosedForm * 10);
    EXPECT_CLOSE(workspace.effort()[1], expected[1], kClosedForm * 10);
    EXPECT_CLOSE(workspace.rootAxes()[0].force.x(), equation58(motion, Pendulum()),
                 kClosedForm * 20);
    EXPECT_CLOSE(workspace.rootAxes()[0].torque.z(), expected[0], kClosedForm * 10);
  }
}

// Compares every result of a plan with the oracle's, relative to the largest of its kind.
void expectOracle(const Mechanism& mechanism, const Scene& scene, const Motion& motion,
                  const Request& request) {
  const InverseDynamics dynamics(mechanism, scene, request);
  Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  const NewtonEulerOracle oracle(mechanism, scene, motion);

  long double largest = 1e-3L;
  for (int k = -1; k < static_cast<int>(mechanism.joints().size()); ++k) {
    const auto wrench = oracle.reaction(k);
    largest = std::max({largest, wrench.force.norm(), wrench.torque.norm()});
  }
  const double tolerance = kOracleTolerance * static_cast<double>(largest);
  if (request.efforts) {
    const std::vector<long double> efforts = oracle.efforts();
    for (std::size_t i = 0; i < efforts.size(); ++i) {
      EXPECT_CLOSE(workspace.effort()[i], efforts[i], tolerance);
    }
  }
  for (std::size_t i = 0; i < request.child_axes.size(); ++i) {
    const int joint = mechanism.jointIndex(request.child_axes[i]);
    const auto expected = oracle.childReaction(joint);
    for (int j = 0; j < 3; ++j) {
      EXPECT_CLOSE(workspace.childAxes()[i].force[j], expected.force[j], tolerance);
      EXPECT_CLOSE(workspace.childAxes()[i].torque[j], expected.torque[j], tolerance);
    }
  }
  for (std::size_t i = 0; i < request.root_axes.size(); ++i) {
    const int joint = mechanism.jointIndex(request.root_axes[i]);
    const auto expected = oracle.reaction(joint);
    for (int j = 0; j < 3; ++j) {
      EXPECT_CLOSE(workspace.rootAxes()[i].force[j], expected.force[j], tolerance);
      EXPECT_CLOSE(workspace.rootAxes()[i].torque[j], expected.torque[j], tolerance);
    }
  }
}

Request everyReaction(const Mechanism& mechanism, bool fixed_too) {
  Request request;
  if (fixed_too) request.child_axes.push_back(kGround);
  for (const Joint& joint : mechanism.joints()) {
    if (fixed_too || joint.type != JointType::kFixed) request.child_axes.push_back(joint.name);
  }
  request.root_axes = request.child_axes;
  return request;
}

TEST(InverseDynamics, RandomTreesMatchNewtonEuler) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot robot(seed, 2 + static_cast<int>(seed % 19));
    const Mechanism mechanism = readUrdf(robot.urdf());
    Scene scene;
    scene.gravity = {0.3, -1.1, -9.81};
    const Motion motion = robot.motion(mechanism);
    expectOracle(mechanism, scene, motion, everyReaction(mechanism, false));
    expectOracle(mechanism, scene, motion, everyReaction(mechanism, true));
  }
}

TEST(InverseDynamics, StaticSceneIgnoresVelocityAndAcceleration) {
  RandomRobot robot(7, 12);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene;
  scene.static_motion = true;
  expectOracle(mechanism, scene, robot.motion(mechanism), everyReaction(mechanism, true));
}

Scene sceneWithAppliedWrenches(RandomRobot& robot, int links) {
  Scene scene;
  for (int i = 0; i < 6; ++i) {
    AppliedWrench wrench;
    wrench.link = "link_" + std::to_string(i == 0 ? 0 : robot.pick(links));
    wrench.axes = i % 2 ? Axes::kRoot : Axes::kLink;
    for (auto* vector : {&wrench.at, &wrench.force, &wrench.torque}) {
      *vector << robot.uniform(-2, 2), robot.uniform(-2, 2), robot.uniform(-2, 2);
    }
    scene.applied_wrenches.push_back(wrench);
  }
  return scene;
}

TEST(InverseDynamics, AppliedWrenchesMatchNewtonEuler) {
  for (unsigned seed = 100; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot robot(seed, 10);
    const Mechanism mechanism = readUrdf(robot.urdf());
    const Scene scene = sceneWithAppliedWrenches(robot, 10);
    const Motion motion = robot.motion(mechanism);
    expectOracle(mechanism, scene, motion, everyReaction(mechanism, true));
    Request efforts_only;
    expectOracle(mechanism, scene, motion, efforts_only);
  }
}

TEST(InverseDynamics, ALoadReplacesTheAppliedWrenchesOfOneSample) {
  RandomRobot robot(101, 10);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene = sceneWithAppliedWrenches(robot, 10);
  const Motion motion = robot.motion(mechanism);
  const InverseDynamics dynamics(mechanism, scene);
  Workspace own = dynamics.makeWorkspace(), workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, own);
  for (AppliedWrench& applied : scene.applied_wrenches) {
    applied.force *= -3;
    applied.torque *= 0.5;
  }
  const InverseDynamics compiled(mechanism, scene);
  Workspace expected = compiled.makeWorkspace();
  compiled.compute(motion, expected);
  Load load(scene);
  for (int i = 0; i < 2; ++i) {
    dynamics.compute(motion, load, workspace);
    EXPECT_EQ(differences(workspace.results(), expected.results()), "");
    EXPECT_NE(differences(workspace.results(), own.results()), "");
    dynamics.compute(motion, workspace);
    EXPECT_EQ(differences(workspace.results(), own.results()), "");
  }
  load.wrenches.pop_back();
  EXPECT_THROW(dynamics.compute(motion, load, workspace), SceneError);
  EXPECT_THROW(dynamics.compute(motion, Load(), workspace), SceneError);
  load.wrenches.resize(scene.applied_wrenches.size() + 1);
  EXPECT_THROW(dynamics.compute(motion, load, workspace), SceneError);
}

TEST(InverseDynamics, PosesAndTwistsMatchNewtonEuler) {
  for (unsigned seed = 200; seed < 210; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot robot(seed, 10);
    const Mechanism mechanism = readUrdf(robot.urdf());
    Request request = everyReaction(mechanism, true);
    request.poses = request.twists = true;
    const Scene scene;
    const Motion motion = robot.motion(mechanism);
    const InverseDynamics dynamics(mechanism, scene, request);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, workspace);
    const NewtonEulerOracle oracle(mechanism, scene, motion);
    for (std::size_t i = 0; i < request.root_axes.size(); ++i) {
      const int link = mechanism.jointIndex(request.root_axes[i]) + 1;
      const Matrix3l R = workspace.poses()[i].orientation.toRotationMatrix().cast<long double>();
      EXPECT_LE((R - oracle.orientation(link)).norm(), 100 * kEps);
      EXPECT_LE((workspace.poses()[i].position.cast<long double>() - oracle.origin(link)).norm(),
                200 * kEps);
      EXPECT_LE(
          (workspace.twists()[i].linear.cast<long double>() - oracle.originVelocity(link)).norm(),
          2000 * kEps);
      EXPECT_LE(
          (workspace.twists()[i].angular.cast<long double>() - oracle.angularVelocity(link)).norm(),
          500 * kEps);
    }
  }
}

// What is left out must not change what remains: same bits.
TEST(InverseDynamics, NarrowRequestsGiveTheSameBits) {
  RandomRobot robot(42, 15);
  const Mechanism mechanism = readUrdf(robot.urdf());
  const Scene scene;
  const Motion motion = robot.motion(mechanism);
  const InverseDynamics full(mechanism, scene);
  Workspace full_results = full.makeWorkspace();
  full.compute(motion, full_results);
  for (std::size_t i = 0; i < full.request().child_axes.size(); ++i) {
    Request one;
    one.efforts = false;
    one.child_axes = {full.request().child_axes[i]};
    const InverseDynamics narrow(mechanism, scene, one);
    Workspace results = narrow.makeWorkspace();
    narrow.compute(motion, results);
    EXPECT_EQ(results.effort().size(), 0);
    ASSERT_EQ(results.childAxes().size(), 1u);
    EXPECT_EQ(results.childAxes()[0].force, full_results.childAxes()[i].force);
    EXPECT_EQ(results.childAxes()[0].torque, full_results.childAxes()[i].torque);
  }
  const InverseDynamics efforts(mechanism, scene, Request());
  Workspace results = efforts.makeWorkspace();
  efforts.compute(motion, results);
  EXPECT_EQ(results.effort(), full_results.effort());
}

TEST(InverseDynamics, ActiveComponentIsDroppedOnRequest) {
  RandomRobot robot(11, 12);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene;
  const Motion motion = robot.motion(mechanism);
  const InverseDynamics with(mechanism, scene);
  scene.include_active = false;
  const InverseDynamics without(mechanism, scene);
  Workspace a = with.makeWorkspace(), b = without.makeWorkspace();
  with.compute(motion, a);
  without.compute(motion, b);
  EXPECT_EQ(a.effort(), b.effort());
  for (std::size_t i = 0; i < a.childAxes().size(); ++i) {
    const Joint& joint = mechanism.joints()[mechanism.jointIndex(with.request().child_axes[i])];
    const Eigen::Vector3d axis = joint.axis_K.cast<double>();
    const bool slides = joint.type == JointType::kPrismatic;
    const Eigen::Vector3d& full = slides ? a.childAxes()[i].force : a.childAxes()[i].torque;
    const Eigen::Vector3d& reduced = slides ? b.childAxes()[i].force : b.childAxes()[i].torque;
    const Eigen::Vector3d& full_rest = slides ? a.childAxes()[i].torque : a.childAxes()[i].force;
    const Eigen::Vector3d& rest = slides ? b.childAxes()[i].torque : b.childAxes()[i].force;
    EXPECT_EQ(full_rest, rest);
    EXPECT_LE((full - axis * axis.dot(full) - reduced).norm(), 20 * kEps * full.norm());
    EXPECT_GT(std::abs(axis.dot(full)), 1e-6);
  }
}

TEST(InverseDynamics, WrongSizesAndWorkspacesAreRefused) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  const InverseDynamics dynamics(mechanism, pendulumScene());
  Workspace workspace = dynamics.makeWorkspace();
  Motion motion(2);
  for (auto* vector : {&motion.q, &motion.qd, &motion.qdd}) {
    vector->resize(3);
    EXPECT_THROW(dynamics.compute(motion, workspace), MotionError);
    vector->setZero(2);
  }
  const InverseDynamics other(mechanism, pendulumScene());
  EXPECT_THROW(other.compute(motion, workspace), MotionError);
  EXPECT_NO_THROW(dynamics.compute(motion, workspace));
}

TEST(InverseDynamics, UnknownNamesAreRefusedByName) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  Request request;
  request.root_axes = {"elbow"};
  try {
    const InverseDynamics dynamics(mechanism, Scene(), request);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("'elbow'"), std::string::npos);
  }
  Scene scene;
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].link = "hand";
  EXPECT_THROW(InverseDynamics(mechanism, scene), SceneError);
}

TEST(InverseDynamics, HugeInputsAreReportedAsNotFinite) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  const InverseDynamics dynamics(mechanism, pendulumScene());
  Workspace workspace = dynamics.makeWorkspace();
  Motion motion(2);
  motion.qd << 1e100, 1e9;
  dynamics.compute(motion, workspace);
  EXPECT_TRUE(workspace.finite());
  motion.qd << 1e200, 1e200;
  dynamics.compute(motion, workspace);
  EXPECT_FALSE(workspace.finite());
  motion.qd << 1, 1;
  dynamics.compute(motion, workspace);  // nothing lingers
  EXPECT_TRUE(workspace.finite());
}

}  // namespace
}  // namespace virtual_work_dynamics
