#include "virtual_work_dynamics/lagrange_dynamics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>

#include "pendulum_closed_form.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "tested_build.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Difference of the two routes relative to the largest result of its kind in the state: 450 eps of
// double, for trees whose recursion rounds some hundred times.
constexpr double kRoutes = 1e-13;
// Closed forms of at most three terms in double, relative to the largest.
constexpr double kClosedForm = 1e-13;
constexpr double kTermsForm = 1e-15;
constexpr int kStates = 100;

enum Kind { kMomentEffort, kForceEffort, kForce, kMoment, kKinds };

/// Largest difference from, and largest value of, the results of a second route, by kind.
class Comparison {
 public:
  void add(Kind kind, double value, double expected) {
    ASSERT_TRUE(std::isfinite(value));
    ASSERT_TRUE(std::isfinite(expected));
    difference_[kind] = std::max(difference_[kind], std::abs(value - expected));
    largest_[kind] = std::max(largest_[kind], std::abs(expected));
  }
  void add(const Wrench& value, const Wrench& expected) {
    for (int i = 0; i < 3; ++i) {
      add(kForce, value.force[i], expected.force[i]);
      add(kMoment, value.torque[i], expected.torque[i]);
    }
  }
  double worst() const {
    double worst = 0;
    for (int kind = 0; kind < kKinds; ++kind) {
      if (difference_[kind] > 0) worst = std::max(worst, difference_[kind] / largest_[kind]);
    }
    return worst;
  }

 private:
  std::array<double, kKinds> difference_{}, largest_{};
};

Request everything(const Mechanism& mechanism) {
  Request request;
  request.child_axes.emplace_back(kGround);
  for (const Joint& joint : mechanism.joints()) request.child_axes.push_back(joint.name);
  request.root_axes = request.child_axes;
  std::reverse(request.root_axes.begin(), request.root_axes.end());
  return request;
}

template <typename Real>
class BothRoutes {
 public:
  BothRoutes(const Mechanism& mechanism, const Scene& scene, const Request& request)
      : mechanism_(mechanism),
        lagrange_(mechanism, scene, request),
        virtual_work_(mechanism, scene, request),
        workspace_(virtual_work_.makeWorkspace()) {}

  /// Largest difference relative to the largest of its kind.
  double difference(const Motion& motion) {
    lagrange_.compute(motion);
    virtual_work_.compute(motion, workspace_);
    Comparison comparison;
    EXPECT_EQ(lagrange_.effort().size(), workspace_.effort().size());
    for (Eigen::Index i = 0; i < lagrange_.effort().size(); ++i) {
      const Joint& joint = mechanism_.joints()[mechanism_.coordinates()[i]];
      comparison.add(joint.type == JointType::kPrismatic ? kForceEffort : kMomentEffort,
                     lagrange_.effort()[i], workspace_.effort()[i]);
    }
    compare(lagrange_.childAxes(), workspace_.childAxes(), comparison);
    compare(lagrange_.rootAxes(), workspace_.rootAxes(), comparison);
    return comparison.worst();
  }

 private:
  static void compare(const std::vector<Wrench>& values, const std::vector<Wrench>& expected,
                      Comparison& comparison) {
    ASSERT_EQ(values.size(), expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) comparison.add(values[i], expected[i]);
  }

  const Mechanism& mechanism_;
  LagrangeDynamics<Real> lagrange_;
  InverseDynamics virtual_work_;
  Workspace workspace_;
};

template <typename Real>
double worstDifference(const Mechanism& mechanism, const Scene& scene, unsigned seed) {
  BothRoutes<Real> routes(mechanism, scene, everything(mechanism));
  RandomRobot states(seed, 1);
  double worst = 0;
  for (int i = 0; i < kStates; ++i) {
    worst = std::max(worst, routes.difference(states.motion(mechanism)));
  }
  return worst;
}

void expectSameByBothRoutes(const std::string& robot, const Mechanism& mechanism,
                            const Scene& scene) {
  const double plain = worstDifference<double>(mechanism, scene, 1);
  const double extended = worstDifference<long double>(mechanism, scene, 1);
  EXPECT_LE(plain, kRoutes) << robot;
  EXPECT_LE(extended, kRoutes) << robot;
  std::cout << robot << ": largest difference of the routes over the largest of its kind " << plain
            << " (Lagrange in double), " << extended << " (in long double)\n";
}

