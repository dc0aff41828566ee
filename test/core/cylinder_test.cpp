#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "loop_examples.h"
#include "loops/cut_tree.h"
#include "loops/driven_conditions.h"
#include "loops/kinematics.h"
#include "touching_bodies.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kClosedForm = 1e-12;
// Of central differences with a step of kStep.
constexpr double kStep = 1e-5;
constexpr double kDifference = 1e-8;

// A boom on a ram, and a stick on it with a ram between both: an excavator without its bucket.
struct Excavator {
  static constexpr double m = 40, g = 9.81, com = 0.8, I = 3;

  static Mechanism mechanism() {
    BodiesOnAxes bodies;
    const int boom = bodies.turn(0, bodies.y());
    bodies.load(boom, m, {0.2, I, I}, {com, 0, 0.1});
    bodies.load(bodies.turn(boom, bodies.y(), {1.6, 0, 0}), 15, {0.1, 1, 1}, {0.4, 0, 0});
    return bodies.build();
  }
  static Scene scene() {
    return sceneOf(R"(
cylinders:
  - {name: boom_ram, link_a: link_0, at_a: [0.4, 0.1, -0.3], link_b: link_1, at_b: [0.9, 0.1, 0.2]}
  - {name: stick_ram, link_a: link_1, at_a: [0.7, 0, 0.4], link_b: link_2, at_b: [-0.25, 0, 0.1]}
gravity: [0, 0, -9.81]
actuated: []
)");
  }
  static Motion motion() { return motionOf({-0.6, 0.9}, {0.4, -0.7}, {-0.9, 1.2}); }

  // Lengths of both rams, by hand.
  static Eigen::Vector2d lengths(double boom, double stick) {
    const auto turned = [](double angle, const Eigen::Vector2d& v) {
      // About y: x goes to -z.
      return Eigen::Vector2d(std::cos(angle) * v.x() + std::sin(angle) * v.y(),
                             -std::sin(angle) * v.x() + std::cos(angle) * v.y());
    };
    const Eigen::Vector2d first = turned(boom, {0.9, 0.2}) - Eigen::Vector2d(0.4, -0.3);
    const Eigen::Vector2d second =
        Eigen::Vector2d(1.6, 0) + turned(stick, {-0.25, 0.1}) - Eigen::Vector2d(0.7, 0.4);
    return {first.norm(), second.norm()};
  }
};

// The torques that motors in the joints would need, over the levers dl/dq: virtual work.
TEST(Cylinder, ForcesAreTorquesOverLevers) {
  const Mechanism mechanism = Excavator::mechanism();
  const Motion motion = Excavator::motion();
  const NamedLoopResults results(mechanism, Excavator::scene(), motion);
  Request request;
  const InverseDynamics tree(mechanism, sceneOf("gravity: [0, 0, -9.81]"), request);
  Workspace workspace = tree.makeWorkspace();
  tree.compute(motion, workspace);
  const double boom = motion.q[0], stick = motion.q[1];
  const Eigen::Vector2d now = Excavator::lengths(boom, stick);
  const double on_boom =
      (Excavator::lengths(boom + kStep, stick)[0] - Excavator::lengths(boom - kStep, stick)[0]) /
      (2 * kStep);
  const double on_stick =
      (Excavator::lengths(boom, stick + kStep)[1] - Excavator::lengths(boom, stick - kStep)[1]) /
      (2 * kStep);
  const auto& effort = results.dynamics().effort();
  ASSERT_EQ(effort.size(), 4);
  EXPECT_EQ(effort[0], 0);
  EXPECT_EQ(effort[1], 0);
  const double boom_force = workspace.effort()[0] / on_boom;
  const double stick_force = workspace.effort()[1] / on_stick;
  EXPECT_NEAR(effort[2], boom_force, kDifference * std::abs(boom_force));
  EXPECT_NEAR(effort[3], stick_force, kDifference * std::abs(stick_force));
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(results.dynamics().effortDetermined()[i]);
  // Its length and the rate of that.
  const Eigen::VectorXd& positions = results.dynamics().actuatedPositions();
  EXPECT_NEAR(positions[0], now[0], kClosedForm);
  EXPECT_NEAR(positions[1], now[1], kClosedForm);
  const Eigen::Vector2d before =
      Excavator::lengths(boom - kStep * motion.qd[0], stick - kStep * motion.qd[1]);
  const Eigen::Vector2d then =
      Excavator::lengths(boom + kStep * motion.qd[0], stick + kStep * motion.qd[1]);
  const Eigen::VectorXd& velocities = results.dynamics().actuatedVelocities();
  EXPECT_NEAR(velocities[0], (then[0] - before[0]) / (2 * kStep), kDifference);
  EXPECT_NEAR(velocities[1], (then[1] - before[1]) / (2 * kStep), kDifference);
  // Power in: the mechanism's, with motors in its joints.
  EXPECT_NEAR(effort.tail<2>().dot(velocities), workspace.effort().dot(motion.qd), 1e-10);
  // The reaction is the force along the line, on link_b.
  EXPECT_NEAR(results.rootAxes("boom_ram").force.norm(), std::abs(boom_force),
              kDifference * std::abs(boom_force));
  EXPECT_EQ(results.rootAxes("boom_ram").torque, Eigen::Vector3d::Zero());
  EXPECT_EQ(results.rootAxes("boom_ram").force.y(), 0);
}

