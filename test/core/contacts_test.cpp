#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "touching_bodies.h"
#include "virtual_work_dynamics/joint_types.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kClosedForm = 1e-12;

struct Legs {
  Mechanism mechanism;
  Scene scene;
};

// A table whose top floats, on point feet; mass 10 kg, 0.1 m and 0.05 m off the middle.
Legs table(int legs, const std::string& more) {
  BodiesOnAxes bodies;
  bodies.add(JointType::kFixed, 0, bodies.x());
  bodies.load(1, 10, {1, 1, 1}, {0.1, 0.05, 0});
  const char* const feet[] = {"[0.3, 0.2, -0.7]", "[0.3, -0.2, -0.7]", "[-0.3, 0.2, -0.7]",
                              "[-0.3, -0.2, -0.7]"};
  std::string text =
      "joint_types: [{name: joint_1, type: floating}]\nactuated: []\n"
      "free_motion: true\nassembly: [{name: joint_1.z, position: 0.7}]\ncontacts:\n";
  for (int i = 0; i < legs; ++i) {
    text += "  - {name: foot_" + std::to_string(i) + ", link: link_1, at: " + feet[i] +
            ", plane: {link: link_0}" + more + "}\n";
  }
  const Scene scene = sceneOf(text);
  return {withJointTypes(bodies.build(), scene), scene};
}

Motion standing(const Mechanism& mechanism) {
  Motion motion(static_cast<Eigen::Index>(mechanism.coordinates().size()),
                mechanism.orientations());
  motion.q[2] = 0.7;
  return motion;
}

const double kWeight = 98.1;

TEST(Contacts, ATableOnThreeLegsStandsInOneWay) {
  const Legs three = table(3, "");
  const NamedLoopResults results(three.mechanism, three.scene, standing(three.mechanism));
  const double back = kWeight * 0.2 / 0.6, right = kWeight * 0.15 / 0.4;
  const double expected[] = {kWeight - back - right, right, back};
  for (int i = 0; i < 3; ++i) {
    const std::string foot = "foot_" + std::to_string(i);
    EXPECT_NEAR(results.childAxes(foot).force.z(), expected[i], kClosedForm * kWeight);
    const Determined& determined = results.childAxesDetermined(foot);
    EXPECT_FALSE(determined[0]) << foot;  // feet can push each other apart
    EXPECT_FALSE(determined[1]) << foot;
    EXPECT_TRUE(determined[2] && determined[3] && determined[4] && determined[5]) << foot;
    EXPECT_EQ(results.dynamics().results().loops.holds.at(i), Hold::kHolds);
  }
}

TEST(Contacts, ATableOnFourLegsStandsInMany) {
  const Legs four = table(4, "");
  const NamedLoopResults results(four.mechanism, four.scene, standing(four.mechanism));
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const std::string foot = "foot_" + std::to_string(i);
    sum += results.childAxes(foot).force.z();
    EXPECT_FALSE(results.childAxesDetermined(foot)[2]) << foot;
    EXPECT_EQ(results.dynamics().results().loops.holds.at(i), Hold::kNotDecidable);
  }
  EXPECT_NEAR(sum, kWeight, kClosedForm * kWeight);
  EXPECT_EQ(results.dynamics().determinacy().redundant_constraints, 6);
}

// Whether friction suffices is not to be told where feet can push each other apart.
TEST(Contacts, ConesOfFeetThatPushEachOtherAreNotDecidable) {
  const Legs three = table(3, ", friction: 10");
  const NamedLoopResults results(three.mechanism, three.scene, standing(three.mechanism));
  for (const Hold hold : results.dynamics().results().loops.holds) {
    EXPECT_EQ(hold, Hold::kNotDecidable);
  }
}

