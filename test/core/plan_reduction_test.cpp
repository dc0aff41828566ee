#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "named_results.h"
#include "newton_euler_oracle.h"
#include "plain_results.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Error of efforts up to 10 N m and positions up to 1 m after a few dozen roundings.
constexpr double kRounding = 1e-14;

// Results of the narrower request equal those of the wider one.
void expectSame(const Request& narrow, const NamedResults& results, const NamedResults& wider) {
  if (narrow.efforts) {
    EXPECT_EQ(results.effort(), wider.effort());
  }
  for (const std::string& name : narrow.child_axes) {
    expectSame(results.child(name), wider.child(name));
  }
  for (const std::string& name : narrow.root_axes) {
    expectSame(results.root(name), wider.root(name));
    if (narrow.poses) {
      EXPECT_EQ(results.pose(name).position, wider.pose(name).position);
      EXPECT_EQ(results.pose(name).orientation.coeffs(), wider.pose(name).orientation.coeffs());
    }
    if (narrow.twists) {
      EXPECT_EQ(results.twist(name).linear, wider.twist(name).linear);
      EXPECT_EQ(results.twist(name).angular, wider.twist(name).angular);
    }
  }
}

Request effortsOnly() {
  return Request();
}

Request without(Request request, bool efforts, bool child_axes, bool root_axes) {
  if (efforts) request.efforts = false;
  if (child_axes) request.child_axes.clear();
  if (root_axes) {
    request.root_axes.clear();
    request.poses = request.twists = false;
  }
  return request;
}

// Everything but the name is left out.
Request only(const std::string& child_axes, const std::string& root_axes, bool poses, bool twists) {
  Request request;
  request.efforts = false;
  if (!child_axes.empty()) request.child_axes = {child_axes};
  if (!root_axes.empty()) request.root_axes = {root_axes};
  request.poses = poses;
  request.twists = twists;
  return request;
}

std::vector<Request> narrowerRequests(const Request& all) {
  std::vector<Request> requests = {
      effortsOnly(), without(all, true, false, false), without(all, false, true, false),
      without(all, false, false, true), without(all, true, true, false)};
  Request reversed = all;
  std::reverse(reversed.child_axes.begin(), reversed.child_axes.end());
  std::rotate(reversed.root_axes.begin(), reversed.root_axes.begin() + 1, reversed.root_axes.end());
  requests.push_back(reversed);
  for (const std::string& name : all.root_axes) {
    requests.push_back(only(name, "", false, false));
    requests.push_back(only("", name, false, false));
    requests.push_back(only(name, name, true, true));
    requests.push_back(only("", name, true, false));
  }
  return requests;
}

Scene sceneOf(unsigned seed, int links) {
  Scene scene;
  scene.gravity = {0.3, -1.1, -9.81};
  scene.static_motion = seed % 4 == 0;
  if (seed % 3 == 0) {
    scene.applied_wrenches.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
      AppliedWrench& wrench = scene.applied_wrenches[i];
      wrench.link = "link_" + std::to_string(links - 1 - static_cast<int>(i));
      wrench.axes = i == 0 ? Axes::kLink : Axes::kRoot;
      wrench.force << 1, 2, 3;
      wrench.at << 0.3, 0.2, 0.1;
    }
  }
  return scene;
}

TEST(PlanReduction, NarrowerRequestsGiveTheSameNumbers) {
  for (unsigned seed = 1; seed <= 16; ++seed) {
    SCOPED_TRACE(seed);
    constexpr int kLinks = 14;
    RandomRobot random(seed, kLinks);
    const Mechanism mechanism = readUrdf(random.urdf());
    const Scene scene = sceneOf(seed, kLinks);
    const Motion motion = random.motion(mechanism);
    const Request all = requestAll(mechanism);
    for (const InstructionSet set : supportedInstructionSets()) {
      const NamedResults wider(mechanism, scene, all, motion, set);
      for (const Request& narrow : narrowerRequests(all)) {
        expectSame(narrow, NamedResults(mechanism, scene, narrow, motion, set), wider);
      }
    }
  }
}

