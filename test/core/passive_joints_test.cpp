#include "virtual_work_dynamics/passive_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "closed_loops.h"
#include "loop_examples.h"
#include "moving_roots.h"
#include "robot_builder.h"
#include "slider_crank.h"

namespace virtual_work_dynamics {
namespace {

// Newton's method ends at rounding errors of lengths of a metre.
constexpr double kClosed = 1e-12;
constexpr double kTurn = 6.283185307179586;
const Request kNothing{false, {}, {}, false, false};

/// A slider-crank that is followed from its assembly at 0.7 rad.
class FollowedSliderCrank : public testing::Test {
 protected:
  FollowedSliderCrank()
      : mechanism_(slider_crank_.mechanism()),
        dynamics_(mechanism_, slider_crank_.scene("joint_1"), kNothing),
        workspace_(dynamics_.makeWorkspace()),
        passive_(mechanism_, dynamics_) {}

  void expectFollowed(double angle, double rate, double acceleration) {
    const Motion expected = SliderCrank::motion(angle, rate, acceleration);
    Motion motion(3);
    motion.q[0] = expected.q[0];
    motion.qd[0] = expected.qd[0];
    motion.qdd[0] = expected.qdd[0];
    ASSERT_TRUE(passive_.complete(motion, dynamics_, workspace_)) << angle;
    EXPECT_EQ(motion.q[0], angle);
    EXPECT_NEAR(std::remainder(motion.q[1] - expected.q[1], kTurn), 0, kClosed) << angle;
    EXPECT_NEAR(motion.q[2], expected.q[2], kClosed) << angle;
    EXPECT_LE((motion.qd - expected.qd).norm(), kClosed) << angle;
    EXPECT_LE((motion.qdd - expected.qdd).norm(), kClosed) << angle;
  }

