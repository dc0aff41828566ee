#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "touching_bodies.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kOfTheLargest = 2e-9;  // LoopResults::least says 1e-9 of the largest force
constexpr double kUnbounded = std::numeric_limits<double>::infinity();
const double kLoad = 98.1;

// The results of one sample, with the intervals that the scene asks for.
class Bounded {
 public:
  Bounded(const Mechanism& mechanism, const Scene& scene, const Motion& motion)
      : dynamics_(mechanism, scene), workspace_(dynamics_.makeWorkspace()) {
    dynamics_.compute(motion, workspace_);
  }
  const LoopResults& loops() const { return workspace_.results().loops; }
  Hold hold(std::size_t i) const { return loops().holds.at(i); }
  std::pair<Wrench, Wrench> reaction(const std::string& name) const {
    const std::vector<std::string>& names = dynamics_.request().child_axes;
    const auto at =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    return {loops().least.child_axes.at(at), loops().most.child_axes.at(at)};
  }
  std::pair<double, double> effort(const std::string& name) const {
    const std::vector<std::string>& names = dynamics_.effortNames();
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    return {loops().least.effort[at], loops().most.effort[at]};
  }

 private:
  Dynamics dynamics_;
  Dynamics::Workspace workspace_;
};

struct Posed {
  Mechanism mechanism;
  Scene scene;
  Motion motion;
};

// A table on four feet of which the middle of mass is off the middle.
Posed fourLegs(double ahead, const std::string& more) {
  BodiesOnAxes bodies;
  bodies.add(JointType::kFixed, 0, bodies.x());
  bodies.load(1, 10, {1, 1, 1}, {ahead, 0.05, 0});
  const char* const feet[] = {"[0.3, 0.2, -0.7]", "[0.3, -0.2, -0.7]", "[-0.3, 0.2, -0.7]",
                              "[-0.3, -0.2, -0.7]"};
  std::string text =
      "joint_types: [{name: joint_1, type: floating}]\nactuated: []\ncontact_intervals: true\n"
      "free_motion: true\nassembly: [{name: joint_1.z, position: 0.7}]\ncontacts:\n";
  for (int i = 0; i < 4; ++i) {
    text += "  - {name: foot_" + std::to_string(i) + ", link: link_1, at: " + feet[i] +
            ", plane: {link: link_0}" + more + "}\n";
  }
  const Scene scene = sceneOf(text);
  const Mechanism mechanism = withJointTypes(bodies.build(), scene);
  Motion motion(6, 1);
  motion.q[2] = 0.7;
  return {mechanism, scene, motion};
}

// How much each of four legs can carry at least and at most: on three legs the fourth bears
// nothing, and t on it changes the others by t and -t.
TEST(ContactIntervals, ALegOfFourCarriesFromOneTripodToTheOther) {
  const Posed table = fourLegs(0.1, "");
  const Bounded found(table.mechanism, table.scene, table.motion);
  const double back = kLoad * 0.2 / 0.6, right = kLoad * 0.15 / 0.4, front = kLoad - back - right;
  const double least = std::max(0.0, -front), most = std::min(right, back);
  const double expected[][2] = {{front + least, front + most},
                                {right - most, right - least},
                                {back - most, back - least},
                                {least, most}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [lower, upper] = found.reaction("foot_" + std::to_string(i));
    EXPECT_NEAR(lower.force.z(), expected[i][0], kOfTheLargest * kLoad) << i;
    EXPECT_NEAR(upper.force.z(), expected[i][1], kOfTheLargest * kLoad) << i;
    EXPECT_EQ(lower.force.x(), -kUnbounded);  // no friction is known that bounds it
    EXPECT_EQ(upper.force.x(), kUnbounded);
    EXPECT_EQ(upper.torque.x(), lower.torque.x());
    EXPECT_EQ(found.hold(i), Hold::kCanHold);
  }
}

// The middle of mass beyond the front feet: they hold by no forces that press.
TEST(ContactIntervals, ATableThatTipsCannotHold) {
  for (const double ahead : {0.2999, 0.3001}) {
    const Posed table = fourLegs(ahead, ", friction: 0.5");
    const Bounded found(table.mechanism, table.scene, table.motion);
    const auto [lower, upper] = found.reaction("foot_3");
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(found.hold(i), ahead < 0.3 ? Hold::kCanHold : Hold::kCannotHold);
    }
    EXPECT_EQ(std::isnan(lower.force.z()), ahead > 0.3);
    EXPECT_EQ(std::isnan(upper.force.z()), ahead > 0.3);
    if (ahead > 0.3) continue;
    // With friction, what feet can push each other apart by is bounded.
    EXPECT_LE(upper.force.x(), 0.5 * upper.force.z() * 1.0001);
    EXPECT_GT(upper.force.x(), 0);
    EXPECT_NEAR(upper.force.x(), -lower.force.x(), 1e-9 * kLoad);
  }
}

