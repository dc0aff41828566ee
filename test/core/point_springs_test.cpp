#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "closed_loop_results.h"
#include "robot_builder.h"
#include "slider_crank.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kTolerance = 1e-13;  // relative; a few roundings

PointSpring spring(const std::string& name, const std::string& a, const Eigen::Vector3d& at_a,
                   const std::string& b, const Eigen::Vector3d& at_b) {
  PointSpring spring;
  spring.name = name;
  spring.link_a = a;
  spring.at_a = at_a;
  spring.link_b = b;
  spring.at_b = at_b;
  spring.stiffness = 150;
  spring.rest_length = 0.2;
  return spring;
}

// Ends of a spring on a robot at rest without weight, by the pose of each joint.
Eigen::Vector3d pointOf(const ClosedLoops& dynamics, std::size_t joint, const Eigen::Vector3d& at) {
  const Pose& pose = dynamics.poses()[joint];
  return pose.position + pose.orientation * at;
}

// The efforts that hold an open chain against a spring are the derivatives of its energy.
TEST(PointSprings, OpenChainHoldsTheGradientOfTheirEnergy) {
  RobotBuilder builder = chainOf(5);
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.gravity.setZero();
  const Eigen::Vector3d at_a(0.3, -0.2, 0.1), at_b(-0.4, 0.5, 0.2);
  scene.springs = {spring("spring", "link_1", at_a, "link_4", at_b)};
  Request request;
  request.root_axes = requestedReactions(mechanism, scene);
  request.poses = true;
  ClosedLoops dynamics(mechanism, scene, request);
  Motion motion(5);
  motion.q << 0.3, -0.8, 1.4, 0.6, -0.2;
  const auto energy = [&](const Motion& at) {
    dynamics.compute(at);
    const double length = (pointOf(dynamics, 3, at_b) - pointOf(dynamics, 0, at_a)).norm();
    return 150 * (length - 0.2) * (length - 0.2) / 2;
  };
  for (Eigen::Index i = 0; i < 5; ++i) {
    // Central differences of fourth order: truncation 1e-13 of the fifth derivative, rounding
    // eps / step; 1e-9 of the largest leaves room for both.
    const double h = 1e-3;
    const auto displaced = [&](double by) {
      Motion moved = motion;
      moved.q[i] += by;
      return energy(moved);
    };
    const double slope =
        (8 * (displaced(h) - displaced(-h)) - displaced(2 * h) + displaced(-2 * h)) / (12 * h);
    dynamics.compute(motion);
    EXPECT_NEAR(dynamics.effort()[i], slope, 1e-9 * 150) << i;
  }
  EXPECT_NEAR(dynamics.effort()[0], 0, kTolerance * 150);
  EXPECT_NEAR(dynamics.effort()[4], 0, kTolerance * 150);
  EXPECT_GT(std::abs(dynamics.effort()[2]), 1);
  // The link between pulls on both alike.
  EXPECT_LE((dynamics.rootAxes()[1].force - dynamics.rootAxes()[3].force).norm(), kTolerance * 150);
  EXPECT_EQ(dynamics.determinacy().rank, 5);
  for (const bool determined : dynamics.effortDetermined()) EXPECT_TRUE(determined);
}

// At rest the crank's torque times its rate is the power of the spring between ground and slider.
TEST(PointSprings, DriveALoopByTheirPower) {
  const SliderCrank slider_crank;
  Scene scene = slider_crank.scene("joint_1");
  scene.springs = {spring("spring", "link_0", {0, 0, 0}, "link_3", {0, 0, 0})};
  const Motion rates = slider_crank.motion(0.8, 1, 0);
  Motion still = rates;
  still.qd.setZero();
  still.qdd.setZero();
  const ClosedLoopResults results(slider_crank.mechanism(), scene, still);
  const double pull = 150 * (still.q[2] - 0.2);
  EXPECT_NEAR(results.dynamics.effort()[0], pull * rates.qd[2], 150 * kTolerance);
  EXPECT_GT(std::abs(pull * rates.qd[2]), 1);
}

