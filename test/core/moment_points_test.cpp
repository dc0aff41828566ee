#include "moment_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "named_results.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

// Results of some thousand, and levers of a metre, against long double.
constexpr double kTolerance = 1e-11;
constexpr int kCases = 300;

std::vector<std::string> jointsOf(const Mechanism& mechanism) {
  std::vector<std::string> names;
  for (const Joint& joint : mechanism.joints()) names.push_back(joint.name);
  return names;
}

Request everyJoint(const Mechanism& mechanism) {
  Request request;
  request.child_axes = request.root_axes = jointsOf(mechanism);
  request.poses = request.twists = true;
  return request;
}

void expectNear(const Eigen::Vector3d& found, const Vector3l& expected, const std::string& name) {
  const double size = std::max(1.0, static_cast<double>(expected.norm()));
  EXPECT_LE((found.cast<long double>() - expected).norm(), kTolerance * size) << name;
}

/// A random tree in a scene with a point for every moment, and what must come of it: Newton's and
/// Euler's wrenches, carried to the points by hand.
struct MovedCase {
  explicit MovedCase(RandomCases& random)
      : made(random.next()), bodies(made.mechanism, made.scene, made.motion) {
    made.scene.moments_about = randomMomentPoints(random, made.mechanism, made.scene);
    for (const MomentPoint& point : made.scene.moments_about) {
      const int k = made.mechanism.jointIndex(point.name);
      const Vector3l place = placeOf(made.mechanism, made.scene, bodies, point);
      const Vector3l lever = bodies.origin(k + 1) - place;
      NewtonEulerOracle::RootWrench wrench = bodies.reaction(k);
      if (!made.scene.include_active) dropActive(k, wrench);
      wrench.torque += lever.cross(wrench.force);
      places.push_back(place);
      wrenches.push_back(wrench);
      velocities.push_back(bodies.originVelocity(k + 1) -
                           bodies.angularVelocity(k + 1).cross(lever));
    }
  }

  void dropActive(int k, NewtonEulerOracle::RootWrench& wrench) const {
    const Joint& joint = made.mechanism.joint(k);
    const Vector3l axis = bodies.orientation(k + 1) * joint.axis_K;
    Vector3l& active = joint.type == JointType::kPrismatic ? wrench.force : wrench.torque;
    active -= axis.dot(active) * axis;
  }

  Matrix3l axesOf(std::size_t i) const {
    return bodies.orientation(static_cast<int>(i) + 1).transpose();
  }

  Case made;
  NewtonEulerOracle bodies;
  std::vector<Vector3l> places, velocities;             // by joint, root axes
  std::vector<NewtonEulerOracle::RootWrench> wrenches;  // about these places
};

TEST(MomentPoints, MomentsAreThoseOfNewtonAndEulerCarriedThereByHand) {
  RandomCases random(71);
  for (int n = 0; n < kCases; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    const MovedCase moved(random);
    const Mechanism& mechanism = moved.made.mechanism;
    const NamedResults results(mechanism, moved.made.scene, everyJoint(mechanism),
                               moved.made.motion);
    for (std::size_t i = 0; i < moved.wrenches.size(); ++i) {
      const std::string& name = mechanism.joints()[i].name;
      const auto& expected = moved.wrenches[i];
      expectNear(results.root(name).force, expected.force, name);
      expectNear(results.root(name).torque, expected.torque, name);
      expectNear(results.child(name).force, moved.axesOf(i) * expected.force, name);
      expectNear(results.child(name).torque, moved.axesOf(i) * expected.torque, name);
      // Power of the reaction does not depend on the point: pose and twist are there, too.
      expectNear(results.pose(name).position, moved.places[i], name);
      expectNear(results.twist(name).linear, moved.velocities[i], name);
    }
  }
}

TEST(MomentPoints, LagrangesEquationsTurnAboutThem) {
  RandomCases random(72);
  for (int n = 0; n < kCases / 3; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    const MovedCase moved(random);
    LagrangeDynamics<double> lagrange(moved.made.mechanism, moved.made.scene,
                                      everyJoint(moved.made.mechanism));
    lagrange.compute(moved.made.motion);
    for (std::size_t i = 0; i < moved.wrenches.size(); ++i) {
      const std::string& name = moved.made.mechanism.joints()[i].name;
      expectNear(lagrange.rootAxes()[i].force, moved.wrenches[i].force, name);
      expectNear(lagrange.rootAxes()[i].torque, moved.wrenches[i].torque, name);
      expectNear(lagrange.childAxes()[i].torque, moved.axesOf(i) * moved.wrenches[i].torque, name);
    }
  }
}