Scene slantedGravity() {
  Scene scene;
  scene.gravity = {0.3, -1.1, -9.81};
  return scene;
}

TEST(LagrangeDynamics, PendulumMatchesEquations57And58) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  const Request request = everything(mechanism);
  LagrangeDynamics<double> plain(mechanism, pendulumScene(), request);
  LagrangeDynamics<long double> extended(mechanism, pendulumScene(), request);
  const InverseDynamics virtual_work(mechanism, pendulumScene(), request);
  Workspace workspace = virtual_work.makeWorkspace();
  Comparison comparison;
  const auto compare = [&](const Motion& motion, const auto& results) {
    const Eigen::Vector2d expected = equation57(motion, Pendulum());
    const Wrench& first = results.rootAxes()[1];  // of ground, joint_1, joint_2 in reverse
    comparison.add(kMomentEffort, results.effort()[0], expected[0]);
    comparison.add(kMomentEffort, results.effort()[1], expected[1]);
    comparison.add(kForce, first.force.x(), equation58(motion, Pendulum()));
    comparison.add(kMoment, first.torque.z(), expected[0]);
  };
  for (int i = 0; i <= 60; ++i) {
    const Motion motion = pendulumMotion(0.1 * i);
    plain.compute(motion);
    compare(motion, plain);
    extended.compute(motion);
    compare(motion, extended);
    virtual_work.compute(motion, workspace);
    compare(motion, workspace);
  }
  EXPECT_LE(comparison.worst(), kClosedForm);
}

TEST(LagrangeDynamics, ExampleArmIsTheSameByBothRoutes) {
  const Mechanism arm = readUrdfFile(std::string(kSourceFolder) + "/urdf/six_axis_arm.urdf");
  expectSameByBothRoutes("six_axis_arm", arm, slantedGravity());
}

class LagrangeOfSharedRobot : public ::testing::TestWithParam<const char*> {};

TEST_P(LagrangeOfSharedRobot, IsTheSameByBothRoutes) {
  const std::string path = std::string(kSharedData) + "/robots/" + GetParam() + ".urdf";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  expectSameByBothRoutes(GetParam(), readUrdfFile(path), slantedGravity());
}

INSTANTIATE_TEST_SUITE_P(LagrangeDynamics, LagrangeOfSharedRobot,
                         ::testing::Values("ur5", "tiago_no_hand", "hyq"));

// Revolute, prismatic, fixed and mimic joints, branches, a welded and a massless link.
RobotBuilder mixedTree() {
  RobotBuilder robot(4);
  const auto add = [&](JointType type, int parent) {
    const Vector3l axis = robot.direction();
    const Matrix3l R_PK = robot.rotation();
    return robot.add(type, parent, axis, R_PK, robot.vector(0.3));
  };
  const int shoulder = add(JointType::kRevolute, 0);
  const int slide = add(JointType::kPrismatic, shoulder);
  const int weld = add(JointType::kFixed, slide);
  const int elbow = add(JointType::kContinuous, weld);
  const int wrist = add(JointType::kPrismatic, elbow);
  robot.mimicFirst(-0.7, 0.2);
  add(JointType::kFixed, wrist);
  const int branch = add(JointType::kRevolute, weld);
  robot.mimicFirst(1.6, -0.4);
  const int tip = add(JointType::kRevolute, branch);
  robot.removeInertia(tip);
  add(JointType::kRevolute, 0);
  robot.addInertia(0);
  return robot;
}

Scene pushed(const Mechanism& mechanism) {
  RobotBuilder random(9);
  Scene scene = slantedGravity();
  for (const Link& link : mechanism.links()) {
    for (const Axes axes : {Axes::kLink, Axes::kRoot}) {
      AppliedWrench wrench;
      wrench.link = link.name;
      wrench.axes = axes;
      wrench.at = random.vector(0.2).cast<double>();
      wrench.force = random.vector(20).cast<double>();
      wrench.torque = random.vector(5).cast<double>();
      scene.applied_wrenches.push_back(wrench);
    }
  }
  return scene;
}

