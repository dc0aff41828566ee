#include "dynamics/model_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "loop_examples.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms in another order of sums.
constexpr double kClosedForm = 1e-12;

std::string link(const std::string& name, double mass, const std::string& centre) {
  return "<link name='" + name + "'><inertial><origin xyz='" + centre + "'/><mass value='" +
         std::to_string(mass) +
         "'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& origin, const std::string& axis,
                  const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + origin + "'/><axis xyz='" + axis +
         "'/>" + more + "</joint>";
}

Mechanism robot(const std::string& body) {
  return readUrdf("<robot name='r'>" + body + "</robot>");
}

Scene scene(const std::string& yaml) {
  return readScene(YAML::Load(yaml));
}

ModelView viewOf(const Mechanism& mechanism, const Scene& asked) {
  return modelView(mechanism, asked, requestedReactions(mechanism, asked));
}

// A heavy trunk with one leg, whose shank sticks out along x: 0.25 m, 0.8 kg.
Mechanism leggedRobot() {
  return robot(link("trunk", 80, "0 0 0") + link("thigh", 2.5, "0 0 -0.15") +
               link("shank", 0.8, "0.125 0 0") +
               joint("hip", "continuous", "trunk", "thigh", "0.3 0.2 0", "1 0 0") +
               joint("knee", "continuous", "thigh", "shank", "0 0 -0.3", "0 1 0"));
}

Mechanism pendulum(const std::string& axis = "0 0 1", double mass = 2) {
  return robot("<link name='base'/>" + link("bob", mass, "0.5 0 0") +
               joint("pin", "continuous", "base", "bob", "0 0 0", axis));
}

TEST(ModelView, ArrowsAreScaledByTheReactionsThatAreAskedFor) {
  const Mechanism mechanism = leggedRobot();
  const ModelView knee = viewOf(mechanism, scene("{reactions: [knee]}"));
  const double force = 0.8 * 9.81, torque = force * 0.125;
  EXPECT_NEAR(knee.force_scale * force, ModelView::kArrow * knee.size, kClosedForm);
  EXPECT_NEAR(knee.torque_scale * std::max(torque, 0.1 * force * knee.size),
              ModelView::kArrow * knee.size, kClosedForm);
  const ModelView both = viewOf(mechanism, scene("{reactions: all}"));
  EXPECT_NEAR(both.force_scale * 3.3 * 9.81, ModelView::kArrow * both.size, kClosedForm);
  const ModelView ground = viewOf(mechanism, scene("{reactions: [ground]}"));
  EXPECT_NEAR(ground.force_scale * 83.3 * 9.81, ModelView::kArrow * ground.size, kClosedForm);
}

TEST(ModelView, MomentsHaveAScaleOfTheirOwn) {
  const ModelView view = viewOf(pendulum("0 1 0"), scene("{}"));
  // At zero the pendulum sticks out: 19.62 N at an arm of 0.5 m.
  EXPECT_NEAR(view.force_scale * 19.62, ModelView::kArrow * view.size, kClosedForm);
  EXPECT_NEAR(view.torque_scale * 9.81, ModelView::kArrow * view.size, kClosedForm);
  EXPECT_EQ(view.legend_force, 10);
  EXPECT_EQ(view.legend_torque, 5);
}

TEST(ModelView, WithoutMomentAtTheStartTheForceTellsWhatToExpect) {
  const ModelView view = viewOf(pendulum(), scene("{gravity: [9.81, 0, 0]}"));
  EXPECT_NEAR(view.torque_scale * 0.5 * 19.62 * view.size, ModelView::kArrow * view.size,
              kClosedForm);
}

TEST(ModelView, WithoutGravityAppliedWrenchesTellTheScale) {
  const ModelView view =
      viewOf(pendulum(), scene("{gravity: [0, 0, 0], applied_wrenches: "
                               "[{link: bob, at: [0.5, 0, 0], force: [0, 7, 0]}]}"));
  EXPECT_NEAR(view.force_scale * 7, ModelView::kArrow * view.size, kClosedForm);
  EXPECT_NEAR(view.torque_scale * 3.5, ModelView::kArrow * view.size, kClosedForm);
}

TEST(ModelView, WithoutAnyLoadAccelerationsTellTheScale) {
  for (const char* motion : {"full", "static"}) {
    const ModelView view =
        viewOf(pendulum(), scene(std::string("{gravity: [0, 0, 0], motion: ") + motion + "}"));
    // 1 rad/s^2: m l and m l^2 + I.
    EXPECT_NEAR(view.force_scale * 1, ModelView::kArrow * view.size, kClosedForm);
    EXPECT_NEAR(view.torque_scale * 0.51, ModelView::kArrow * view.size, kClosedForm);
  }
}

TEST(ModelView, WithoutGravityClosedLoopsAreMovedTogether) {
  LoopExample example("four_bar");
  example.scene.gravity.setZero();
  const ModelView view = viewOf(example.mechanism, example.scene);
  const double largest = ModelView::kArrow * view.size / view.force_scale;
  // The rods' masses times some 0.1 to 1 m/s^2, and not the weight.
  double mass = 0;
  for (const Link& item : example.mechanism.links()) mass += static_cast<double>(item.mass);
  EXPECT_GT(largest, 0.01 * mass);
  EXPECT_LT(largest, 2 * mass);
}