// In its own axes the wrench of a turntable does not depend on its position; in root axes it does.
TEST(PlanReduction, KeepsAPositionThatOnlyTurnsAReaction) {
  const Mechanism mechanism = readUrdf(
      "<robot name='turntable'><link name='base'/><link name='table'><inertial>"
      "<origin xyz='0.5 0 0'/><mass value='2'/>"
      "<inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>"
      "<joint name='turn' type='continuous'><parent link='base'/><child link='table'/>"
      "<axis xyz='0 0 1'/></joint></robot>");
  Scene scene;
  scene.static_motion = true;
  Motion motion(1);
  motion.q[0] = 0.7;
  const Request request = only("", "turn", false, false);
  for (const InstructionSet set : supportedInstructionSets()) {
    const NamedResults results(mechanism, scene, request, motion, set);
    const Wrench& reaction = results.root("turn");
    const double weight = 2 * 9.81;
    EXPECT_LE((reaction.force - Eigen::Vector3d(0, 0, weight)).norm(), kRounding * weight);
    const Eigen::Vector3d torque(0.5 * std::sin(0.7) * weight, -0.5 * std::cos(0.7) * weight, 0);
    EXPECT_LE((reaction.torque - torque).norm(), kRounding * weight);
  }
}

TEST(PlanReduction, AStaticSceneIsTheFullPlanAtRest) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot random(seed, 15);
    const Mechanism mechanism = readUrdf(random.urdf());
    const Motion moving = random.motion(mechanism);
    Motion resting = moving;
    resting.qd.setZero();
    resting.qdd.setZero();
    Scene scene;
    scene.gravity = {0.3, -1.1, -9.81};
    const Request request = requestEveryJoint(mechanism);
    const NamedResults full(mechanism, scene, request, resting);
    scene.static_motion = true;
    expectSame(request, NamedResults(mechanism, scene, request, moving), full);
  }
}

// Nothing of a gravity of 1e-290 m/s^2 is left in a sum, but its terms are in the plan.
TEST(PlanReduction, NoGravityIsTheFullPlanWithNextToNone) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot random(seed, 15);
    const Mechanism mechanism = readUrdf(random.urdf());
    const Motion motion = random.motion(mechanism);
    const Request request = requestAll(mechanism);
    Scene scene;
    scene.gravity = {1e-290, -2e-290, 3e-290};
    const NamedResults full(mechanism, scene, request, motion);
    scene.gravity.setZero();
    const NamedResults reduced(mechanism, scene, request, motion);
    constexpr double kGone = 1e-280;  // a result that is zero except for this gravity
    const auto close = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return (a - b).cwiseAbs().maxCoeff() <= kGone;
    };
    EXPECT_TRUE(close(reduced.effort(), full.effort()));
    for (const std::string& name : request.root_axes) {
      EXPECT_TRUE(close(reduced.child(name).force, full.child(name).force));
      EXPECT_TRUE(close(reduced.child(name).torque, full.child(name).torque));
      EXPECT_TRUE(close(reduced.root(name).force, full.root(name).force));
      EXPECT_TRUE(close(reduced.root(name).torque, full.root(name).torque));
    }
  }
}

