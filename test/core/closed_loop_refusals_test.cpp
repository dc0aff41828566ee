#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "four_bar.h"
#include "slider_crank.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

using Change = std::function<void(Scene&)>;

// One line that holds `text`.
template <typename Throws>
void expectError(Throws&& throws, const std::string& text) {
  try {
    throws();
    ADD_FAILURE() << "nothing thrown: " << text;
  } catch (const SceneError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find(text), std::string::npos) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
}

// A slider-crank with a fixed and a mimic joint beside it, valid except for `change`.
void expectRefusal(const Change& change, const std::string& text) {
  RobotBuilder builder(1);
  const SliderCrank slider_crank;
  Scene scene = slider_crank.scene("joint_1");
  const Matrix3l R = Matrix3l::Identity();
  const Vector3l z = Vector3l::UnitZ(), zero = Vector3l::Zero();
  builder.add(JointType::kContinuous, 0, z, R, zero);
  builder.add(JointType::kContinuous, 1, z, R, Vector3l(SliderCrank::kCrank, 0, 0));
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), R, zero);
  builder.add(JointType::kContinuous, 0, z, R, zero);
  builder.mimicFirst(2, 0);
  builder.add(JointType::kFixed, 0, z, R, zero);
  const Mechanism mechanism = builder.build();
  EXPECT_NO_THROW(ClosedLoopResults(mechanism, scene));
  change(scene);
  expectError([&]() { ClosedLoopResults(mechanism, scene); }, text);
}

Closure& pinOf(Scene& scene) {
  return scene.closures[0];
}

TEST(ClosedLoopRefusals, Closures) {
  expectRefusal([](Scene& scene) { pinOf(scene).parent.link = "link_9"; },
                "closures: 'pin': parent.link: no link 'link_9'; known are 'link_0', ");
  expectRefusal([](Scene& scene) { pinOf(scene).child.link = "link_2"; },
                "closures: 'pin': both frames are on link 'link_2'");
  expectRefusal(
      [](Scene& scene) {
        pinOf(scene).parent.link = "link_0";
        pinOf(scene).child.link = "link_5";
      },
      "closures: 'pin': no joint moves 'link_5' relative to 'link_0'");
  expectRefusal([](Scene& scene) { pinOf(scene).name = "joint_2"; },
                "closures: 'joint_2': a joint has the same name");
  expectRefusal([](Scene& scene) { pinOf(scene).name = "ground"; },
                "closures: 'ground': that name is reserved");
  expectRefusal([](Scene& scene) { pinOf(scene).name = ""; }, "closures: a closure has no name");
  expectRefusal([](Scene& scene) { scene.closures.push_back(pinOf(scene)); },
                "closures: 'pin' is given twice");
  expectRefusal([](Scene& scene) { pinOf(scene).length = 1; },
                "closures: 'pin': only a closure of type distance has a length");
  expectRefusal(
      [](Scene& scene) {
        pinOf(scene).type = ClosureType::kDistance;
        pinOf(scene).length = -0.5;
      },
      "closures: 'pin': length = -0.5 is not a positive number");
  expectRefusal(
      [](Scene& scene) { pinOf(scene).child.xyz.x() = std::numeric_limits<double>::infinity(); },
      "closures: 'pin': the frame on 'link_3' is not finite");
}

TEST(ClosedLoopRefusals, Springs) {
  PointSpring spring;
  spring.name = "s";
  spring.link_a = "link_0";
  spring.link_b = "link_3";
  spring.stiffness = 10;
  const auto refused = [&](const std::function<void(PointSpring&)>& change,
                           const std::string& text) {
    expectRefusal(
        [&](Scene& scene) {
          scene.springs = {spring};
          change(scene.springs[0]);
        },
        text);
  };
  refused([](PointSpring& s) { s.link_b = "link_9"; },
          "springs: 's': link_b: no link 'link_9'; known are 'link_0', ");
  refused([](PointSpring& s) { s.link_b = "link_0"; },
          "springs: 's': both ends are on link 'link_0'");
  refused([](PointSpring& s) { s.stiffness = 0; },
          "springs: 's': it has neither stiffness nor damping");
  refused([](PointSpring& s) { s.stiffness = -1; },
          "springs: 's': stiffness = -1 is neither zero nor a positive number");
  refused([](PointSpring& s) { s.damping = -2; },
          "springs: 's': damping = -2 is neither zero nor a positive number");
  refused([](PointSpring& s) { s.rest_length = -1; },
          "springs: 's': rest_length = -1 is neither zero nor a positive number");
  expectRefusal(
      [&](Scene& scene) {
        scene.springs = {spring, spring};
      },
      "springs: 's' is given twice");
}