// Ends that meet where the spring is as long at rest pull nowhere; a spring that is longer at rest
// pushes hard, but where to is not known.
TEST(PointSprings, EndsThatMeetHaveNoDirection) {
  RobotBuilder builder(1);
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), Matrix3l::Identity(), Vector3l::Zero());
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), Matrix3l::Identity(), Vector3l::Zero());
  Scene scene;
  scene.gravity.setZero();
  scene.springs = {spring("spring", "link_0", {0, 0, 0}, "link_1", {0, 0, 0})};
  ClosedLoopResults results(builder.build(), scene);
  const ClosedLoops& dynamics = results.dynamics;
  const auto compute = [&](double at) {
    Motion motion(2);
    motion.q[0] = at;
    results.dynamics.compute(motion);
    EXPECT_TRUE(dynamics.finite());
  };
  for (const double at : {1e-9, 1e-160, 1e-300, 1e-310}) {
    for (const double sign : {-1.0, 1.0}) {
      compute(sign * at);
      EXPECT_NEAR(dynamics.effort()[0], sign * 150 * (at - 0.2), kTolerance * 30) << at;
      EXPECT_FALSE(dynamics.results().undirected());
      EXPECT_TRUE(dynamics.effortExists()[0]);
    }
  }
  compute(0);
  EXPECT_TRUE(dynamics.results().undirected());
  for (const auto& flags : {dynamics.effortExists(), dynamics.effortDetermined()}) {
    EXPECT_EQ(flags, (std::vector<bool>{false, true}));
  }
  EXPECT_EQ(dynamics.rootAxesExist()[0], Determined{});
  EXPECT_EQ(dynamics.childAxesExist()[0], Determined{});
  EXPECT_EQ(dynamics.rootAxesExist()[1], kAllComponents);
  compute(0.1);
  EXPECT_TRUE(dynamics.effortExists()[0]);
  scene.springs[0].rest_length = 0;
  ClosedLoopResults relaxed(builder.build(), scene, Motion(2));
  EXPECT_EQ(relaxed.dynamics.effort()[0], 0);
  EXPECT_TRUE(relaxed.dynamics.effortExists()[0]);
}

// What the loops hand on has no value, either.
TEST(PointSprings, WithoutDirectionReachTheLoopsOfTheirJoints) {
  const SliderCrank slider_crank(0, true);
  Scene scene = slider_crank.scene("joint_1");
  scene.actuated->push_back("joint_4");
  scene.reactions = ReactionSelection::kAll;
  const Motion motion = SliderCrank::motion(0.8, 1, 0, 4);
  scene.springs = {spring("spring", "link_0", {motion.q[2], 0, 0}, "link_3", {0, 0, 0})};
  ClosedLoopResults results(slider_crank.mechanism(), scene, motion);
  EXPECT_FALSE(results.dynamics.results().singular());
  EXPECT_EQ(results.dynamics.effortExists(), (std::vector<bool>{false, false, false, true}));
  for (const char* name : {"pin", "joint_1", "joint_3"}) {
    EXPECT_EQ(results.rootDetermined(name), Determined{}) << name;
  }
  EXPECT_EQ(results.rootDetermined("joint_4"), kAllComponents);
}

// A bar that turns about the origin, held to a point beside it by a spring and damper: the length,
// its rate and the lever of the pull in closed form.
TEST(PointSprings, DampersPullByTheRateOfTheLength) {
  RobotBuilder builder(1);
  builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), Matrix3l::Identity(), Vector3l::Zero());
  builder.removeInertia(1);
  Scene scene;
  scene.springs = {spring("strut", "link_0", {0.7, 0, 0}, "link_1", {0.4, 0, 0})};
  Motion motion(1);
  for (const double stiffness : {0.0, 150.0}) {
    for (const bool reversed : {false, true}) {
      for (const double angle : {0.3, -1.9, 3.0}) {
        scene.springs[0].stiffness = stiffness;
        scene.springs[0].damping = 35;
        if (reversed) {
          std::swap(scene.springs[0].link_a, scene.springs[0].link_b);
          std::swap(scene.springs[0].at_a, scene.springs[0].at_b);
        }
        motion.q[0] = angle;
        motion.qd[0] = -2.5;
        const ClosedLoopResults results(builder.build(), scene, motion);
        const double length = std::sqrt(0.49 + 0.16 - 0.56 * std::cos(angle));
        const double slope = 0.28 * std::sin(angle) / length;  // dl/dq
        const double pull = stiffness * (length - 0.2) + 35 * slope * motion.qd[0];
        EXPECT_NEAR(results.dynamics.effort()[0], pull * slope, kTolerance * 150) << angle;
        scene.static_motion = true;
        const ClosedLoopResults still(builder.build(), scene, motion);
        EXPECT_NEAR(still.dynamics.effort()[0], stiffness * (length - 0.2) * slope,
                    kTolerance * 150);
        scene.static_motion = false;
      }
    }
  }
}

// A mass on a spring and damper of 2 m, 100 N/m and 5 N s/m, by ADAMS: rows of
// TranSpringCB_Case02 of Project Chrono's data/testing, whose force acts on ground's end.
TEST(PointSprings, DampersMatchAdams) {
  constexpr double kPrinted = 1e-4;  // seven digits of positions up to 2.3 m, times 100 N/m
  struct Row {
    Eigen::Vector2d position, velocity, force;  // along y and z
  };
  const Row rows[] = {
      {{1.773547, -1.162133}, {-2.017804, -4.096797}, {12.40114, -8.125958}},
      {{-9.308543e-03, -2.270791}, {-6.004313, -4.562198e-02}, {-1.124503e-01, -27.43192}},
      {{-2.015294, -2.965050e-01}, {7.135845e-02, 1.885372}, {-1.952777, -2.873070e-01}},
      {{-1.999703, -1.399656e-01}, {1.395853e-01, 7.174974e-01}, {4.860352e-01, 3.401917e-02}},
      {{-9.805595e-01, -1.992887}, {4.822187, -2.789175}, {-10.58429, -21.51149}}};
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitY(), R, Vector3l::Zero());
  builder.add(JointType::kPrismatic, 1, Vector3l::UnitZ(), R, Vector3l::Zero());
  Scene scene;
  scene.gravity.setZero();
  scene.springs = {spring("strut", "link_0", {0, 0, 0}, "link_2", {0, 0, 0})};
  scene.springs[0].stiffness = 100;
  scene.springs[0].rest_length = 2;
  scene.springs[0].damping = 5;
  for (const Row& row : rows) {
    Motion motion(2);
    motion.q = row.position;
    motion.qd = row.velocity;
    const ClosedLoopResults results(builder.build(), scene, motion);
    // What holds the mass still against the strut is the strut's force on ground.
    EXPECT_LE((results.dynamics.effort() - row.force).norm(), kPrinted);
  }
}