// A lifted foot bears nothing, and is no error: a wrench of zero, determined.
TEST(Contacts, ALiftedFootBearsNothing) {
  Legs four = table(4, "");
  four.scene.closures[3].touch.closed = false;
  const Legs three = table(3, "");
  const NamedLoopResults lifted(four.mechanism, four.scene, standing(four.mechanism));
  const NamedLoopResults without(three.mechanism, three.scene, standing(three.mechanism));
  EXPECT_EQ(lifted.rootAxes("foot_3").force, Eigen::Vector3d::Zero());
  for (const bool determined : lifted.rootAxesDetermined("foot_3")) EXPECT_TRUE(determined);
  for (int i = 0; i < 3; ++i) {
    const std::string foot = "foot_" + std::to_string(i);
    expectForce(without.rootAxes(foot).force, lifted.rootAxes(foot).force, kClosedForm * kWeight);
  }
  const std::vector<Hold>& holds = lifted.dynamics().results().loops.holds;
  EXPECT_EQ(holds, std::vector<Hold>(4, Hold::kHolds));
}

// The last foot lifts when the weight leaves the triangle of the others.
TEST(Contacts, AFootThatWouldPullIsFlagged) {
  Legs three = table(3, "");
  AppliedWrench push;
  push.link = "link_1";
  push.force = {0, 0, -100};
  for (const double out : {0.29, 0.31}) {
    push.at = {out, 0.19, 0};
    three.scene.applied_wrenches = {push};
    const NamedLoopResults results(three.mechanism, three.scene, standing(three.mechanism));
    const double expected =
        (kWeight * (0.3 - 0.1) + 100 * (0.3 - out)) / 0.6;  // about the front edge
    EXPECT_NEAR(results.childAxes("foot_2").force.z(), expected, kClosedForm * 200);
    EXPECT_EQ(results.dynamics().results().loops.holds.at(2), Hold::kHolds);
  }
  push.at = {0.8, 0.19, 0};
  three.scene.applied_wrenches = {push};
  const NamedLoopResults results(three.mechanism, three.scene, standing(three.mechanism));
  EXPECT_LT(results.childAxes("foot_2").force.z(), 0);
  EXPECT_EQ(results.dynamics().results().loops.holds.at(2), Hold::kWrongWay);
}

