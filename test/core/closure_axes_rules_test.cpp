#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "touching_bodies.h"
#include "virtual_work_dynamics/closure_axes.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// A factorization of a slider-crank against closed forms and against another one.
constexpr double kSlid = 1e-11;

// A slider with a mass, a rod and a crank on it, whose pin on the root link is a closure, and a
// shaft that is geared to the pin. Rod and crank lie aside, so that their bearings are loaded.
struct GearedCrank {
  static constexpr double r = 0.1, l = 0.35, m = 3, n = 20;

  GearedCrank() {
    const int slider = bodies.slide(0, bodies.x());
    bodies.load(slider, m, {0.01, 0.01, 0.01}, {0, 0.02, 0.05});
    const int rod = bodies.turn(slider, bodies.z());
    bodies.load(rod, 0.4, {1e-3, 1e-3, 1e-3}, {-0.1, 0, 0.03});
    bodies.turn(rod, bodies.z(), {-l, 0, 0});
    bodies.turn(0, bodies.z(), {0, 1, 0});
    mechanism = bodies.build();
  }

  static std::string closures() {
    return "closures: [{name: pin, type: revolute, parent: {link: link_0}, child: {link: link_3, "
           "xyz: [-0.1, 0, 0]}}]\n";
  }
  // Where the crank is at an angle.
  static std::string assemblyAt(double angle) {
    const double rod = rodAt(angle);
    std::ostringstream text;
    text.precision(17);
    text << "assembly: [{name: joint_1, position: " << slideAt(angle)
         << "}, {name: joint_2, position: " << rod << "}, {name: joint_3, position: " << angle - rod
         << "}]\n";
    return text.str();
  }
  static std::string gear(const std::string& more) {
    return "couplings: [{name: gear, terms: [{name: joint_4, factor: 1}, {name: pin, factor: "
           "-20}]" +
           more + "}]\n";
  }
  static double rodAt(double angle) { return -std::asin(r * std::sin(angle) / l); }
  static double slideAt(double angle) { return r * std::cos(angle) + l * std::cos(rodAt(angle)); }

  BodiesOnAxes bodies;
  Mechanism mechanism{"none", std::vector<Link>(1), {}};
};

// The motor that a crank is geared to, through three turns: by hand, for a slider alone.
TEST(ClosureAxesRules, WholeTurnsOfAPinAreCounted) {
  BodiesOnAxes bodies;
  const int slider = bodies.slide(0, bodies.x());
  bodies.load(slider, GearedCrank::m, {0.01, 0.01, 0.01});
  bodies.turn(bodies.turn(slider, bodies.z()), bodies.z(), {-GearedCrank::l, 0, 0});
  bodies.turn(0, bodies.z(), {0, 1, 0});
  const double start = 0.5, rate = 3;
  const Scene scene =
      sceneOf(GearedCrank::closures() + GearedCrank::assemblyAt(start) +
              GearedCrank::gear(", offset: 1.5") + "actuated: [joint_4]\ngiven: [pin]\n");
  const SceneOfMechanism robot = withClosureAxes(bodies.build(), scene);
  ClosedLoops dynamics(robot.mechanism, robot.scene);
  const Eigen::Index pin = robot.mechanism.coordinateIndex("pin");
  const Eigen::Index motor = robot.mechanism.coordinateIndex("joint_4");
  const Eigen::Index slide = robot.mechanism.coordinateIndex("joint_1");
  EXPECT_NEAR(dynamics.assembly()[pin], start, kSlid);
  std::vector<bool> given(5, false);
  given[static_cast<std::size_t>(pin)] = true;
  Motion motion(5);
  motion.q = dynamics.assembly();
  for (double angle = start; angle < 20; angle += 0.25) {
    motion.q[pin] = angle;
    motion.qd[pin] = rate;
    motion.qdd[pin] = 0;
    ASSERT_TRUE(dynamics.complete(motion, given)) << angle;
    dynamics.compute(motion);
    EXPECT_NEAR(motion.q[motor], GearedCrank::n * angle + 1.5, 1e-9) << angle;
    EXPECT_NEAR(motion.q[slide], GearedCrank::slideAt(angle), kSlid) << angle;
    // x = r cos + l root(1 - (r sin / l)^2), its derivatives by the angle.
    const double r = GearedCrank::r, l = GearedCrank::l;
    const double s = std::sin(angle), c = std::cos(angle), root = std::sqrt(l * l - r * r * s * s);
    const double x1 = -r * s - r * r * s * c / root;
    const double x2 =
        -r * c - r * r * (c * c - s * s) / root - std::pow(r * r * s * c, 2) / std::pow(root, 3);
    const double torque = GearedCrank::m * x2 * rate * rate * x1 / GearedCrank::n;
    EXPECT_NEAR(dynamics.effort()[motor], torque, kSlid) << angle;
    EXPECT_EQ(dynamics.effort()[pin], 0);
    EXPECT_NEAR(dynamics.effort()[5], -torque, kSlid) << angle;  // of the gear
  }
}