  SliderCrank slider_crank_;
  Mechanism mechanism_;
  Dynamics dynamics_;
  Dynamics::Workspace workspace_;
  PassiveJoints passive_;
};

TEST_F(FollowedSliderCrank, KeepsItsBranchOverGapsAndTurns) {
  for (const double angle : {0.7, 2.5, -2.5, 0.1, 3.1, -0.1, 1.0 + 100 * kTurn, 1.1}) {
    expectFollowed(angle, 1.5, -0.7);
  }
}

// The joints close the loops, wherever the root carries them.
TEST_F(FollowedSliderCrank, LeavesTheRootsMotionAsItIs) {
  std::mt19937 generator(4);
  Motion motion = SliderCrank::motion(0.7, 1, 2);
  motion.root = randomRootMotion(generator);
  const RootMotion root = motion.root;
  ASSERT_TRUE(passive_.complete(motion, dynamics_, workspace_));
  EXPECT_EQ(motion.root.position, root.position);
  EXPECT_EQ(motion.root.orientation.coeffs(), root.orientation.coeffs());
  EXPECT_EQ(motion.root.angular_acceleration, root.angular_acceleration);
  EXPECT_EQ(motion.root.acceleration, root.acceleration);
}

TEST_F(FollowedSliderCrank, IsWhereItWasAfterAFailure) {
  const Dynamics by_slider(mechanism_, slider_crank_.scene("joint_3"), kNothing);
  Dynamics::Workspace workspace = by_slider.makeWorkspace();
  PassiveJoints passive(mechanism_, by_slider);
  const Eigen::VectorXd before = passive.position();
  Motion motion(3);
  motion.q[2] = 1.01 * (SliderCrank::kCrank + SliderCrank::kRod);
  EXPECT_FALSE(passive.complete(motion, by_slider, workspace));
  EXPECT_EQ(passive.position(), before);
}

// A stream of positions out of reach must not hold up what comes behind it.
TEST_F(FollowedSliderCrank, GivesUpSoon) {
  const Dynamics by_slider(mechanism_, slider_crank_.scene("joint_3"), kNothing);
  Dynamics::Workspace workspace = by_slider.makeWorkspace();
  PassiveJoints passive(mechanism_, by_slider);
  const double reach = SliderCrank::kCrank + SliderCrank::kRod;
  Motion motion(3);
  for (const double beyond : {1e-6, 1e-3, 0.1, 1.0, 100.0}) {
    motion.q[2] = reach + beyond;
    EXPECT_FALSE(passive.complete(motion, by_slider, workspace)) << beyond;
    EXPECT_GT(passive.searches(), 1);
    EXPECT_LE(passive.searches(), 40) << beyond;
  }
  const Motion expected = SliderCrank::motion(0.6, 0, 0);
  motion.q[2] = expected.q[2];
  ASSERT_TRUE(passive.complete(motion, by_slider, workspace));
  EXPECT_EQ(passive.searches(), 1);
  EXPECT_NEAR(motion.q[0], 0.6, kClosed);
}

// These ways are long enough to be halved.
TEST_F(FollowedSliderCrank, SearchesNoMoreThanItSays) {
  for (const double angle : {3.8, 0.7, 3.8, 1.0}) {
    expectFollowed(angle, 0, 0);
    EXPECT_GT(passive_.searches(), 10);
    EXPECT_LE(passive_.searches(), PassiveJoints::kMostSearches);
  }
}

TEST_F(FollowedSliderCrank, GoesOnFromWhereItIsMovedTo) {
  // The other branch of a slider that is given: the crank below its way.
  const Dynamics by_slider(mechanism_, slider_crank_.scene("joint_3"), kNothing);
  Dynamics::Workspace workspace = by_slider.makeWorkspace();
  PassiveJoints passive(mechanism_, by_slider);
  passive.moveTo(SliderCrank::motion(-1.2, 0, 0).q);
  const Motion expected = SliderCrank::motion(-1.1, 0, 0);
  Motion motion(3);
  motion.q[2] = expected.q[2];
  ASSERT_TRUE(passive.complete(motion, by_slider, workspace));
  EXPECT_NEAR(motion.q[0], -1.1, kClosed);
}

// The completed motion needs no second search, as the workspace is at its position.
TEST_F(FollowedSliderCrank, LeavesTheWorkspaceAtItsPosition) {
  Motion motion(3);
  motion.q[0] = 1.1;
  motion.qd[0] = 2;
  ASSERT_TRUE(passive_.complete(motion, dynamics_, workspace_));
  EXPECT_EQ(passive_.position(), motion.q);
  dynamics_.compute(motion, workspace_);
  EXPECT_LE(workspace_.results().loops.residuals[0].position, kClosed);
  EXPECT_LE(workspace_.results().loops.residuals[0].acceleration, kClosed);
}

TEST(PassiveJoints, AnOpenChainPassesAtOnce) {
  RobotBuilder builder = chainOf(3);
  const Mechanism mechanism = builder.build();
  const Dynamics dynamics(mechanism, Scene());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  PassiveJoints passive(mechanism, dynamics);
  for (const Motion& motion : builder.motions(3)) {
    Motion completed = motion;
    EXPECT_TRUE(passive.complete(completed, dynamics, workspace));
    EXPECT_EQ(completed.q, motion.q);
    EXPECT_EQ(completed.qd, motion.qd);
    EXPECT_EQ(completed.qdd, motion.qdd);
    EXPECT_EQ(passive.searches(), 0);
  }
}

TEST(ActuatedClosures, SayHowFarTheyHaveTurned) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  ClosedLoops dynamics(mechanism, slider_crank.scene("pin"));
  const Motion motion = SliderCrank::motion(2.0, 1.5, 0);
  dynamics.compute(motion);
  // The slider, its child, does not turn; the rod does.
  EXPECT_NEAR(dynamics.actuatedPositions()[0], -(motion.q[0] + motion.q[1]), kClosed);
  EXPECT_NEAR(dynamics.actuatedVelocities()[0], -(motion.qd[0] + motion.qd[1]), kClosed);
}

TEST(ActuatedClosures, SayHowFarTheyHaveSlid) {
  // A slider-crank with a pin as third joint and the slide as closure, on a table that turns.
  const Mechanism mechanism = sliderCrankOfPins(true);
  Scene scene;
  scene.closures = {slideOfPins(true)};
  scene.actuated = std::vector<std::string>{"joint_1", "slide"};
  const Motion crank = SliderCrank::motion(2.0, 1.5, 0);
  Motion motion(4);
  motion.q << 0.3, crank.q[0], crank.q[1], -(crank.q[0] + crank.q[1]);
  motion.qd << 0.9, crank.qd[0], crank.qd[1], -(crank.qd[0] + crank.qd[1]);
  for (int i = 0; i < 4; ++i) {
    scene.assembly.push_back({"joint_" + std::to_string(i + 1), motion.q[i]});
  }
  ClosedLoops dynamics(mechanism, scene);
  dynamics.compute(motion);
  EXPECT_NEAR(dynamics.actuatedPositions()[0], crank.q[2] - 0.2, kClosed);
  EXPECT_NEAR(dynamics.actuatedVelocities()[0], crank.qd[2], kClosed);
}

/// How the actuated joints of an example move.
struct Driving {
  const char* name;
  double noise;   // of positions, rad
  double period;  // s
  double factor;  // of velocities that a driver gets wrong
};

// A search begins where rates and accelerations lead. What it finds is what one finds that knows of
// no motion, whatever a driver says of the rates and however far the steps.
TEST(PassiveJoints, FindTheSameWhateverTheRates) {
  constexpr Driving kDrivings[] = {{"clean", 0, 1e-3, 1},       {"noise", 1e-3, 1e-3, 1},
                                   {"slow", 0, 0.1, 1},         {"zero rates", 1e-4, 1e-2, 0},
                                   {"deg/s", 1e-4, 1e-2, 57.3}, {"reversed", 1e-4, 1e-2, -1}};
  RobotBuilder random(7);
  for (const char* name : {"four_bar", "slider_crank", "stewart_gough", "andrews_squeezer"}) {
    const LoopExample example(name);
    const Dynamics dynamics(example.mechanism, example.scene, kNothing);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    for (const Driving& driving : kDrivings) {
      PassiveJoints led(example.mechanism, dynamics), fresh(example.mechanism, dynamics);
      for (int k = 0; k < 100; ++k) {
        const double t = k * driving.period;
        Motion motion(dynamics.coordinates());
        motion.q = dynamics.assembly();
        for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
          if (!dynamics.actuated()[static_cast<std::size_t>(i)]) continue;
          motion.q[i] += 0.15 * std::sin(5 * t) + random.uniform(-driving.noise, driving.noise);
          motion.qd[i] = driving.factor * 0.75 * std::cos(5 * t);
          motion.qdd[i] = -3.75 * std::sin(5 * t);
        }
        Motion other = motion;
        fresh.moveTo(Eigen::VectorXd(fresh.position()));
        ASSERT_TRUE(led.complete(motion, dynamics, workspace)) << name << ", " << driving.name;
        ASSERT_TRUE(fresh.complete(other, dynamics, workspace)) << name << ", " << driving.name;
        EXPECT_LE((motion.q - other.q).norm(), kClosed) << name << ", " << driving.name;
      }
    }
  }
}

