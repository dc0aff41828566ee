// Mechanisms of which something is driven.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "exact_derivatives.h"
#include "loop_examples.h"
#include "maximal_coordinates_oracle.h"
#include "random_loops.h"
#include "touching_bodies.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/drives.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/passive_joints.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms in double against recursions in double.
constexpr double kClosedForm = 1e-12;
// The recursion of another plan.
constexpr double kOtherRoute = 1e-11;

void expectNear(double found, double expected, double tolerance = kClosedForm) {
  ASSERT_TRUE(std::isfinite(found));
  EXPECT_LE(std::abs(found - expected), tolerance * std::max(1.0, std::abs(expected)));
}

Scene driving(const std::string& law, const std::string& rest = "") {
  return sceneOf("drives: [{name: joint_1, " + law + "}]\n" + rest);
}

// A hoop turns about the vertical at a speed that its drive holds; a bead slides on it.
TEST(DrivenMechanisms, BeadOnARotatingHoop) {
  constexpr double m = 0.2, R = 0.5, g = 9.81, w = 3;
  BodiesOnAxes bodies;
  const int hoop = bodies.turn(0, bodies.z());
  // The angle counts from the lowest point; a positive turn about y takes -z towards -x.
  bodies.load(bodies.turn(hoop, bodies.y()), m, {0, 0, 0}, {0, 0, -R});
  const Mechanism mechanism = bodies.build();
  const Scene scene = driving("law: polynomial, coefficients: [0.4, 3]", "gravity: [0, 0, -9.81]");
  Drives drives(mechanism, scene);
  EXPECT_EQ(drives.coordinates(), (std::vector<bool>{true, false}));
  const Dynamics dynamics(mechanism, scene, Request());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const double q = 0.7, qd = -1.3, qdd = 2.1;
  Motion motion = motionOf({9, q}, {9, qd}, {9, qdd}), driven(0);
  ASSERT_FALSE(drives.evaluate(2, dynamics.given(), motion, driven));
  EXPECT_DOUBLE_EQ(motion.q[0], 6.4);
  dynamics.compute(motion, workspace);
  const double s = std::sin(q), c = std::cos(q);
  expectNear(workspace.results().effort[0], 2 * m * R * R * s * c * qd * w);
  expectNear(workspace.results().effort[1],
             m * R * R * qdd - m * R * R * s * c * w * w + m * g * R * s);
}

// What follows from drives is not asked of motions, even where nothing is said to be passive.
TEST(DrivenMechanisms, WhatFollowsFromDrivesIsNotGiven) {
  const LoopExample example("slider_crank");
  Scene scene = example.scene;
  scene.actuated.reset();
  DriveLaw law;
  law.name = "crank_joint";
  law.coefficients = {{0.4, 2}};
  scene.drives = {law};
  const Mechanism& robot = example.mechanism;
  const auto given = [&] { return Dynamics(robot, scene, Request()).given().coordinates; };
  std::vector<bool> crank(robot.coordinates().size(), false);
  crank[static_cast<std::size_t>(robot.coordinateIndex("crank_joint"))] = true;
  EXPECT_EQ(given(), crank);
  scene.actuated = std::vector<std::string>{"slider_joint"};
  EXPECT_EQ(given(), crank);
  law.name = "slider_joint";
  scene.drives.push_back(law);
  EXPECT_THROW(given(), SceneError);  // each follows from the other
}