TEST(ClosedLoopRefusals, ActuatedJoints) {
  const auto refused = [](const std::vector<std::string>& names, const std::string& text) {
    expectRefusal([&](Scene& scene) { scene.actuated = names; }, text);
  };
  refused({"joint_1", "jiont_3"},
          "actuated[1]: no joint or closure 'jiont_3'; did you mean 'joint_3'?");
  refused({"joint_9"}, "actuated[0]: no joint or closure 'joint_9'; known are 'joint_1', ");
  refused({"joint_5"}, "actuated: 'joint_5' is a fixed joint");
  refused({"joint_4"}, "actuated: 'joint_4' mimics another joint");
  refused({"joint_1", "joint_1"}, "actuated: 'joint_1' is given twice");
  expectRefusal(
      [](Scene& scene) {
        pinOf(scene).type = ClosureType::kSpherical;
        scene.actuated = std::vector<std::string>{"pin"};
      },
      "actuated: closure 'pin' is neither revolute nor prismatic");
  refused({},
          "actuated: too few for the degrees of freedom: nothing holds the motion of 'joint_1', "
          "'joint_2', 'joint_3' (free_motion: true reports what that motion demands)");
}

// Only what moves freely is named: an arm that is in no loop, and that in a branch of a loop.
TEST(ClosedLoopRefusals, FreeMotionIsNamed) {
  const SliderCrank with_arm(0, true);
  expectError([&]() { ClosedLoopResults(with_arm.mechanism(), with_arm.scene("joint_1")); },
              "nothing holds the motion of 'joint_4'");
}

TEST(ClosedLoopRefusals, Assembly) {
  expectRefusal(
      [](Scene& scene) {
        scene.assembly.push_back({"joint_1", 0});
      },
      "assembly: 'joint_1' is given twice");
  expectRefusal(
      [](Scene& scene) {
        scene.assembly = {{"joint_4", 0}};
      },
      "assembly: 'joint_4' mimics another joint");
  expectRefusal(
      [](Scene& scene) {
        scene.assembly = {{"pin", 0}};
      },
      "assembly[0].name: no joint 'pin'");
  // Half a metre beyond the stretched linkage.
  expectRefusal(
      [](Scene& scene) {
        scene.actuated = std::vector<std::string>{"joint_3"};
        scene.assembly[2].value = SliderCrank::kCrank + SliderCrank::kRod + 0.5;
      },
      "closures: 'pin' cannot be assembled from the given start: it stays open by 0.5");
  expectRefusal(
      [](Scene& scene) {
        pinOf(scene).type = ClosureType::kDistance;
        scene.assembly[2].value = SliderCrank::motion(0.7, 0, 0).q[2];
      },
      "closures: 'pin': its ends coincide in the assembly");
  // A weld that fits with the slider turned over, which no joint can do.
  expectRefusal(
      [](Scene& scene) {
        pinOf(scene).type = ClosureType::kFixed;
        pinOf(scene).child.rpy << M_PI, 0, 0.3;
        scene.assembly = {{"joint_1", -0.3}, {"joint_2", 0.6}, {"joint_3", 1.6}};
        scene.actuated = std::vector<std::string>{};
      },
      "closures: 'pin' is assembled the wrong way round: its frames are half a turn apart");
}

TEST(ClosedLoopRefusals, Redundancy) {
  const auto refused = [](const std::function<void(Redundancy&)>& change, const std::string& text) {
    expectRefusal([&](Scene& scene) { change(scene.redundancy); }, text);
  };
  refused([](Redundancy& r) { r.length = 0; }, "redundancy: length = 0 is not a positive number");
  refused([](Redundancy& r) { r.rank_tolerance = -1; },
          "redundancy: rank_tolerance = -1 is not a positive number");
  refused([](Redundancy& r) { r.rank_tolerance = 1; },
          "redundancy: rank_tolerance = 1 is not less than 1");
  refused([](Redundancy& r) { r.zero_at = {"joint_1"}; },
          "redundancy.zero_at[0]: no closure 'joint_1'; known are 'pin'");
  refused(
      [](Redundancy& r) {
        r.zero_at = {"pin", "pin"};
      },
      "redundancy: zero_at: 'pin' is given twice");
  refused(
      [](Redundancy& r) {
        r.stiffness = {{"pin", 0}};
      },
      "redundancy: stiffness: 'pin' = 0 is not a positive number");
  refused(
      [](Redundancy& r) {
        r.stiffness = {{"x", 1}};
      },
      "redundancy.stiffness[0].name: no joint or closure 'x'; known are ");
  refused(
      [](Redundancy& r) {
        r.stiffness = {{"joint_5", 1}};
      },
      "redundancy: stiffness: 'joint_5' is a fixed joint");
  refused(
      [](Redundancy& r) {
        r.effort_weights = {{"joint_1", -2}};
      },
      "redundancy: effort_weights: 'joint_1' = -2 is not a positive number");
  refused(
      [](Redundancy& r) {
        r.effort_weights = {{"joint_2", 2}};
      },
      "redundancy: effort_weights: 'joint_2' is not actuated");
}