// The motion of the slider from the assembly, with others that are given at rest.
Motion slidingMotion(const SceneOfMechanism& robot, const std::vector<std::string>& names) {
  ClosedLoops dynamics(robot.mechanism, robot.scene);
  const std::size_t count = robot.mechanism.coordinates().size();
  std::vector<bool> given(count, false);
  for (const std::string& name : names) {
    given[static_cast<std::size_t>(robot.mechanism.coordinateIndex(name))] = true;
  }
  Motion motion(static_cast<Eigen::Index>(count));
  motion.q = dynamics.assembly();
  const Eigen::Index slide = robot.mechanism.coordinateIndex("joint_1");
  motion.qd[slide] = 0.3;
  motion.qdd[slide] = -1.1;
  EXPECT_TRUE(dynamics.complete(motion, given));
  return motion;
}

// A gear to a shaft that nothing turns changes nothing, whichever forces are chosen where the loop
// does not determine them.
TEST(ClosureAxesRules, ChoicesOfForcesAreThoseOfTheClosure) {
  const GearedCrank crank;
  const std::string drive = GearedCrank::closures() + GearedCrank::assemblyAt(0.7) +
                            "actuated: [joint_1]\ngiven: [joint_1]\n";
  for (const std::string policy :
       {"", "redundancy: {policy: zero_at, zero_at: [pin]}",
        "redundancy: {policy: stiffness, stiffness: [{name: joint_3, stiffness: 2}]}",
        "redundancy: {policy: stiffness, stiffness: [{name: pin, stiffness: 3}, {name: joint_2, "
        "stiffness: 0.5}]}"}) {
    const SceneOfMechanism without{crank.mechanism,
                                   sceneOf(GearedCrank::closures() + GearedCrank::assemblyAt(0.7) +
                                           "actuated: [joint_1, joint_4]\n" + policy)};
    const SceneOfMechanism with =
        withClosureAxes(crank.mechanism, sceneOf(drive + GearedCrank::gear("") + policy));
    const Motion plain = slidingMotion(without, {"joint_1", "joint_4"});
    const Motion geared = slidingMotion(with, {"joint_1"});
    const NamedLoopResults a(without.mechanism, without.scene, plain);
    const NamedLoopResults b(with.mechanism, with.scene, geared);
    EXPECT_FALSE(a.rootAxesDetermined("pin")[2]) << policy;
    for (const char* name : {"joint_1", "joint_2", "joint_3", "pin"}) {
      const Wrench &x = a.rootAxes(name), &y = b.rootAxes(name);
      expectForce(x.force, y.force, kSlid);
      expectForce(x.torque, y.torque, kSlid);
      EXPECT_EQ(a.rootAxesDetermined(name), b.rootAxesDetermined(name)) << name << policy;
    }
    EXPECT_NEAR(a.effort("joint_1"), b.effort("joint_1"), kSlid);
  }
}

TEST(ClosureAxesRules, NamesOfTheSceneHoldForTheJoint) {
  using Names = std::vector<std::string>;
  const GearedCrank crank;
  const auto with = [&](const std::string& more) {
    return withClosureAxes(crank.mechanism, sceneOf(GearedCrank::closures() + more)).scene;
  };
  const Scene as_is = with("actuated: [joint_1, pin]");
  EXPECT_EQ(as_is.closures[0].name, "pin");
  const Scene plain = with(GearedCrank::gear(""));
  EXPECT_EQ(plain.closures[0].name, "pin.fixed");
  EXPECT_EQ(plain.closures[0].type, ClosureType::kFixed);
  EXPECT_EQ(plain.actuated, Names({"joint_1", "joint_2", "joint_3", "joint_4"}));
  EXPECT_FALSE(plain.given.has_value());  // the actuated ones, as always
  EXPECT_EQ(plain.reaction_names, Names({"joint_1", "joint_2", "joint_3", "joint_4", "pin"}));
  const Scene driven = with(GearedCrank::gear("") + "actuated: [joint_1, pin]");
  EXPECT_EQ(driven.actuated, Names({"joint_1", "pin"}));
  EXPECT_EQ(driven.given, Names({"joint_1"}));
  EXPECT_FALSE(with(GearedCrank::gear("") + "actuated: [pin]").given.has_value());
  EXPECT_FALSE(with(GearedCrank::gear(", rate_only: true") + "actuated: [joint_1, pin]").given);
  EXPECT_EQ(with(GearedCrank::gear("") + "actuated: []\ngiven: [pin]").given, Names({"pin"}));
  EXPECT_EQ(with(GearedCrank::gear("") + "redundancy: {policy: zero_at, zero_at: [pin]}")
                .redundancy.zero_at,
            Names({"pin.fixed"}));
}