/// A bar on equal parallel cranks, driven at the first. Twice a turn all lie in one line.
Mechanism barOnCranks(int cranks, double length, Scene& scene) {
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  const Vector3l z = Vector3l::UnitZ();
  builder.add(JointType::kContinuous, 0, z, R, Vector3l::Zero());
  builder.add(JointType::kContinuous, 1, z, R, Vector3l(length, 0, 0));
  for (int i = 1; i < cranks; ++i) {
    builder.add(JointType::kContinuous, 0, z, R, Vector3l(i, 0, 0));
    Closure pin;
    pin.name = "pin_" + std::to_string(i);
    pin.type = ClosureType::kRevolute;
    pin.parent.link = "link_" + std::to_string(i + 2);
    pin.parent.xyz << length, 0, 0;
    pin.child.link = "link_2";
    pin.child.xyz << i, 0, 0;
    scene.closures.push_back(pin);
  }
  scene.actuated = std::vector<std::string>{"joint_1"};
  return builder.build();
}

// Beyond the line, the position that Newton's method leads to has the other cranks turn back, which
// three of them cannot: the way goes on as it came.
TEST(PassiveJoints, OfThreeEqualCranksPassTheLineInWhichAllLie) {
  for (const double step : {0.2, -0.17, 0.4}) {
    Scene scene;
    const Mechanism mechanism = barOnCranks(3, 0.25, scene);
    scene.assembly = {{"joint_1", 1}, {"joint_2", -1}, {"joint_3", 1}, {"joint_4", 1}};
    const Dynamics dynamics(mechanism, scene, kNothing);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    PassiveJoints passive(mechanism, dynamics);
    for (int i = 1; i <= 60; ++i) {
      const double angle = 1 + step * i;
      Motion motion(4);
      motion.q[0] = angle;
      motion.qd[0] = 1;
      ASSERT_TRUE(passive.complete(motion, dynamics, workspace)) << angle;
      EXPECT_LE((motion.q - Eigen::Vector4d(angle, -angle, angle, angle)).norm(), 1e-9) << angle;
      EXPECT_LE((motion.qd - Eigen::Vector4d(1, -1, 1, 1)).norm(), 1e-6) << angle;
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