TEST(ClosedLoopRefusals, Requests) {
  const SliderCrank slider_crank;
  const Scene scene = slider_crank.scene("joint_1");
  Request request;
  request.child_axes = {"pin", "pin"};
  const auto make = [&]() { ClosedLoops(slider_crank.mechanism(), scene, request); };
  expectError(make, "reactions[1]: 'pin' is named twice");
  request.child_axes = {"joint_9"};
  expectError(make, "reactions[0]: no joint or closure 'joint_9'");
}

TEST(ClosedLoopRefusals, MotionOfAnotherMechanism) {
  const SliderCrank slider_crank;
  ClosedLoops dynamics(slider_crank.mechanism(), slider_crank.scene("joint_1"));
  Motion motion(2);
  EXPECT_THROW(dynamics.compute(motion), MotionError);
  EXPECT_THROW(dynamics.complete(motion), MotionError);
  motion = Motion(3);
  EXPECT_THROW(dynamics.complete(motion, {true}), MotionError);
  Load load;
  load.wrenches.resize(1);
  EXPECT_THROW(dynamics.compute(motion, load), SceneError);
}

TEST(ClosedLoopRefusals, WorkspaceOfAnother) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  const Scene scene = slider_crank.scene("joint_1");
  const ClosedLoopDynamics one(mechanism, scene, Request()), other(mechanism, scene, Request());
  ClosedLoopDynamics::Workspace of_one = one.makeWorkspace();
  Motion motion = SliderCrank::motion(0.7, 2, 1);
  EXPECT_THROW(other.compute(motion, of_one), MotionError);
  EXPECT_THROW(other.compute(motion, Load(), of_one), MotionError);
  EXPECT_THROW(other.complete(motion, of_one), MotionError);
  EXPECT_THROW(other.completeFromCloseBy(motion, of_one), MotionError);
  EXPECT_THROW(other.complete(motion, {true, false, false}, of_one), MotionError);
  EXPECT_NO_THROW(one.compute(motion, of_one));
}

// Computations for open chains refuse closures, as their results would be wrong without them.
TEST(ClosedLoopRefusals, WhatComputesOpenChains) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  const auto refused = [&](const Scene& scene, const std::string& text) {
    EXPECT_TRUE(needsClosedLoops(scene));
    expectError([&]() { InverseDynamics(mechanism, scene); }, text);
    expectError([&]() { LagrangeDynamics<double>(mechanism, scene, Request()); }, text);
    expectError([&]() { ErrorBound(mechanism, scene); }, text);
    expectError([&]() { Certifier(mechanism, scene); }, text);
  };
  Scene scene = slider_crank.scene("joint_1");
  refused(scene, "closures: 'pin': an open chain has no closures");
  scene.closures.clear();
  refused(scene, "actuated: every joint of an open chain carries effort");
  PointSpring spring;
  spring.name = "s";
  scene.springs = {spring};
  refused(scene, "springs: 's': an open chain has no springs");
  EXPECT_FALSE(needsClosedLoops(Scene()));
}

TEST(RequestedReactions, ClosuresStandBehindJoints) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  Scene scene = slider_crank.scene("joint_1");
  scene.closures.push_back(scene.closures[0]);
  scene.closures[1].name = "another";
  using Names = std::vector<std::string>;
  EXPECT_EQ(requestedReactions(mechanism, scene),
            (Names{"joint_1", "joint_2", "joint_3", "pin", "another"}));
  scene.reactions = ReactionSelection::kNamed;
  scene.reaction_names = {"another", "joint_2", "ground"};
  EXPECT_EQ(requestedReactions(mechanism, scene), (Names{"ground", "joint_2", "another"}));
  scene.reaction_names = {"nobody"};
  expectError([&]() { requestedReactions(mechanism, scene); },
              "reactions[0]: no joint or closure 'nobody'");
}

}  // namespace
}  // namespace virtual_work_dynamics