// In general position, with both ends moving: the damper takes c (dl/dt)^2 from the drives, where
// dl/dt is a difference quotient of lengths.
TEST(PointSprings, DampersTakeTheirPower) {
  RobotBuilder builder = chainOf(5);
  const Mechanism mechanism = builder.build();
  Scene scene;
  const Eigen::Vector3d at_a(0.3, -0.2, 0.1), at_b(-0.4, 0.5, 0.2);
  scene.springs = {spring("strut", "link_1", at_a, "link_4", at_b)};
  Request request;
  request.root_axes = requestedReactions(mechanism, scene);
  request.poses = true;
  const Motion motion = builder.motion();
  ClosedLoops bare(mechanism, scene, request);
  scene.springs[0].damping = 35;
  ClosedLoops damped(mechanism, scene, request);
  const auto lengthAt = [&](double time) {
    Motion moved = motion;
    moved.q += time * motion.qd;
    bare.compute(moved);
    return (pointOf(bare, 3, at_b) - pointOf(bare, 0, at_a)).norm();
  };
  // Central differences of fourth order; see OpenChainHoldsTheGradientOfTheirEnergy.
  const double h = 1e-3;
  const double rate =
      (8 * (lengthAt(h) - lengthAt(-h)) - lengthAt(2 * h) + lengthAt(-2 * h)) / (12 * h);
  bare.compute(motion);
  damped.compute(motion);
  const double power = (damped.effort() - bare.effort()).dot(motion.qd);
  EXPECT_NEAR(power, 35 * rate * rate, 1e-9 * 35);
  EXPECT_GT(std::abs(rate), 0.1);
}

TEST(PointSprings, DampersActInLoops) {
  const SliderCrank slider_crank;
  Scene scene = slider_crank.scene("joint_1");
  scene.springs = {spring("strut", "link_0", {0, 0, 0}, "link_3", {0, 0, 0})};
  const Motion motion = slider_crank.motion(0.8, 3, 0);
  const ClosedLoopResults bare(slider_crank.mechanism(), scene, motion);
  scene.springs[0].damping = 35;
  const ClosedLoopResults damped(slider_crank.mechanism(), scene, motion);
  // The damper's power is that of the crank's additional torque.
  const double rate = motion.qd[2];
  EXPECT_NEAR((damped.dynamics.effort()[0] - bare.dynamics.effort()[0]) * 3, 35 * rate * rate,
              kTolerance * 1000);
  EXPECT_GT(35 * rate * rate, 1);
}

// The pull of a damper whose ends pass through each other has no direction there.
TEST(PointSprings, DampersWhoseEndsMeetHaveNoDirectionUnlessTheyRest) {
  RobotBuilder builder(1);
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), Matrix3l::Identity(), Vector3l::Zero());
  Scene scene;
  scene.gravity.setZero();
  scene.springs = {spring("strut", "link_0", {0, 0, 0}, "link_1", {0, 0, 0})};
  scene.springs[0].rest_length = 0;
  scene.springs[0].damping = 35;
  const auto undirected = [&](double at, double rate) {
    Motion motion(1);
    motion.q[0] = at;
    motion.qd[0] = rate;
    const ClosedLoopResults results(builder.build(), scene, motion);
    EXPECT_TRUE(results.dynamics.finite());
    return results.dynamics.results().undirected();
  };
  EXPECT_TRUE(undirected(0, 1));
  EXPECT_FALSE(undirected(0, 0));
  EXPECT_FALSE(undirected(1e-300, 1));
  scene.static_motion = true;
  EXPECT_FALSE(undirected(0, 1));
  scene.static_motion = false;
  // A rest length is nothing to a damper without stiffness.
  scene.springs[0].stiffness = 0;
  scene.springs[0].rest_length = 0.2;
  EXPECT_FALSE(undirected(0, 0));
}

TEST(PointSprings, EndsThatAlwaysMeetAreRefused) {
  RobotBuilder builder = chainOf(2);
  Scene scene;
  scene.springs = {spring("spring", "link_0", {0, 0, 0}, "link_1", {0, 0, 0})};
  scene.springs[0].at_a = builder.joint(1).p_PoKo_P.cast<double>();
  try {
    ClosedLoopResults(builder.build(), scene);
    ADD_FAILURE() << "not refused";
  } catch (const SceneError& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "springs: 'spring': its ends coincide in every position, so that it has no direction");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