TEST(ModelView, WithoutMassAnythingWillDo) {
  const ModelView view = viewOf(robot("<link name='base'/><link name='bob'/>" +
                                      joint("pin", "continuous", "base", "bob", "0 0 0", "0 0 1")),
                                scene("{}"));
  EXPECT_EQ(view.size, 1);
  EXPECT_NEAR(view.force_scale, ModelView::kArrow, kClosedForm);
  EXPECT_TRUE(std::isfinite(view.torque_scale) && view.torque_scale > 0);
}

TEST(ModelView, LoopsAreScaledWhereTheyAreAssembled) {
  const LoopExample example("four_bar");
  const ModelView view = viewOf(example.mechanism, example.scene);
  const Dynamics dynamics(example.mechanism, example.scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(dynamics.coordinates());
  motion.q = dynamics.assembly();
  dynamics.compute(motion, workspace);
  double largest = 0;
  for (const Wrench& wrench : workspace.results().root_axes) {
    largest = std::max(largest, wrench.force.norm());
  }
  EXPECT_GT(largest, 1);
  EXPECT_NEAR(view.force_scale * largest, ModelView::kArrow * view.size, kClosedForm);
}

TEST(ModelView, TheBoxHoldsTheModelAtTheStart) {
  const Mechanism arm = leggedRobot();
  const ModelView view = viewOf(arm, scene("{applied_wrenches: [{link: shank, at: [0, 0, 2]}]}"));
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.3, 0.2, 0), Eigen::Vector3d(0.3, 0.2, -0.3),
        Eigen::Vector3d(0.425, 0.2, -0.3), Eigen::Vector3d(0.3, 0.2, 1.7)}) {
    EXPECT_LT(view.box.exteriorDistance(point), kClosedForm) << point.transpose();
  }
  EXPECT_NEAR(view.size, view.box.diagonal().norm(), kClosedForm);

  const LoopExample four_bar("four_bar");
  const ModelView loop = viewOf(four_bar.mechanism, four_bar.scene);
  // The rocker pin is above the base, whose joints lie on the x axis.
  EXPECT_GT(loop.box.max().y(), 0.2);
  EXPECT_NEAR(loop.box.min().z(), 0, kClosedForm);
}

TEST(ModelView, AnOpenChainStartsWithinItsLimits) {
  const auto withLimits = [](const std::string& lower, const std::string& upper) {
    return robot(
        "<link name='base'/>" + link("bob", 2, "0.5 0 0") +
        joint("pin", "revolute", "base", "bob", "0 0 0", "0 1 0",
              "<limit lower='" + lower + "' upper='" + upper + "' effort='1' velocity='1'/>"));
  };
  // From 60 degrees on: the arm of the weight is half as long.
  const ModelView view = viewOf(withLimits("1.0471975511965976", "2"), scene("{}"));
  EXPECT_NEAR(view.torque_scale * 4.905, ModelView::kArrow * view.size, 1e-9);
}

TEST(ModelView, PlanarMechanismsAreSeenAlongTheirAxes) {
  const ModelView lying = viewOf(pendulum("0 0 1"), scene("{}"));
  EXPECT_TRUE(lying.from_above);
  EXPECT_EQ(lying.turn, 0);
  // Down is along x of the root link, and so at the bottom of the picture.
  const ModelView hanging = viewOf(pendulum("0 0 -1"), scene("{gravity: [9.81, 0, 0]}"));
  EXPECT_TRUE(hanging.from_above);
  EXPECT_LT((hanging.up - Eigen::Vector3d(-1, 0, 0)).norm(), kClosedForm);
  for (const char* axis : {"0 1 0", "0 -1 0"}) {
    const ModelView upright = viewOf(pendulum(axis), scene("{}"));
    EXPECT_FALSE(upright.from_above);
    EXPECT_EQ(upright.pitch, 0);
    EXPECT_LT((upright.right - Eigen::Vector3d::UnitX()).norm(), kClosedForm) << axis;
    EXPECT_LT((upright.up - Eigen::Vector3d::UnitZ()).norm(), kClosedForm) << axis;
  }
  const ModelView leg = viewOf(leggedRobot(), scene("{}"));
  EXPECT_FALSE(leg.from_above);
  EXPECT_GT(leg.pitch, 0);
  EXPECT_GT(leg.up.z(), 0.5);
  const ModelView overhead = viewOf(leggedRobot(), scene("{gravity: [0, 0, 9.81]}"));
  EXPECT_TRUE(overhead.upside_down);
  EXPECT_LT(overhead.up.z(), -0.5);
}

TEST(ModelView, TextsOfTheSamePlaceAreOnDifferentLines) {
  const LoopExample example("stewart_gough");
  const std::vector<std::string> reactions = requestedReactions(example.mechanism, example.scene);
  const ModelView view = modelView(example.mechanism, example.scene, reactions);
  ASSERT_EQ(view.text_lines.size(), reactions.size());
  const auto lineOf = [&](const char* name) {
    return view.text_lines[static_cast<std::size_t>(
        std::find(reactions.begin(), reactions.end(), name) - reactions.begin())];
  };
  EXPECT_NE(lineOf("leg_1_x"), lineOf("leg_1_y"));
  EXPECT_NE(lineOf("ball_1_x"), lineOf("ball_1_y"));
  EXPECT_NE(lineOf("ball_1_y"), lineOf("ball_1_z"));
}

}  // namespace
}  // namespace virtual_work_dynamics