TEST(LagrangeDynamics, MixedTreeIsTheSameByBothRoutes) {
  const Mechanism mechanism = mixedTree().build();
  Scene scene = pushed(mechanism);
  expectSameByBothRoutes("mixed tree", mechanism, scene);
  scene.include_active = false;
  expectSameByBothRoutes("mixed tree without active components", mechanism, scene);
  scene.static_motion = true;
  expectSameByBothRoutes("mixed tree at rest", mechanism, scene);
}

TEST(LagrangeDynamics, RandomTreesAreTheSameByBothRoutes) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    RandomRobot robot(seed, 2 + static_cast<int>(seed % 14));
    const Mechanism mechanism = readUrdf(robot.urdf());
    Scene scene = slantedGravity();
    if (seed % 2) scene = pushed(mechanism);
    BothRoutes<long double> routes(mechanism, scene, everything(mechanism));
    for (int i = 0; i < 10; ++i) {
      EXPECT_LE(routes.difference(robot.motion(mechanism)), kRoutes) << seed;
    }
  }
}

// A last digit of such angles is 1e-8 to 1e-4 rad.
TEST(LagrangeDynamics, LargeAnglesOfGearsAreTheSameByBothRoutes) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RobotBuilder builder = chainOf(3, seed);
    builder.add(3);
    builder.mimicFirst(-0.97892732527699788, 1e8 + 0.1);
    builder.add(4);
    const Mechanism mechanism = builder.build();
    BothRoutes<double> plain(mechanism, slantedGravity(), everything(mechanism));
    BothRoutes<long double> extended(mechanism, slantedGravity(), everything(mechanism));
    for (const double angle : {1e8, 1e12}) {
      Motion motion = builder.motion();
      motion.q *= angle;
      EXPECT_LE(plain.difference(motion), kRoutes) << seed;
      EXPECT_LE(extended.difference(motion), kRoutes) << seed;
    }
  }
}

// The mobility moves no motor: terms of joints are part of efforts only.
TEST(LagrangeDynamics, JointTermsMatchTheirClosedFormsAndLeaveReactionsAlone) {
  const Mechanism mechanism = mixedTree().build();
  Scene scene = slantedGravity();
  const Request request = everything(mechanism);
  LagrangeDynamics<long double> without(mechanism, scene, request);
  for (const Joint& joint : mechanism.joints()) {
    if (joint.type == JointType::kFixed) continue;
    const double x = static_cast<double>(scene.joints.size() + 1);
    scene.joints.push_back({joint.name, 30 * x, 0.1 * x, 2 * x, 3 * x, 0.2 * x, 0.4 * x});
  }
  LagrangeDynamics<long double> with(mechanism, scene, request);
  BothRoutes<long double> routes(mechanism, scene, request);
  for (const Motion& motion : mixedTree().motions(kStates)) {
    EXPECT_LE(routes.difference(motion), kRoutes);
    with.compute(motion);
    without.compute(motion);
    Eigen::VectorXd expected = without.effort();
    for (const JointTerms& terms : scene.joints) {
      const Joint& joint = mechanism.joints()[mechanism.jointIndex(terms.joint)];
      const int i = joint.coordinate;
      const double q = joint.multiplier * motion.q[i] + joint.offset;
      const double qd = joint.multiplier * motion.qd[i], qdd = joint.multiplier * motion.qdd[i];
      const double s = std::min(1.0, std::max(-1.0, qd / terms.coulomb_velocity));
      expected[i] +=
          joint.multiplier * (terms.stiffness * (q - terms.rest) + *terms.damping * qd +
                              *terms.coulomb * s * (3 - s * s) / 2 + terms.rotor_inertia * qdd);
    }
    const double largest = expected.cwiseAbs().maxCoeff();
    EXPECT_LE((with.effort() - expected).cwiseAbs().maxCoeff(), kTermsForm * largest);
    for (std::size_t i = 0; i < request.child_axes.size(); ++i) {
      EXPECT_EQ(with.childAxes()[i].force, without.childAxes()[i].force);
      EXPECT_EQ(with.childAxes()[i].torque, without.childAxes()[i].torque);
    }
  }
}