// Constants that are zero except for one entry, each in turn, are not left out as zero. The joints
// are z-aligned, so that the entries are those of the recursion.
TEST(PlanReduction, OneEntryIsNotNone) {
  for (int entry = 0; entry < 9; ++entry) {
    SCOPED_TRACE(entry);
    RobotBuilder builder(3);
    for (int i = 0; i < 4; ++i) {
      const Matrix3l R_PK = builder.rotation();
      Vector3l p_PoKo_P = Vector3l::Zero();
      if (entry < 3) p_PoKo_P[entry] = 0.3;
      const JointType type = i == 2 ? JointType::kPrismatic : JointType::kRevolute;
      const int body = builder.add(type, i, Vector3l::UnitZ(), R_PK, p_PoKo_P);
      Link& link = builder.link(body);
      link.p_KoCm_K.setZero();
      link.inertia_Cm_K = Vector3l(0.3, 0.4, 0.5).asDiagonal();
      if (entry >= 3 && entry < 6) link.p_KoCm_K[entry - 3] = 0.2;
      const int row = entry == 8 ? 1 : 0, column = entry == 6 ? 1 : 2;
      if (entry >= 6) link.inertia_Cm_K(row, column) = link.inertia_Cm_K(column, row) = 0.05;
    }
    const Mechanism mechanism = builder.build();
    const Motion motion = builder.motion();
    const NamedResults results(mechanism, Scene(), requestAll(mechanism), motion);
    const NewtonEulerOracle oracle(mechanism, Scene(), motion);
    for (int k = 0; k < 4; ++k) {
      const Wrench& wrench = results.child(mechanism.joints()[k].name);
      const auto expected = oracle.childReaction(k);
      EXPECT_LE((wrench.force.cast<long double>() - expected.force).norm(), 10 * kRounding);
      EXPECT_LE((wrench.torque.cast<long double>() - expected.torque).norm(), 10 * kRounding);
    }
  }
}

// link_2 and link_3, one after the other at the end of a branch, carry nothing; link_4 does.
RobotBuilder withMasslessBranch() {
  RobotBuilder builder = chainOf(3);
  builder.removeInertia(2);
  builder.removeInertia(3);
  builder.add(1);
  return builder;
}

TEST(PlanReduction, MasslessBranchesLeaveTheRestAlone) {
  RobotBuilder builder = withMasslessBranch();
  const Mechanism mechanism = builder.build();
  const Request request = requestAll(mechanism);
  const Motion motion = builder.motion();
  Scene scene;
  const NamedResults reduced(mechanism, scene, request, motion);
  // A wrench of nothing at its end, which may change, keeps the branch.
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].link = "link_3";
  const NamedResults full(mechanism, scene, request, motion);
  expectSame(request, reduced, full);
  EXPECT_LT(reduced.summary().multiplications, full.summary().multiplications);
  for (const char* name : {"joint_2", "joint_3"}) {
    expectSame(reduced.child(name), Wrench());
    expectSame(reduced.root(name), Wrench());
  }
  EXPECT_EQ(reduced.effort()[1], 0);
  EXPECT_EQ(reduced.effort()[2], 0);
  EXPECT_NE(reduced.effort()[0], 0);
  const NewtonEulerOracle oracle(mechanism, Scene(), motion);
  EXPECT_LE((reduced.pose("joint_3").position.cast<long double>() - oracle.origin(3)).norm(),
            kRounding);
}

TEST(PlanReduction, ZerosThatNobodyComputesAreWritten) {
  RobotBuilder builder = withMasslessBranch();
  const Mechanism mechanism = builder.build();
  const std::vector<Motion> motions = builder.motions(21);
  Request request = requestAll(mechanism);
  for (const bool poses : {true, false}) {
    request.poses = request.twists = poses;
    const InverseDynamics dynamics(mechanism, Scene(), request);
    for (const BlockLayout layout : {BlockLayout::kStructureOfArrays, BlockLayout::kRowMajor}) {
      for (const auto& sample :
           blockResults<float>(dynamics, motions, layout, 1, chosenInstructionSet())) {
        EXPECT_EQ(sample.effort[1], 0);
        EXPECT_EQ(sample.effort[2], 0);
        for (std::size_t i = 6; i < 18; ++i) {
          EXPECT_EQ(sample.child_axes[i], 0);
          EXPECT_EQ(sample.root_axes[i], 0);
        }
      }
    }
  }
}