// A pendulum whose pivot moves sideways by a sine.
TEST(DrivenMechanisms, PendulumWithAMovingPivot) {
  constexpr double m = 1.5, l = 0.8, g = 9.81, A = 0.2, T = 1.7;
  BodiesOnAxes bodies;
  const int pivot = bodies.slide(0, bodies.x());
  bodies.load(bodies.turn(pivot, bodies.y()), m, {0, 0, 0}, {0, 0, -l});
  const Mechanism mechanism = bodies.build();
  const Scene scene = driving("law: sine, amplitude: 0.2, period: 1.7", "gravity: [0, 0, -9.81]");
  Drives drives(mechanism, scene);
  const Dynamics dynamics(mechanism, scene, Request());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const double q = 0.4, qd = 2.2, qdd = -1.1, t = 3.3;
  Motion motion = motionOf({0, q}, {0, qd}, {0, qdd}), driven(0);
  ASSERT_FALSE(drives.evaluate(t, dynamics.given(), motion, driven));
  dynamics.compute(motion, workspace);
  const double w = 2 * M_PI / T, a = -A * w * w * std::sin(w * t);
  // The bob is at x - l sin q: a turn about y takes -z towards -x.
  const double s = std::sin(q), c = std::cos(q);
  expectNear(workspace.results().effort[0], m * (a - l * (qdd * c - qd * qd * s)));
  expectNear(workspace.results().effort[1], m * l * l * qdd - m * l * c * a + m * g * l * s);
}

// The slider crank by its closed form, its crank by a drive at constant speed.
TEST(DrivenMechanisms, ACrankAtConstantSpeedMovesTheSlider) {
  const LoopExample example("slider_crank");
  Scene scene = example.scene;
  scene.actuated = std::vector<std::string>{};
  DriveLaw law;
  law.name = "crank_joint";
  law.coefficients = {{0.7, 5}};
  scene.drives = {law};
  const auto positions = [](long double t) {
    const long double crank = 0.7L + 5 * t;
    const long double rod = -std::asin(0.10L / 0.30L * std::sin(crank));
    return Positions{{"crank_joint", crank},
                     {"rod_joint", rod - crank},
                     {"slider_joint", 0.10L * std::cos(crank) + 0.30L * std::cos(rod)}};
  };
  const Dynamics dynamics(example.mechanism, scene, Request());
  const Dynamics as_before(example.mechanism, example.scene, Request());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Dynamics::Workspace other = as_before.makeWorkspace();
  EXPECT_EQ(dynamics.actuated(), as_before.actuated());
  Drives drives(example.mechanism, scene);
  PassiveJoints passive(example.mechanism, dynamics);
  Motion motion(3), driven(0);
  for (int i = 0; i < 200; ++i) {
    const double t = 0.01 * i;
    ASSERT_FALSE(drives.evaluate(t, dynamics.given(), motion, driven));
    ASSERT_TRUE(passive.complete(motion, driven, dynamics, workspace));
    const Motion expected = motionAt(example.mechanism, positions, t);
    for (int j = 0; j < 3; ++j) {
      expectNear(motion.q[j], expected.q[j], 1e-10);
      expectNear(motion.qd[j], expected.qd[j], 1e-10);
      expectNear(motion.qdd[j], expected.qdd[j], 1e-9);
    }
    dynamics.compute(motion, workspace);
    as_before.compute(motion, other);
    EXPECT_EQ(workspace.results().effort, other.results().effort);
  }
}

// Two rams whose lengths are random functions of time.
struct DrivenRams {
  explicit DrivenRams(unsigned seed) : random(seed) {
    BodiesOnAxes bodies;
    const int boom = bodies.turn(0, bodies.y());
    bodies.load(boom, 40, {0.2, 3, 3}, {0.8, 0, 0.1});
    bodies.load(bodies.turn(boom, bodies.y(), {1.6, 0, 0}), 15, {0.1, 1, 1}, {0.4, 0, 0});
    mechanism.emplace(bodies.build());
    scene.actuated = std::vector<std::string>{};
    start = {draw(-0.7, -0.4), draw(0.7, 1.1)};
    addRam("boom_ram", "link_0", {0.4, draw(-0.1, 0.1), -0.3}, "link_1",
           {draw(0.8, 1), draw(-0.1, 0.1), 0.2});
    addRam("stick_ram", "link_1", {0.7, 0, draw(0.3, 0.5)}, "link_2", {-0.25, 0, draw(0, 0.2)});
    scene.assembly = {{"joint_1", start[0]}, {"joint_2", start[1]}};
    const Vector2l lengths = lengthsAt({start[0], start[1]});
    for (int i = 0; i < 2; ++i) {
      DriveLaw law;
      law.name = scene.closures[static_cast<std::size_t>(i)].name;
      law.coefficients = {
          {static_cast<double>(lengths[i]), draw(-0.1, 0.1), draw(-0.1, 0.1), draw(-0.1, 0.1)}};
      scene.drives.push_back(law);
    }
  }