// A uniform ladder of weight W in a plane, rough at its foot and at the wall: with F up along the
// wall, it presses there by (W/2 - F) cot(angle), and so much the foot must stick by.
TEST(ContactIntervals, ALadderWithTwoRoughEndsHoldsAsStaticsSays) {
  const double W = 50, wall = 0.4;
  int holds = 0, slips = 0;
  for (const double floor : {0.2, 0.3, 0.4, 0.5}) {
    for (const double angle : {0.6, 0.8, 1.0, 1.2}) {
      const double c = std::cos(angle), s = std::sin(angle), k = c / s;
      BodiesOnAxes bodies;
      const int along = bodies.slide(0, bodies.x());
      const int ladder = bodies.turn(bodies.slide(along, bodies.z()), bodies.y());
      bodies.load(ladder, 5, {1, 1, 1}, {1, 0, 0});
      const Mechanism mechanism = bodies.build();
      Scene scene = sceneOf(R"(
contacts:
  - {name: foot, link: link_3, plane: {link: link_0}, friction: 1}
  - {name: top, link: link_3, at: [2, 0, 0], plane: {link: link_0, normal: [-1, 0, 0]}, friction: 0.4}
gravity: [0, 0, -10]
actuated: []
contact_intervals: true
)");
      scene.closures[0].touch.friction = floor;
      scene.closures[1].parent.xyz.x() = 2 * c;
      scene.assembly = {{"joint_3", -angle}};
      const Bounded found(mechanism, scene, motionOf({0, 0, -angle}, {0, 0, 0}, {0, 0, 0}));
      double least = -wall * k * W / 2 / (1 - wall * k), most = wall * k * W / 2 / (1 + wall * k);
      if (wall * k >= 1) least = -kUnbounded;
      const double edge = W * (k / 2 - floor) / (k - floor);
      (k > floor ? least : most) = k > floor ? std::max(least, edge) : std::min(most, edge);
      const bool can = least <= most;
      ++(can ? holds : slips);
      EXPECT_EQ(found.hold(0), can ? Hold::kCanHold : Hold::kCannotHold) << floor << " " << angle;
      EXPECT_EQ(found.hold(1), found.hold(0));
      const auto [lower, upper] = found.reaction("foot");
      EXPECT_EQ(std::isnan(lower.force.z()), !can);
      if (!can) continue;
      EXPECT_NEAR(lower.force.z(), W - most, kOfTheLargest * W) << floor << " " << angle;
      EXPECT_NEAR(upper.force.z(), W - least, kOfTheLargest * W) << floor << " " << angle;
    }
  }
  EXPECT_GT(holds, 4);
  EXPECT_GT(slips, 4);
}