// A rod of the same length bears the same force, whoever moves the joints.
TEST(Cylinder, BearsWhatARodBears) {
  const Mechanism mechanism = Excavator::mechanism();
  Scene rods = Excavator::scene();
  for (Closure& closure : rods.closures) closure.type = ClosureType::kDistance;
  const Motion motion = Excavator::motion();
  const NamedLoopResults rod(mechanism, rods, motion);
  const NamedLoopResults ram(mechanism, Excavator::scene(), motion);
  for (const std::string name : {"ground", "joint_1", "joint_2", "boom_ram", "stick_ram"}) {
    const double size = rod.rootAxes(name).force.norm() + 1;
    expectForce(rod.rootAxes(name).force, ram.rootAxes(name).force, kClosedForm * size);
    expectForce(rod.rootAxes(name).torque, ram.rootAxes(name).torque, kClosedForm * size);
  }
}

TEST(Cylinder, LagrangesEquationsFindNothingLeftOver) {
  const Mechanism mechanism = Excavator::mechanism();
  ClosedLoops loops(mechanism, Excavator::scene());
  const Motion motion = Excavator::motion();
  loops.compute(motion);
  LagrangeDynamics<double> lagrange(mechanism, loops.tree(), {});
  lagrange.compute(motion, loops.treeLoad());
  EXPECT_NEAR(lagrange.effort()[0], 0, 1e-10);
  EXPECT_NEAR(lagrange.effort()[1], 0, 1e-10);
}

// Two rams on one boom share its load by their levers: the least sum of squares.
TEST(Cylinder, SeveralOnOneJointShareItsLoad) {
  BodiesOnAxes bodies;
  bodies.load(bodies.turn(0, bodies.y()), 10, {1, 1, 1}, {-0.5, 0, 0});
  const Mechanism mechanism = bodies.build();
  const NamedLoopResults results(mechanism, sceneOf(R"(
cylinders:
  - {name: a, link_a: link_0, at_a: [0.3, 0, -0.4], link_b: link_1, at_b: [0.3, 0, 0]}
  - {name: b, link_a: link_0, at_a: [0.6, 0, -0.4], link_b: link_1, at_b: [0.6, 0, 0],
     pulls_only: true}
  - {name: c, link_a: link_0, at_a: [-0.6, 0, -0.4], link_b: link_1, at_b: [-0.6, 0, 0],
     pulls_only: true}
gravity: [0, 0, -10]
actuated: []
)"),
                                 motionOf({0}, {0}, {0}));
  // The weight turns the boom by 50 N m about -y; levers are 0.3, 0.6 and -0.6 m.
  const double share = -50 / (0.09 + 0.36 + 0.36);
  const auto& effort = results.dynamics().effort();
  EXPECT_NEAR(effort[1], 0.3 * share, kClosedForm * 50);
  EXPECT_NEAR(effort[2], 0.6 * share, kClosedForm * 50);
  EXPECT_NEAR(effort[3], -0.6 * share, kClosedForm * 50);
  for (int i = 1; i < 4; ++i) EXPECT_FALSE(results.dynamics().effortDetermined()[i]);
  EXPECT_EQ(results.dynamics().determinacy().redundancy, 2);
  EXPECT_EQ(results.dynamics().determinacy().redundant_constraints, 0);
}