  double draw(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  }

  void addRam(const std::string& name, const std::string& a, const Eigen::Vector3d& at_a,
              const std::string& b, const Eigen::Vector3d& at_b) {
    Closure ram;
    ram.name = name;
    ram.type = ClosureType::kCylinder;
    ram.parent.link = a;
    ram.parent.xyz = at_a;
    ram.child.link = b;
    ram.child.xyz = at_b;
    scene.closures.push_back(ram);
  }

  // Lengths of both rams, by hand.
  Vector2l lengthsAt(const Vector2l& q) const {
    const auto turned = [](long double angle, const Vector3l& v) {
      return Vector3l(std::cos(angle) * v.x() + std::sin(angle) * v.z(), v.y(),
                      -std::sin(angle) * v.x() + std::cos(angle) * v.z());
    };
    const auto at = [&](std::size_t ram, bool child) -> Vector3l {
      const Closure& closure = scene.closures[ram];
      return (child ? closure.child : closure.parent).xyz.cast<long double>();
    };
    return {(turned(q[0], at(0, true)) - at(0, false)).norm(),
            (Vector3l(1.6L, 0, 0) + turned(q[1], at(1, true)) - at(1, false)).norm()};
  }

  std::mt19937 random;
  std::optional<Mechanism> mechanism;
  Scene scene;
  std::array<double, 2> start;
};

// A scene that says by `actuated` what drives say by themselves.
Scene withActuators(Scene scene) {
  for (const DriveLaw& drive : scene.drives) scene.actuated->push_back(drive.name);
  scene.drives.clear();
  return scene;
}

TEST(DrivenMechanisms, LengthsOfRamsFollowTheirFunctionsAndForcesTheOracle) {
  double worst_motion = 0, worst_force = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const DrivenRams rams(seed);
    const Mechanism& mechanism = *rams.mechanism;
    Request request;
    request.root_axes = {kGround, "joint_1", "joint_2", "boom_ram", "stick_ram"};
    const Dynamics dynamics(mechanism, rams.scene, request);
    EXPECT_EQ(dynamics.given().closures, (std::vector<std::size_t>{0, 1}));
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    Drives drives(mechanism, rams.scene);
    PassiveJoints passive(mechanism, dynamics);
    Motion motion(2), driven(2);
    const long double t = 0.5L * (seed + 1) / 100;
    ASSERT_FALSE(drives.evaluate(static_cast<double>(t), dynamics.given(), motion, driven));
    ASSERT_TRUE(passive.complete(motion, driven, dynamics, workspace));
    const Vector2l q = motion.q.cast<long double>(), qd = motion.qd.cast<long double>(),
                   qdd = motion.qdd.cast<long double>();
    const auto lengths = withDerivatives(
        [&](long double s) -> Vector2l {
          return rams.lengthsAt(Vector2l(q + s * qd + s * s / 2 * qdd));
        },
        0);
    for (int i = 0; i < 2; ++i) {
      const auto& c = rams.scene.drives[static_cast<std::size_t>(i)].coefficients[0];
      const long double time = static_cast<double>(t);
      const long double l = c[0] + time * (c[1] + time * (c[2] + time * c[3]));
      const long double rate = c[1] + time * (2 * c[2] + 3 * time * c[3]);
      const long double acceleration = 2 * c[2] + 6 * time * c[3];
      for (const long double off :
           {lengths.value[i] - l, lengths.rate[i] - rate, lengths.acceleration[i] - acceleration}) {
        worst_motion = std::max(worst_motion, static_cast<double>(std::abs(off)));
      }
    }
    dynamics.compute(motion, workspace);
    const Scene actuated = withActuators(rams.scene);
    const MaximalCoordinatesOracle oracle(mechanism, actuated, motion);
    EXPECT_EQ(oracle.redundancy(), 0);
    for (std::size_t i = 0; i < request.root_axes.size(); ++i) {
      const auto expected = oracle.rootAxes(request.root_axes[i]);
      for (int axis = 0; axis < 6; ++axis) {
        const double off = component(workspace.results().root_axes[i], axis) -
                           static_cast<double>(expected.wrench[axis]);
        worst_force = std::max(worst_force, std::abs(off) / 500);
      }
    }
  }
  // The loops are closed to 1e-13 m or so; forces are of some hundreds of newtons.
  EXPECT_LT(worst_motion, 1e-12);
  EXPECT_LT(worst_force, 1e-13);
  EXPECT_GT(worst_motion, 0);
  RecordProperty("worst_motion", std::to_string(worst_motion * 1e15) + "e-15");
  RecordProperty("worst_force", std::to_string(worst_force * 1e15) + "e-15");
}