// Two fingers with a motor each hold a body by friction: what they must squeeze it by at least, and
// nothing says by how much they may.
TEST(ContactIntervals, AGripperMustSqueezeByTheWeightOverFriction) {
  BodiesOnAxes bodies;
  bodies.slide(0, bodies.x());
  bodies.slide(0, bodies.x());
  const int held = bodies.slide(bodies.slide(0, bodies.x()), bodies.z());
  bodies.load(held, 2, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  const Scene scene = sceneOf(R"(
contacts:
  - {name: left, link: link_1, plane: {link: link_4, normal: [-1, 0, 0]}, friction: 0.25}
  - {name: right, link: link_2, plane: {link: link_4, normal: [1, 0, 0]}, friction: 0.25}
gravity: [0, 0, -10]
actuated: [joint_1, joint_2]
contact_intervals: true
)");
  const Bounded found(mechanism, scene, motionOf({0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}));
  const double squeeze = 20 / (2 * 0.25);
  EXPECT_NEAR(found.effort("joint_1").first, squeeze, kOfTheLargest * squeeze);
  EXPECT_EQ(found.effort("joint_1").second, kUnbounded);
  EXPECT_EQ(found.effort("joint_2").first, -kUnbounded);
  EXPECT_NEAR(found.effort("joint_2").second, -squeeze, kOfTheLargest * squeeze);
  EXPECT_NEAR(found.reaction("left").first.force.z(), squeeze, kOfTheLargest * squeeze);
  EXPECT_EQ(found.hold(0), Hold::kCanHold);
}

// A body in a plane on three cables, two of them up at 45 degrees and one down: the third one may
// pull by any force, and the others by half of the weight and that, over the sine.
TEST(ContactIntervals, CablesPullEachOtherWithoutBound) {
  BodiesOnAxes bodies;
  const int body = bodies.slide(bodies.slide(0, bodies.x()), bodies.z());
  bodies.load(body, 2, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  for (const double up : {0.0, 15.0, 25.0}) {
    Scene scene = sceneOf(R"(
cylinders:
  - {name: left, link_a: link_0, at_a: [-1, 0, 1], link_b: link_2, pulls_only: true}
  - {name: right, link_a: link_0, at_a: [1, 0, 1], link_b: link_2, pulls_only: true}
  - {name: below, link_a: link_0, at_a: [0, 0, -1], link_b: link_2, pulls_only: true}
gravity: [0, 0, -10]
actuated: []
contact_intervals: true
)");
    AppliedWrench lift;
    lift.link = "link_2";
    lift.force = {0, 0, up};
    scene.applied_wrenches = {lift};
    const Bounded found(mechanism, scene, motionOf({0, 0}, {0, 0}, {0, 0}));
    const double weight = 20 - up;
    EXPECT_EQ(found.effort("below").first, -kUnbounded);
    EXPECT_NEAR(found.effort("below").second, std::min(0.0, weight), kOfTheLargest * 20);
    EXPECT_EQ(found.effort("left").first, -kUnbounded);
    EXPECT_NEAR(found.effort("left").second, -std::max(0.0, weight) / std::sqrt(2),
                kOfTheLargest * 20);
    EXPECT_EQ(found.hold(2), Hold::kCanHold);
  }
}

// What is judged by itself stays so: a foot that must pull does, whatever the others may choose.
TEST(ContactIntervals, DeterminedForcesKeepTheirVerdict) {
  BodiesOnAxes bodies;
  bodies.load(bodies.slide(0, bodies.z()), 1, {1, 1, 1});
  bodies.load(bodies.slide(0, bodies.z()), 1, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  for (const double down : {0.0, -30.0}) {
    const Scene scene = sceneOf(R"(
contacts:
  - {name: alone, link: link_1, slip: all, plane: {link: link_0}}
  - {name: a, link: link_2, at: [1, 0, 0], slip: all, plane: {link: link_0}}
  - {name: b, link: link_2, at: [-1, 0, 0], slip: all, plane: {link: link_0}}
gravity: [0, 0, -10]
actuated: []
contact_intervals: true
)");
    const Bounded found(mechanism, scene, motionOf({0, 0}, {0, 0}, {down, 0}));
    EXPECT_EQ(found.hold(0), down == 0 ? Hold::kHolds : Hold::kWrongWay);
    EXPECT_EQ(found.hold(1), Hold::kCanHold);
    const auto [lower, upper] = found.reaction("alone");
    EXPECT_EQ(lower.force.z(), upper.force.z());
    EXPECT_NEAR(lower.force.z(), 10 + down, kOfTheLargest * 20);
    EXPECT_EQ(found.reaction("a").first.force.z(), 0);
    EXPECT_NEAR(found.reaction("a").second.force.z(), 10, kOfTheLargest * 10);
  }
}

// Without being asked for, nothing is found, and not decidable is not decidable.
TEST(ContactIntervals, AreFoundOnRequestOnly) {
  Posed table = fourLegs(0.1, "");
  table.scene.contact_intervals = false;
  const Bounded found(table.mechanism, table.scene, table.motion);
  EXPECT_EQ(found.hold(0), Hold::kNotDecidable);
  EXPECT_EQ(found.loops().least.effort.size(), 0);
  EXPECT_TRUE(found.loops().most.child_axes.empty());
}

TEST(ContactIntervals, AreRefusedWhereNothingBoundsForces) {
  BodiesOnAxes bodies;
  bodies.load(bodies.slide(0, bodies.z()), 1, {1, 1, 1});
  try {
    Dynamics(bodies.build(), sceneOf("contact_intervals: true"));
    FAIL() << "not refused";
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()),
              "contact_intervals: no contact presses and no cable pulls, so that nothing bounds a "
              "force");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