// A block that is free to slide and lift, pushed sideways: at the edge of the cone.
TEST(Contacts, FrictionConesAreChecked) {
  BodiesOnAxes bodies;
  int link = 0;
  for (const Vector3l& axis : {bodies.x(), bodies.y(), bodies.z()}) link = bodies.slide(link, axis);
  bodies.load(link, 2, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  for (const double share : {0.999999, 1.000001}) {
    Scene scene = sceneOf(R"(
contacts: [{name: foot, link: link_3, plane: {link: link_0}, friction: 0.5}]
gravity: [0, 0, -10]
actuated: []
)");
    AppliedWrench push;
    push.link = "link_3";
    push.force = {-6 * share, 8 * share, 0};
    scene.applied_wrenches = {push};
    const NamedLoopResults results(mechanism, scene, motionOf({0, 0, 0}, {0, 0, 0}, {0, 0, 0}));
    expectForce({6 * share, -8 * share, 20}, results.childAxes("foot").force, 20 * kClosedForm);
    EXPECT_EQ(results.dynamics().results().loops.holds.at(0),
              share < 1 ? Hold::kHolds : Hold::kOutsideCone);
  }
}

// Where the origin of the plane lies is no size of the loop, which the gap would be small against.
TEST(Contacts, AFootOffItsPlaneIsOffItWhateverThePlanesPoint) {
  BodiesOnAxes bodies;
  const int up = bodies.slide(0, bodies.z());
  bodies.load(bodies.slide(up, bodies.x()), 1, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  double near = 0;
  for (const double away : {0.0, 1e6}) {
    Scene scene = sceneOf(R"(
contacts: [{name: foot, link: link_2, slip: all, plane: {link: link_0}}]
actuated: [joint_2]
)");
    scene.closures[0].parent.xyz.x() = away;
    const NamedLoopResults results(mechanism, scene, motionOf({0.5, 0}, {0, 0}, {0, 0}));
    const double relative = results.dynamics().results().loops.relative_residuals.at(0).position;
    if (away == 0) near = relative;
    EXPECT_GT(relative, 0.1);
    EXPECT_NEAR(relative, near, kClosedForm);
  }
}

// A spring whose ends coincide pushes no one knows where, so that no one knows what the foot bears.
TEST(Contacts, HoldsOfForcesWithoutAValueAreNotDecidable) {
  BodiesOnAxes bodies;
  const int up = bodies.slide(0, bodies.z());
  bodies.load(bodies.slide(up, bodies.x()), 1, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  Scene scene = sceneOf(R"(
contacts: [{name: foot, link: link_2, slip: all, plane: {link: link_0}}]
springs: [{name: coil, link_a: link_0, link_b: link_2, stiffness: 100, rest_length: 1}]
actuated: [joint_2]
assembly: [{name: joint_2, position: 0.3}]
)");
  ClosedLoopDynamics dynamics(mechanism, scene, {});
  ClosedLoopDynamics::Workspace workspace = dynamics.makeWorkspace();
  for (const double x : {0.3, 0.0, 0.3}) {
    dynamics.compute(motionOf({0, x}, {0, 0}, {0, 0}), workspace);
    EXPECT_EQ(workspace.results().loops.holds.at(0), x == 0 ? Hold::kNotDecidable : Hold::kHolds)
        << x;
  }
  scene.closures[0].touch.closed = false;  // bears nothing whatever the spring does
  scene.actuated = {"joint_1", "joint_2"};
  ClosedLoopDynamics lifted(mechanism, scene, {});
  ClosedLoopDynamics::Workspace other = lifted.makeWorkspace();
  lifted.compute(motionOf({0, 0}, {0, 0}, {0, 0}), other);
  EXPECT_EQ(other.results().loops.holds.at(0), Hold::kHolds);
}

// Drake's LadderTest: a ladder of 7 kg on a pin with a torque of 20 N m, with a ball of 5 mm at its
// upper end against a wall without friction, a quarter of a metre off the middle.
TEST(Contacts, DrakesLadderLeansAgainstItsWall) {
  const double L = 2, r = 0.005, x = 1 - r, z = std::sqrt(L * L - x * x);
  BodiesOnAxes bodies;
  const int ladder = bodies.turn(0, bodies.y());
  bodies.load(ladder, 7, {7.0L / 3, 7.0L / 3, 0}, {0, 0, 1});
  const Mechanism mechanism = bodies.build();
  Scene scene = sceneOf(R"(
rolling: [{name: ball, link: link_1, centre: [0, 0.25, 2], axis: [0, 1, 0], radius: 0,
           tube_radius: 0.005, slip: all, plane: {link: link_0, point: [1, 0, 0],
           normal: [-1, 0, 0]}}]
gravity: [0, 0, -10]
actuated: []
assembly: [{name: joint_1, position: 0.5}]
)");
  AppliedWrench torque;
  torque.link = "link_1";
  torque.torque = {0, 20, 0};
  scene.applied_wrenches = {torque};
  const NamedLoopResults results(mechanism, scene, motionOf({std::asin(x / L)}, {0}, {0}));
  EXPECT_LE(violation(results), kClosedForm);
  const double f = (x / 2 * 70 + 20) / z;
  EXPECT_NEAR(f, 31.600736, 0.5e-6);
  expectForce({-f, 0, 0}, results.rootAxes("ball").force, 100 * kClosedForm);
  expectForce({f, 0, 70}, results.rootAxes("joint_1").force, 100 * kClosedForm);
  // The torque of the pin's actuator is an applied one here.
  expectForce({0, 0, -f / 4}, results.rootAxes("joint_1").torque, 100 * kClosedForm);
  EXPECT_EQ(results.dynamics().results().loops.holds.at(0), Hold::kHolds);
}

}  // namespace
}  // namespace virtual_work_dynamics