struct LiftedBoom {
  static constexpr char kLaw[] =
      ", law: polynomial, coefficients: [0.7810249675906654, 0.3, -0.2]}]";

  // On a leg of massless links, or without it.
  static Mechanism mechanism(bool leg) {
    BodiesOnAxes bodies;
    bodies.load(bodies.turn(0, bodies.y()), 40, {0.2, 3, 3}, {0.8, 0, 0.1});
    if (leg) bodies.slide(bodies.turn(0, bodies.y(), {0.4, 0, -0.6}), bodies.x());
    return bodies.build();
  }
  static Scene scene(bool leg) {
    const std::string rest = std::string(kLaw) + "\ngravity: [0, 0, -9.81]\nactuated: []\n";
    if (!leg) {
      return sceneOf(
          "cylinders: [{name: ram, link_a: link_0, at_a: [0.4, 0, -0.6], link_b: link_1, "
          "at_b: [0.9, 0, 0]}]\ndrives: [{name: ram" +
          rest);
    }
    return sceneOf(
        "closures: [{name: eye, type: revolute, parent: {link: link_3, rpy: [-1.5707963267948966, "
        "0, 0]}, child: {link: link_1, xyz: [0.9, 0, 0], rpy: [-1.5707963267948966, 0, 0]}}]\n"
        "assembly: [{name: joint_2, position: -0.876}, {name: joint_3, position: 0.781}]\n"
        "drives: [{name: joint_3" +
        rest);
  }
};

// A rod of given length is a leg between two pins whose slide is given that length.
TEST(DrivenMechanisms, ADrivenRamIsALegWhoseSlideIsDriven) {
  double efforts[2];
  Motion motions[2] = {Motion(1), Motion(3)};
  Wrench pins[2];
  for (const bool leg : {false, true}) {
    const Mechanism mechanism = LiftedBoom::mechanism(leg);
    const Scene scene = LiftedBoom::scene(leg);
    Request request;
    request.root_axes = {"joint_1"};
    const Dynamics dynamics(mechanism, scene, request);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    Drives drives(mechanism, scene);
    PassiveJoints passive(mechanism, dynamics);
    Motion driven(leg ? 0 : 1);
    ASSERT_FALSE(drives.evaluate(0.4, dynamics.given(), motions[leg], driven));
    ASSERT_TRUE(passive.complete(motions[leg], driven, dynamics, workspace));
    dynamics.compute(motions[leg], workspace);
    efforts[leg] = workspace.results().effort[leg ? 2 : 1];
    pins[leg] = workspace.results().root_axes[0];
  }
  expectNear(motions[0].q[0], motions[1].q[0]);
  expectNear(motions[0].qd[0], motions[1].qd[0]);
  expectNear(motions[0].qdd[0], motions[1].qdd[0]);
  ASSERT_GT(std::abs(efforts[0]), 100);
  expectNear(efforts[0], efforts[1]);
  expectForce(pins[0].force, pins[1].force, 1e-10);
}