TEST(MomentPoints, BlocksHaveThem) {
  RandomCases random(73);
  for (int n = 0; n < kCases / 3; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    const MovedCase moved(random);
    const Motion& motion = moved.made.motion;
    const InverseDynamics dynamics(moved.made.mechanism, moved.made.scene,
                                   everyJoint(moved.made.mechanism));
    BlockInverseDynamics<double> block(dynamics);
    const std::size_t numbers = moved.wrenches.size();
    std::vector<double> child(6 * numbers), root(6 * numbers), poses(12 * numbers);
    ResultBlock<double> results;
    results.child_axes = child.data();
    results.root_axes = root.data();
    results.poses = poses.data();
    block.compute(BlockLayout::kRowMajor, {1, motion.q.data(), motion.qd.data(), motion.qdd.data()},
                  results);
    for (std::size_t i = 0; i < numbers; ++i) {
      const std::string& name = moved.made.mechanism.joints()[i].name;
      const auto torque = [&](const std::vector<double>& from) {
        return Eigen::Vector3d(from[6 * i + 3], from[6 * i + 4], from[6 * i + 5]);
      };
      expectNear(torque(root), moved.wrenches[i].torque, name);
      expectNear(torque(child), moved.axesOf(i) * moved.wrenches[i].torque, name);
      expectNear(Eigen::Vector3d(poses[12 * i], poses[12 * i + 1], poses[12 * i + 2]),
                 moved.places[i], name);
    }
  }
}

// Whoever takes axes and point of a wrench from one frame asks for the moment about its origin.
TEST(MomentPoints, WhatDoesNotAskForThemKeepsItsBits) {
  RandomCases random(74);
  int moved_moments = 0;
  for (int n = 0; n < kCases / 3; ++n) {
    SCOPED_TRACE("case " + std::to_string(n));
    Case made = random.next();
    const std::vector<std::string> names = jointsOf(made.mechanism);
    Request request = everyJoint(made.mechanism);
    const NamedResults plain(made.mechanism, made.scene, request, made.motion);
    made.scene.moments_about = randomMomentPoints(random, made.mechanism, made.scene);
    if (made.scene.moments_about.size() > 1) made.scene.moments_about.pop_back();
    request.child_axes_about_origin = true;
    const NamedResults results(made.mechanism, made.scene, request, made.motion);
    EXPECT_EQ(results.effort(), plain.effort());
    for (const std::string& name : names) {
      expectSame(results.child(name), plain.child(name));
      EXPECT_EQ(results.root(name).force, plain.root(name).force);
      moved_moments += results.root(name).torque != plain.root(name).torque;
    }
    if (names.size() > 1) expectSame(results.root(names.back()), plain.root(names.back()));
  }
  EXPECT_GE(moved_moments, 50);
}

/// A cart on a rail along x, 5 kg whose centre of mass is 0.2 m above the rail.
RobotBuilder cartOnRail() {
  RobotBuilder builder(1);
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), Matrix3l::Identity(),
              Vector3l(0.5L, 0, 1));
  builder.removeInertia(1);
  builder.link(1).mass = 5;
  builder.link(1).p_KoCm_K << 0, 0, 0.2L;
  return builder;
}

// The rail's end feels the weight at the cart's distance, and the cart's drive at its height.
TEST(MomentPoints, TheEndOfARailFeelsTheCartAtItsDistance) {
  const Mechanism mechanism = cartOnRail().build();
  Scene scene;
  MomentPoint point;
  point.name = "joint_1";
  point.frame = JointFrame::kParent;
  scene.moments_about = {point};
  Motion motion(1);
  motion.q << 3;
  motion.qdd << 2;
  const NamedResults results(mechanism, scene, everyJoint(mechanism), motion);
  const double weight = 5 * 9.81;
  for (const Wrench& wrench : {results.root("joint_1"), results.child("joint_1")}) {
    EXPECT_NEAR(wrench.torque.y(), -3 * weight + 0.2 * 5 * 2, kTolerance * weight);
  }
  EXPECT_NEAR(results.pose("joint_1").position.x(), 0.5, kTolerance);
}

