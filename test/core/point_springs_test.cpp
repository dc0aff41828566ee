#include <gtest/gtest.h>

#include <cmath>
#include <string>
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