TEST(LagrangeDynamics, StaticScenesKeepSpringsOnly) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  Scene scene = pendulumScene();
  scene.static_motion = true;
  LagrangeDynamics<double> without(mechanism, scene, Request());
  scene.joints.push_back({"joint_2", 100, 0.25, 7, 8, 0.5, 9});
  LagrangeDynamics<double> with(mechanism, scene, Request());
  Motion motion(2);
  motion.q << 0.5, 0.75;
  motion.qd << 3, 4;
  motion.qdd << 5, 6;
  with.compute(motion);
  without.compute(motion);
  EXPECT_EQ(with.effort()[0], without.effort()[0]);
  EXPECT_NEAR(with.effort()[1] - without.effort()[1], 50, 50 * kClosedForm);
}

TEST(LagrangeDynamics, ComputesWhatIsRequestedInItsOrder) {
  const Mechanism mechanism = mixedTree().build();
  const Scene scene = slantedGravity();
  const Request all = everything(mechanism);
  LagrangeDynamics<double> full(mechanism, scene, all);
  Request some;
  some.efforts = false;
  some.child_axes = {"joint_4", "joint_2"};
  some.root_axes = {"joint_6", "joint_4", kGround};
  LagrangeDynamics<double> narrow(mechanism, scene, some);
  EXPECT_EQ(narrow.coordinates(), static_cast<Eigen::Index>(mechanism.coordinates().size()));
  EXPECT_EQ(narrow.request().root_axes, some.root_axes);
  const Motion motion = RandomRobot(1, 1).motion(mechanism);
  full.compute(motion);
  narrow.compute(motion);
  EXPECT_EQ(narrow.effort().size(), 0);
  const auto expectSame = [&](const auto& names, const auto& values, const auto& all_names,
                              const auto& all_values) {
    ASSERT_EQ(values.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto at = std::find(all_names.begin(), all_names.end(), names[i]) - all_names.begin();
      EXPECT_EQ(values[i].force, all_values[at].force) << names[i];
      EXPECT_EQ(values[i].torque, all_values[at].torque) << names[i];
    }
  };
  expectSame(some.child_axes, narrow.childAxes(), all.child_axes, full.childAxes());
  expectSame(some.root_axes, narrow.rootAxes(), all.root_axes, full.rootAxes());
}

template <typename Call>
std::string messageOf(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(LagrangeDynamics, RefusesWhatInverseDynamicsRefusesInItsWords) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  LagrangeDynamics<double> lagrange(mechanism, pendulumScene(), Request());
  const InverseDynamics virtual_work(mechanism, pendulumScene(), Request());
  Workspace workspace = virtual_work.makeWorkspace();
  Motion motion(2);
  for (auto* vector : {&motion.q, &motion.qd, &motion.qdd}) {
    vector->resize(3);
    EXPECT_THROW(lagrange.compute(motion), MotionError);
    EXPECT_EQ(messageOf([&] { lagrange.compute(motion); }),
              messageOf([&] { virtual_work.compute(motion, workspace); }));
    vector->setZero(2);
  }
  EXPECT_NO_THROW(lagrange.compute(motion));

  Scene wrong_link, strict, wrong_joint;
  wrong_link.applied_wrenches.resize(1);
  wrong_link.applied_wrenches[0].link = "hand";
  strict.strict_inertia = true;
  wrong_joint.joints.resize(1);
  wrong_joint.joints[0].joint = "elbow";
  Request unknown, twice;
  unknown.root_axes = {"elbow"};
  twice.child_axes = {"joint_1", "joint_1"};
  const Mechanism doubtful("doubtful", mechanism.links(), mechanism.joints(),
                           {{"link 'rod_1': no body is like that", true}});
  const auto expectSameRefusal = [&](const Scene& scene, const Request& request) {
    EXPECT_THROW(LagrangeDynamics<double>(doubtful, scene, request), SceneError);
    EXPECT_EQ(messageOf([&] { LagrangeDynamics<double>(doubtful, scene, request); }),
              messageOf([&] { InverseDynamics(doubtful, scene, request); }));
  };
  expectSameRefusal(wrong_link, Request());
  expectSameRefusal(strict, Request());
  expectSameRefusal(Scene(), unknown);
  expectSameRefusal(Scene(), twice);
  EXPECT_THROW(LagrangeDynamics<double>(mechanism, wrong_joint, Request()), SceneError);
}

}  // namespace
}  // namespace virtual_work_dynamics