// Certificates count the power of rams that are driven, and Lagrange's equations find nothing left
// over at the passive pins.
TEST(DrivenMechanisms, PowerThatDrivesFeedInIsCounted) {
  const DrivenRams rams(7);
  const Mechanism& mechanism = *rams.mechanism;
  const Dynamics dynamics(mechanism, rams.scene, Certifier::extended({}));
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Drives drives(mechanism, rams.scene);
  PassiveJoints passive(mechanism, dynamics);
  Motion motion(2), driven(2);
  ASSERT_FALSE(drives.evaluate(0.6, dynamics.given(), motion, driven));
  ASSERT_TRUE(passive.complete(motion, driven, dynamics, workspace));
  dynamics.compute(motion, workspace);
  const Results& results = workspace.results();
  // The power of the rams is that of motors in the pins of an open chain.
  const InverseDynamics tree(mechanism, Scene(), Request());
  virtual_work_dynamics::Workspace open = tree.makeWorkspace();
  tree.compute(motion, open);
  const double power = open.effort().dot(motion.qd);
  ASSERT_GT(std::abs(power), 1);
  expectNear(results.effort.tail<2>().dot(driven.qd), power, kOtherRoute);
  Load load;
  dynamics.getTreeLoad(results, load);
  Certifier certifier(mechanism, dynamics.tree());
  const Certificates certificates =
      certifier.check(motion, load, results.treeEffort(2), results.child_axes.back());
  EXPECT_LT(certificates.largest(), 1e-14);
  Load without = load;
  without.wrenches.back().force *= 0.99;
  EXPECT_GT(
      certifier.check(motion, without, results.treeEffort(2), results.child_axes.back()).largest(),
      1e-5);
  LagrangeDynamics<long double> lagrange(mechanism, dynamics.tree(), {});
  lagrange.compute(motion, load);
  EXPECT_NEAR(lagrange.effort()[0], 0, 1e-9);
  EXPECT_NEAR(lagrange.effort()[1], 0, 1e-9);
}

// A drive in place of an actuator changes nothing but where the motion comes from.
TEST(DrivenMechanisms, CountAsActuators) {
  RandomLoops loops(11, true);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const Case random = loops.next();
    if (!random.scene.actuated || random.scene.actuated->empty()) continue;
    Scene driven = random.scene;
    DriveLaw law;
    law.name = driven.actuated->back();
    law.coefficients = {{0.1, 1}};
    driven.actuated->pop_back();
    driven.drives = {law};
    driven.given.reset();
    Request request;
    request.child_axes = request.root_axes = NamedLoopResults::namesOf(random.mechanism, driven);
    try {
      ClosedLoops before(random.mechanism, random.scene, request);
      ClosedLoops with_drive(random.mechanism, driven, request);
      before.compute(random.motion);
      with_drive.compute(random.motion);
      ASSERT_EQ(before.effort(), with_drive.effort());
      for (std::size_t k = 0; k < request.root_axes.size(); ++k) {
        ASSERT_EQ(before.rootAxes()[k].force, with_drive.rootAxes()[k].force);
        ASSERT_EQ(before.rootAxes()[k].torque, with_drive.rootAxes()[k].torque);
      }
      ASSERT_EQ(before.effortDetermined(), with_drive.effortDetermined());
      ++compared;
    } catch (const SceneError&) {
      EXPECT_THROW(ClosedLoops(random.mechanism, driven, request), SceneError);
    }
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace virtual_work_dynamics
