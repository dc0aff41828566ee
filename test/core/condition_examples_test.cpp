#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "loop_examples.h"
#include "touching_bodies.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms against a factorization, relative to the largest force.
constexpr double kClosedForm = 1e-11;

// The motion of scripts/example_motions.py: along an arc of 1.2 m and back, while the arm swings.
Positions drivingAndReaching(long double t) {
  const long double w = kPi / 4, yaw = 0.75L * (1 - std::cos(w * t));
  return {{"base_x", 1.2L * std::sin(yaw)},
          {"base_y", 1.2L * (1 - std::cos(yaw))},
          {"base_yaw", yaw},
          {"left_wheel", 1.0L / 0.08L * yaw},
          {"right_wheel", 1.4L / 0.08L * yaw},
          {"pan", 1.2L * std::sin(2 * w * t)},
          {"shoulder", -0.9L + 0.4L * std::sin(w * t + 1)},
          {"elbow", 1.4L + 0.6L * std::sin(2 * w * t + 2)}};
}

// What slides, turn and axles would have to exert if the wheels did not touch the ground is what
// the ground exerts at the treads, 0.2 m to both sides: two forces along, and one across.
TEST(ConditionExamples, WheelsOfTheManipulatorDriveItAndHoldItSideways) {
  const LoopExample example("mobile_manipulator");
  Scene on_slides = example.scene;
  on_slides.closures.clear();
  on_slides.actuated.reset();
  const InverseDynamics tree(example.mechanism, on_slides, Request());
  Workspace slides = tree.makeWorkspace();
  for (const long double t : {0.0L, 1.3L, 2.6L, 5.1L}) {
    SCOPED_TRACE(static_cast<double>(t));
    const Motion motion = motionAt(example.mechanism, drivingAndReaching, t);
    const NamedLoopResults found(example.mechanism, example.scene, motion);
    EXPECT_LE(violation(found), 1e-11);
    tree.compute(motion, slides);
    const auto at = [&](const char* name) { return example.mechanism.coordinateIndex(name); };
    const Eigen::VectorXd& held = slides.effort();
    const double yaw = motion.q[at("base_yaw")], c = std::cos(yaw), s = std::sin(yaw);
    const double along = c * held[at("base_x")] + s * held[at("base_y")];
    const double across = -s * held[at("base_x")] + c * held[at("base_y")];
    const double turning = held[at("base_yaw")] / 0.2;
    const double left = (along - turning) / 2, right = (along + turning) / 2;
    const Wrench on_left = found.childAxes("left_tread"), on_right = found.childAxes("right_tread");
    const double tolerance = kClosedForm * 300;  // the weight, N
    EXPECT_NEAR(on_left.force.x(), left, tolerance);
    EXPECT_NEAR(on_right.force.x(), right, tolerance);
    EXPECT_NEAR(on_left.force.y() + on_right.force.y(), across, tolerance);
    EXPECT_NEAR(found.effort("left_wheel"), held[at("left_wheel")] + 0.08 * left, tolerance);
    EXPECT_NEAR(found.effort("right_wheel"), held[at("right_wheel")] + 0.08 * right, tolerance);
    for (const char* joint : {"pan", "shoulder", "elbow"}) {
      EXPECT_NEAR(found.effort(joint), held[at(joint)], tolerance) << joint;
      EXPECT_TRUE(found.effortDetermined(joint)) << joint;
    }
    for (const char* side : {"left", "right"}) {
      EXPECT_TRUE(found.effortDetermined(side + std::string("_wheel"))) << side;
      const Determined& determined = found.childAxesDetermined(side + std::string("_tread"));
      EXPECT_TRUE(determined[0]) << side;
      EXPECT_FALSE(determined[1]) << side;
    }
    EXPECT_EQ(found.dynamics().determinacy().redundant_constraints, 1);
  }
}

// A disc that leans by b inwards, its contact on a circle of 2 m, once around it at a rate.
struct SteadyTurn {
  static constexpr double b = 0.3, r = 0.5, circle = 2, m = 3, across = 0.1875, about = 0.375;
  static constexpr double g = 9.81;
  const double centre = circle - r * std::sin(b);
  const double fall = m * g * r * std::sin(b);  // about the contact, N m
  const double free = std::sqrt(fall / (m * r * centre * std::cos(b) +
                                        about * std::cos(b) * (circle / r - std::sin(b)) +
                                        across * std::sin(b) * std::cos(b)));

  Motion motion(const Mechanism& mechanism, double rate, long double heading) const {
    const auto turning = [&](long double t) -> Positions {
      const long double angle = heading + rate * t;
      return {{"disc_x", centre * std::sin(angle)},
              {"disc_y", -centre * std::cos(angle)},
              {"disc_z", r * std::cos(static_cast<long double>(b))},
              {"heading", angle},
              {"lean", b},
              {"spin", circle / r * angle}};
    };
    return motionAt(mechanism, turning, 0);
  }
};

TEST(ConditionExamples, TheDiscRollsAsNothingDrivesIt) {
  const LoopExample example("rolling_disc");
  const SteadyTurn disc;
  EXPECT_NEAR(disc.free, 1.0382156746, 5e-11);
  for (const long double heading : {0.0L, 1.7L, 3.9L}) {
    SCOPED_TRACE(static_cast<double>(heading));
    const Motion motion = disc.motion(example.mechanism, disc.free, heading);
    const NamedLoopResults found(example.mechanism, example.scene, motion);
    EXPECT_LE(violation(found), 1e-12);
    // Inwards, which is the side of its axle.
    expectForce({0, 5.98954252, 29.43}, found.childAxes("rim").force, 5e-9);
    for (const char* angle : {"heading", "lean", "spin"}) {
      EXPECT_NEAR(found.effort(angle), 0, kClosedForm) << angle;
      EXPECT_TRUE(found.effortDetermined(angle)) << angle;
    }
    // What is too fast would have to be pushed down.
    const Motion faster = disc.motion(example.mechanism, 1.1 * disc.free, heading);
    const NamedLoopResults pushed(example.mechanism, example.scene, faster);
    EXPECT_NEAR(pushed.effort("lean"), 0.21 * disc.fall, kClosedForm);
    EXPECT_NEAR(pushed.effort("heading"), 0, kClosedForm);
    EXPECT_NEAR(pushed.effort("spin"), 0, kClosedForm);
  }
}

// Sideways it needs 0.2035 times what presses.
TEST(ConditionExamples, TheDiscIsHeldByFriction) {
  LoopExample example("rolling_disc");
  const SteadyTurn disc;
  const Motion motion = disc.motion(example.mechanism, disc.free, 0.6L);
  for (const auto& [friction, expected] :
       {std::pair{0.4, Hold::kHolds}, {0.204, Hold::kHolds}, {0.203, Hold::kOutsideCone}}) {
    example.scene.closures.at(0).touch.friction = friction;
    const ClosedLoopDynamics dynamics(example.mechanism, example.scene, {});
    ASSERT_EQ(dynamics.oneSided(), std::vector<std::string>{"rim"});
    ClosedLoopDynamics::Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, workspace);
    EXPECT_EQ(workspace.results().loops.holds.at(0), expected) << friction;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