// A rail and its cart may both be far from the root: the way from one to the other does not lead
// through it.
TEST(MomentPoints, LoseNoDigitsFarFromTheRoot) {
  RobotBuilder builder(1);
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), Matrix3l::Identity(),
              Vector3l(1e9L, 0, 0));
  builder.add(JointType::kPrismatic, 1, Vector3l::UnitX(), Matrix3l::Identity(),
              Vector3l(0.5L, 0, 0));
  builder.removeInertia(2);
  builder.link(2).mass = 5;
  const Mechanism mechanism = builder.build();
  Scene scene;
  MomentPoint point;
  point.name = "joint_2";
  point.frame = JointFrame::kParent;
  scene.moments_about = {point};
  Motion motion(2);
  motion.q << 1e9 / 3, 0.1;
  const NamedResults results(mechanism, scene, everyJoint(mechanism), motion);
  EXPECT_NEAR(results.child("joint_2").torque.y(), -0.1 * 5 * 9.81, 1e-14);
}

// A point costs arithmetic where there is one and nothing elsewhere.
TEST(MomentPoints, CostNothingWhereNotAskedFor) {
  const Mechanism mechanism = chainOf(4).build();
  Scene scene;
  const auto cost = [&](const Request& request) {
    return InverseDynamics(mechanism, scene, request).summary().multiplications;
  };
  Request request = everyJoint(mechanism);
  const std::size_t all = cost(request);
  Request others = request;
  others.root_axes.pop_back();
  others.child_axes.pop_back();
  const std::size_t without = cost(others);
  MomentPoint point;
  point.name = "joint_4";
  point.link = "link_0";
  scene.moments_about = {point};
  EXPECT_GT(cost(request), all);
  EXPECT_EQ(cost(others), without);
}

void expectRefusal(const std::function<void()>& make, const std::string& message) {
  try {
    make();
    ADD_FAILURE() << "accepted; expected: " << message;
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()), message);
  }
}

TEST(MomentPoints, WrongOnesAreRefusedByPlace) {
  const Mechanism mechanism = chainOf(2).build();
  const auto refusal = [&](const MomentPoint& point, const std::string& message) {
    Scene scene;
    MomentPoint good;
    good.name = "joint_1";
    scene.moments_about = {good, point};
    expectRefusal([&] { InverseDynamics(mechanism, scene, everyJoint(mechanism)); }, message);
    expectRefusal([&] { LagrangeDynamics<double>(mechanism, scene, everyJoint(mechanism)); },
                  message);
  };
  MomentPoint point;
  point.name = "joint_1";
  refusal(point, "moments_about[1]: 'joint_1' is named twice");
  point.name = "joint_3";
  refusal(point, "moments_about[1]: no joint 'joint_3'; known are 'joint_1' and 'joint_2'");
  point.name = kGround;
  refusal(point, "moments_about[1]: the moment of ground is about the origin of the root link");
  point.name = "joint_2";
  point.link = "link_7";
  refusal(point,
          "moments_about[1].link: no link 'link_7'; known are 'link_0', 'link_1' and 'link_2'");
  point.link.reset();
  point.at.x() = std::numeric_limits<double>::infinity();
  refusal(point, "moments_about[1].at: is not three finite numbers");
}

TEST(MomentPoints, AreReadFromAScene) {
  const Scene scene =
      readScene(YAML::Load("moments_about: [{name: pin, frame: parent}, {name: b, at: [1, 2, 3]},\n"
                           "                {name: slide, link: cart, at: [0, 0, 0.1]}]"));
  ASSERT_EQ(scene.moments_about.size(), 3u);
  EXPECT_EQ(scene.moments_about[0].name, "pin");
  EXPECT_EQ(scene.moments_about[0].frame, JointFrame::kParent);
  EXPECT_EQ(scene.moments_about[0].at, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(scene.moments_about[1].frame, JointFrame::kChild);
  EXPECT_EQ(scene.moments_about[1].at, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.moments_about[2].link, "cart");
}

TEST(MomentPoints, WrongOnesOfASceneAreRefusedByKey) {
  const auto refusal = [](const std::string& entry, const std::string& message) {
    expectRefusal([&] { readScene(YAML::Load("moments_about: " + entry)); }, message);
  };
  refusal("[{frame: parent}]", "moments_about[0]: names no joint or closure");
  refusal("[{name: pin, frame: child, link: cart}]",
          "moments_about[0]: has both frame and link; one of them says where the point is fixed");
  refusal("[{name: pin, frame: parents}]",
          "moments_about[0].frame: 'parents' is neither parent nor child; did you mean 'parent'?");
  refusal("[{name: pin, link: cart, at: [0, 1]}]",
          "moments_about[0].at: expected a list of three numbers");
  refusal("{pin: parent}", "moments_about: expected a list");
}

}  // namespace
}  // namespace virtual_work_dynamics
