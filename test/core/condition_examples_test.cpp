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

// The biped: left hip and waist are given, the rest follows from the soles, which stand where
// legs of 0.85 m reach that are spread by 0.12 rad at hips 0.1 m to both sides.
struct Standing {
  explicit Standing(const std::string& name)
      : example("biped"),
        scene(readSceneFile(std::string(kSourceFolder) + "/config/" + name + "_scene.yaml")) {}

  Eigen::Index at(const char* name) const { return example.mechanism.coordinateIndex(name); }
  Motion motion(double hip, double waist, double hip_rate, double waist_rate) const {
    Motion motion(8);
    motion.q[at("left_hip")] = hip;
    motion.q[at("waist")] = waist;
    motion.qd[at("left_hip")] = hip_rate;
    motion.qd[at("waist")] = waist_rate;
    motion.qdd[at("left_hip")] = -0.4;
    motion.qdd[at("waist")] = 0.7;
    ClosedLoops loops(example.mechanism, scene);
    std::vector<bool> given(8, false);
    given[static_cast<std::size_t>(at("left_hip"))] = true;
    given[static_cast<std::size_t>(at("waist"))] = true;
    EXPECT_TRUE(loops.complete(motion, given));
    return motion;
  }

  LoopExample example;
  Scene scene;
};

// Of the ground on each sole, from what would have to hold the pelvis if there were no ground.
struct SoleForces {
  SoleForces(const Standing& of, const Motion& motion) {
    Scene held;
    held.gravity = of.scene.gravity;
    const InverseDynamics tree(of.example.mechanism, held, Request());
    Workspace workspace = tree.makeWorkspace();
    tree.compute(motion, workspace);
    const auto effort = [&](const char* name) { return workspace.effort()[of.at(name)]; };
    const auto q = [&](const char* name) { return motion.q[of.at(name)]; };
    along = effort("pelvis_y");
    const double both = effort("pelvis_z");
    // Moments about the pelvis: (sole - y) left + (-sole - y) right + z along.
    const double sole = 0.1 + 0.85 * std::sin(0.12);
    const double moment = effort("pelvis_roll") - q("pelvis_z") * along + q("pelvis_y") * both;
    left = (both + moment / sole) / 2;
    right = (both - moment / sole) / 2;
    // About the right hip, which gives way.
    const double y = q("pelvis_y") - 0.1 * std::cos(q("pelvis_roll"));
    const double z = q("pelvis_z") - 0.1 * std::sin(q("pelvis_roll"));
    along_right = (effort("right_hip") - (-sole - y) * right) / z;
  }
  double left, right, along, along_right;
};

TEST(ConditionExamples, TheBipedSharesItsWeightAndPushesItsFeetApart) {
  const Standing both("biped"), one("biped_passive_hip");
  for (const auto& [hip, waist] : {std::pair{0.12, 0.0}, {-0.05, -0.3}, {0.3, 0.4}}) {
    SCOPED_TRACE(hip);
    const Motion motion = both.motion(hip, waist, 0.3, -0.2);
    const SoleForces expected(both, motion);
    for (const Standing* standing : {&both, &one}) {
      const NamedLoopResults found(both.example.mechanism, standing->scene, motion);
      const Wrench left = found.childAxes("left_sole"), right = found.childAxes("right_sole");
      const double tolerance = kClosedForm * 638;  // the weight, N
      EXPECT_NEAR(left.force.z(), expected.left, tolerance);
      EXPECT_NEAR(right.force.z(), expected.right, tolerance);
      EXPECT_NEAR(left.force.y() + right.force.y(), expected.along, tolerance);
      const bool determined = standing == &one;
      if (determined) {
        EXPECT_NEAR(right.force.y(), expected.along_right, tolerance);
      }
      for (const char* sole : {"left_sole", "right_sole"}) {
        EXPECT_TRUE(found.childAxesDetermined(sole)[0] && found.childAxesDetermined(sole)[2]);
        EXPECT_EQ(found.childAxesDetermined(sole)[1], determined) << sole;
      }
      EXPECT_EQ(found.effortDetermined("left_hip"), determined);
      EXPECT_TRUE(found.effortDetermined("waist"));
    }
  }
}

// At rest: upright, leaning far to the right, and farther than its feet.
TEST(ConditionExamples, TheBipedStandsAsFarAsFrictionHolds) {
  const Standing both("biped"), one("biped_passive_hip");
  const auto holdsAt = [](const Standing& standing, double hip, double waist) {
    Motion motion = standing.motion(hip, waist, 0, 0);
    motion.qd.setZero();
    motion.qdd.setZero();
    // Shares of the cone of the left sole; not there where it would have to pull.
    const SoleForces expected(standing, motion);
    const double share = (expected.along - expected.along_right) / (0.2 * expected.left);
    EXPECT_TRUE(hip < 0.2    ? std::abs(share) < 0.8
                : hip < 0.45 ? std::abs(share) > 1.1 && expected.left > 10
                             : expected.left < -10)
        << share << " " << expected.left;
    const NamedLoopResults found(standing.example.mechanism, standing.scene, motion);
    return found.dynamics().results().loops.holds;
  };
  using Holds = std::vector<Hold>;
  EXPECT_EQ(holdsAt(both, 0.12, 0), Holds(2, Hold::kNotDecidable));
  EXPECT_EQ(holdsAt(one, 0.12, 0), Holds(2, Hold::kHolds));
  EXPECT_EQ(holdsAt(one, 0.44, 0.68), (Holds{Hold::kOutsideCone, Hold::kHolds}));
  EXPECT_EQ(holdsAt(both, 0.5, 0.8), (Holds{Hold::kWrongWay, Hold::kNotDecidable}));
  EXPECT_EQ(holdsAt(one, 0.5, 0.8), (Holds{Hold::kWrongWay, Hold::kHolds}));
}

}  // namespace
}  // namespace virtual_work_dynamics