// What is actuated, and what motions then give, of a crank as withClosureAxes() makes it.
std::vector<std::string> givenNames(const std::string& more) {
  const GearedCrank crank;
  const SceneOfMechanism robot =
      withClosureAxes(crank.mechanism, sceneOf(GearedCrank::closures() + GearedCrank::gear("") +
                                               GearedCrank::assemblyAt(0.7) + more));
  const Dynamics dynamics(robot.mechanism, robot.scene, Request());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robot.mechanism.coordinates().size(); ++i) {
    if (dynamics.given().coordinates[i]) names.push_back(robot.mechanism.coordinateNames()[i]);
  }
  return names;
}

TEST(ClosureAxesRules, GivenIsWhatIsActuatedOrDriven) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(givenNames("actuated: [pin]"), Names({"pin"}));
  EXPECT_EQ(givenNames("actuated: [joint_1]"), Names({"joint_1"}));
  EXPECT_EQ(givenNames("actuated: [joint_1]\ndrives: [{name: joint_1, law: polynomial, "
                       "coefficients: [0, 1]}]"),
            Names({"joint_1"}));
  EXPECT_EQ(givenNames("actuated: [joint_1, pin]\ndrives: [{name: joint_1, law: polynomial, "
                       "coefficients: [0, 1]}]"),
            Names({"joint_1"}));
}

// Whatever closures are called: the rest of a free axis is what was made of it.
TEST(ClosureAxesRules, AxesAreFoundByWhatWasMade) {
  const GearedCrank crank;
  const SceneOfMechanism robot =
      withClosureAxes(crank.mechanism, sceneOf(GearedCrank::closures() + GearedCrank::gear("")));
  EXPECT_EQ(axisOfClosure(robot.mechanism, robot.scene, robot.scene.closures[0]), "pin");
  const Scene own = sceneOf(
      "closures: [{name: link_3.fixed, type: fixed, parent: {link: link_3}, child: {link: "
      "link_0}}]\ncouplings: [{name: gear, terms: [{name: joint_3, factor: 1}, {name: joint_4, "
      "factor: 2}]}]");
  EXPECT_EQ(axisOfClosure(crank.mechanism, own, own.closures[0]), "");
}

std::string refusalOf(const Mechanism& mechanism, const std::string& text, bool directly = false) {
  try {
    const Scene scene = sceneOf(text);
    if (directly) {
      ClosedLoops dynamics(mechanism, scene);
    } else {
      withClosureAxes(mechanism, scene);
    }
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(ClosureAxesRules, WhatHasNotOneAxisIsRefused) {
  const GearedCrank crank;
  EXPECT_EQ(refusalOf(crank.mechanism, GearedCrank::closures() + GearedCrank::gear("")), "");
  EXPECT_EQ(refusalOf(crank.mechanism, GearedCrank::closures() + GearedCrank::gear(""), true),
            "couplings: 'gear': 'pin' is a closure, withClosureAxes() makes its free axis a "
            "coordinate");
  EXPECT_EQ(refusalOf(crank.mechanism,
                      "closures: [{name: pin, type: spherical, parent: {link: link_0}, child: "
                      "{link: link_3, xyz: [-0.1, 0, 0]}}]\n" +
                          GearedCrank::gear("")),
            "couplings: 'gear': closure 'pin' is neither revolute nor prismatic");
  EXPECT_EQ(refusalOf(crank.mechanism,
                      "cylinders: [{name: pin, link_a: link_0, at_a: [0, 0.3, 0], link_b: link_3, "
                      "at_b: [-0.1, 0, 0]}]\n" +
                          GearedCrank::gear("")),
            "couplings: 'gear': closure 'pin' is neither revolute nor prismatic");
  EXPECT_EQ(refusalOf(crank.mechanism,
                      "closures: [{name: link_2, type: revolute, parent: {link: link_0}, child: "
                      "{link: link_3, xyz: [-0.1, 0, 0]}}]\n"
                      "couplings: [{name: gear, terms: [{name: link_2, factor: 1}, {name: "
                      "joint_4, factor: 2}]}]"),
            "closures: 'link_2' is also the name of a link; a closure that couplings name needs "
            "another name");
}

}  // namespace
}  // namespace virtual_work_dynamics