// A wrench applied to a body without inertia is carried on, whatever its axes.
TEST(PlanReduction, AppliedWrenchesKeepMasslessBranches) {
  RobotBuilder builder = withMasslessBranch();
  const Mechanism mechanism = builder.build();
  const Motion motion = builder.motion();
  for (const Axes axes : {Axes::kLink, Axes::kRoot}) {
    Scene scene;
    scene.applied_wrenches.resize(1);
    AppliedWrench& wrench = scene.applied_wrenches[0];
    wrench.link = "link_3";
    wrench.axes = axes;
    wrench.at << 0.3, -0.2, 0.1;
    wrench.force << 5, -7, 11;
    wrench.torque << 1, 2, -4;
    const NewtonEulerOracle oracle(mechanism, scene, motion);
    const std::vector<long double> efforts = oracle.efforts();
    const NamedResults all(mechanism, scene, requestAll(mechanism), motion);
    const NamedResults narrow(mechanism, scene, effortsOnly(), motion);
    for (Eigen::Index i = 0; i < 4; ++i) {
      EXPECT_NEAR(all.effort()[i], static_cast<double>(efforts[static_cast<std::size_t>(i)]),
                  kRounding);
      EXPECT_EQ(narrow.effort()[i], all.effort()[i]);
    }
  }
}

// A tool without mass on a link without mass: nothing but its own wrench is needed, and its parent
// is not. What the sanitizers see is what this is for.
TEST(PlanReduction, AnAppliedWrenchOnAnIdleBranch) {
  RobotBuilder builder(5);
  builder.removeInertia(builder.add(0));
  for (int i = 0; i < 2; ++i) {
    builder.removeInertia(builder.add(JointType::kFixed, 1, Vector3l::Zero(), builder.rotation(),
                                      builder.vector(0.3)));
  }
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.applied_wrenches.resize(2);
  scene.applied_wrenches[0].link = "link_2";
  scene.applied_wrenches[0].force << 1, 2, 3;
  scene.applied_wrenches[1].link = "link_3";
  scene.applied_wrenches[1].torque << -4, 5, 6;
  Request request;
  request.efforts = false;
  request.child_axes = {"joint_2", "joint_3"};
  const NamedResults results(mechanism, scene, request, builder.motion());
  EXPECT_EQ(results.child("joint_2").force, Eigen::Vector3d(-1, -2, -3));
  EXPECT_EQ(results.child("joint_3").torque, Eigen::Vector3d(4, -5, -6));
  EXPECT_EQ(results.summary().bodies, 4u);
  EXPECT_EQ(results.summary().sines_and_cosines, 0u);
}

TEST(PlanReduction, AppliedWrenchesElsewhereDoNotMatter) {
  RobotBuilder builder = chainOf(3);
  builder.add(0);
  const Mechanism mechanism = builder.build();
  const Motion motion = builder.motion();
  const Request request = only("joint_4", "", false, false);
  Scene scene;
  const NamedResults without_wrench(mechanism, scene, request, motion);
  scene.applied_wrenches.resize(2);
  scene.applied_wrenches[0].link = "link_2";
  scene.applied_wrenches[1].link = "link_0";
  scene.applied_wrenches[1].axes = Axes::kRoot;
  for (AppliedWrench& wrench : scene.applied_wrenches) wrench.force << 1, 2, 3;
  const NamedResults with_wrench(mechanism, scene, request, motion);
  expectSame(request, with_wrench, without_wrench);
  EXPECT_EQ(with_wrench.summary().multiplications, without_wrench.summary().multiplications);
  const InverseDynamics dynamics(mechanism, scene, request);
  Workspace workspace = dynamics.makeWorkspace();
  Load load(scene);
  load.wrenches[0] = {{7, 8, 9}, {1, 2, 3}};
  EXPECT_NO_THROW(dynamics.compute(motion, load, workspace));
  expectSame(workspace.childAxes()[0], without_wrench.child("joint_4"));
}

}  // namespace
}  // namespace virtual_work_dynamics