// As a motion that gives lengths needs it: the row of a length and its derivative.
TEST(Cylinder, LengthsHaveTheDerivativesOfTheirDifferences) {
  const Mechanism mechanism = Excavator::mechanism();
  const Motion motion = Excavator::motion();
  const LoopKinematics loops(mechanism, Excavator::scene());
  ConditionSets sets = loops.conditionSets();
  for (const std::size_t ram : {0, 1}) {
    sets.push_back(std::make_shared<FreeAxisDrive>("ram", loops.closure(ram), ram));
  }
  LoopKinematics kinematics(mechanism, sets);
  kinematics.driven() = Motion(2);
  const auto lengthsAt = [&](double time) -> Eigen::VectorXd {
    kinematics.setPosition(motion.q + time * motion.qd);
    return kinematics.phi();
  };
  const double step = 1e-4;
  const Eigen::VectorXd then = lengthsAt(step), before = lengthsAt(-step), now = lengthsAt(0);
  ASSERT_EQ(now.size(), 2);
  EXPECT_NEAR(now[1], Excavator::lengths(motion.q[0], motion.q[1])[1], kClosedForm);
  kinematics.setVelocity(motion.qd);
  const Eigen::VectorXd rates = kinematics.jacobian() * motion.qd;
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(rates[i], (then[i] - before[i]) / (2 * step), kDifference) << i;
    EXPECT_NEAR(kinematics.turning()[i], (then[i] - 2 * now[i] + before[i]) / (step * step), 1e-6)
        << i;
  }
}

// Without a length it has no direction, and what only it could hold has no value.
TEST(Cylinder, HoldsNothingWhereItsEndsMeet) {
  BodiesOnAxes bodies;
  bodies.load(bodies.turn(0, bodies.y()), 10, {1, 1, 1}, {0.5, 0, 0});
  const Mechanism mechanism = bodies.build();
  ClosedLoops loops(mechanism, sceneOf(R"(
cylinders: [{name: ram, link_a: link_0, at_a: [0.5, 0, 0], link_b: link_1, at_b: [0.5, 0, 0]}]
actuated: []
assembly: [{name: joint_1, position: 0.3}]
)"));
  loops.compute(motionOf({0.3}, {0.1}, {0}));
  EXPECT_TRUE(loops.effortExists()[1]);
  loops.compute(motionOf({0}, {0.1}, {0}));
  EXPECT_TRUE(loops.results().singular());
  EXPECT_FALSE(loops.effortExists()[1]);
  EXPECT_TRUE(loops.finite());
}

// The example: what the rams feed in is what motors in its joints would.
TEST(Cylinder, RamsMoveTheExampleOfTheExcavator) {
  const LoopExample example("excavator");
  Request request;
  const InverseDynamics motors(example.mechanism, withoutLoops(example.scene), request);
  Workspace workspace = motors.makeWorkspace();
  ClosedLoops rams(example.mechanism, example.scene, request);
  EXPECT_EQ(rams.actuatedClosures(),
            (std::vector<std::string>{"boom_ram", "stick_ram", "bucket_ram"}));
  for (const double t : {0.0, 0.5, 1.0}) {
    const Motion motion =
        motionOf({0.3 - t, 1.5 - 0.5 * t, 0.2 + t}, {-0.4, 0.3, 0.5}, {0.2, -0.6, 0.9});
    motors.compute(motion, workspace);
    rams.compute(motion);
    const double power = workspace.effort().dot(motion.qd);
    EXPECT_NEAR(rams.effort().tail<3>().dot(rams.actuatedVelocities()), power,
                1e-12 * std::abs(workspace.effort().cwiseAbs().maxCoeff()));
    for (int i = 0; i < 3; ++i)
      EXPECT_TRUE(rams.effortDetermined()[static_cast<std::size_t>(3 + i)]);
  }
}

TEST(Cylinder, ACableThatWouldPushIsFlagged) {
  BodiesOnAxes bodies;
  bodies.load(bodies.turn(0, bodies.y()), 10, {1, 1, 1}, {0.5, 0, 0});
  const Mechanism mechanism = bodies.build();
  for (const bool above : {true, false}) {
    const Scene scene = sceneOf(
        std::string("cylinders: [{name: cable, pulls_only: true, link_a: link_0, at_a: [0.5, 0, ") +
        (above ? "1" : "-1") + "], link_b: link_1, at_b: [0.5, 0, 0]}]\nactuated: []\n");
    const ClosedLoopDynamics dynamics(mechanism, scene, {});
    EXPECT_EQ(dynamics.oneSided(), std::vector<std::string>{"cable"});
    ClosedLoopDynamics::Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motionOf({0}, {0}, {0}), workspace);
    EXPECT_NEAR(workspace.results().effort[1], above ? -98.1 : 98.1, 1e-10);
    EXPECT_EQ(workspace.results().loops.holds.at(0), above ? Hold::kHolds : Hold::kWrongWay);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
