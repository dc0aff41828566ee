#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "closed_loops.h"
#include "condition_kinds.h"
#include "conditioned_loops.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// A chain of five joints in which the third follows the first: by a gear, or as its description
// says. The coordinates of the second are those of the first without the third.
struct Geared {
  static constexpr double kRatio = -1.7, kConstant = 0.4;

  explicit Geared(JointType type) : free(robot(type, false)), mimic(robot(type, true)) {}

  static Mechanism robot(JointType type, bool mimics) {
    RobotBuilder builder(11);
    builder.add(0);
    builder.add(1);
    const Vector3l axis = builder.direction();
    const Matrix3l R_PK = builder.rotation();
    builder.add(type, 2, axis, R_PK, builder.vector(0.3));
    if (mimics) builder.mimicFirst(kRatio, kConstant);
    builder.add(3);
    builder.add(4);
    return builder.build();
  }

  ConditionSets gear() const { return {std::make_shared<Gear>(free, 2, 0, kRatio, kConstant)}; }

  static Eigen::VectorXd without(const Eigen::VectorXd& of_free) {
    Eigen::VectorXd v(4);
    v << of_free[0], of_free[1], of_free[3], of_free[4];
    return v;
  }

  Mechanism free, mimic;
};

Motion fullMotion() {
  Motion motion(5);
  motion.q << 0.3, -0.2, 0, 0.5, 0.1;
  motion.qd << 0.7, -1.1, 0, 0.4, 0.9;
  motion.qdd << -2, 1, 0, 3, 0.5;
  return motion;
}

TEST(LoopConditions, GearEqualsAMimicJoint) {
  for (const JointType type : {JointType::kRevolute, JointType::kPrismatic}) {
    const Geared robots(type);
    Scene scene;
    scene.actuated = {"joint_1", "joint_2", "joint_4", "joint_5"};
    ConditionedLoops loops(robots.free, scene, robots.gear());
    ASSERT_EQ(loops.groups.size(), 1u);
    EXPECT_EQ(loops.groups[0].coordinates, (std::vector<int>{0, 2}));
    EXPECT_EQ(loops.kinematics.condition(0).unit, robots.free.unitOf(2));

    Motion motion = fullMotion();
    ASSERT_TRUE(loops.complete(motion));
    EXPECT_NEAR(motion.q[2], Geared::kRatio * motion.q[0] + Geared::kConstant, kConditionTolerance);
    EXPECT_NEAR(motion.qd[2], Geared::kRatio * motion.qd[0], kConditionTolerance);
    EXPECT_NEAR(motion.qdd[2], Geared::kRatio * motion.qdd[0], kConditionTolerance);

    const InverseDynamics oracle(robots.mimic, Scene());
    Workspace workspace = oracle.makeWorkspace();
    Motion reduced(4);
    reduced.q = Geared::without(motion.q);
    reduced.qd = Geared::without(motion.qd);
    reduced.qdd = Geared::without(motion.qdd);
    oracle.compute(reduced, workspace);
    expectNear(workspace.effort(), Geared::without(loops.efforts(motion)));
    // The gear's multiplier bears what the tree demands of its coordinate.
    const double unit = effortScaleOf(robots.free.unitOf(2), kConditionLength);
    EXPECT_NEAR(loops.forces[0].solution().x[1] * unit, loops.treeEfforts(motion)[2],
                kConditionTolerance);
  }
}

// A rod between the ends of the chain, so that a condition with a wrench and one without share a
// group; the oracle has the gear by its description.
TEST(LoopConditions, GearInALoopEqualsAMimicJoint) {
  const Geared robots(JointType::kRevolute);
  Scene scene;
  Closure rod;
  rod.name = "rod";
  rod.type = ClosureType::kDistance;
  rod.parent.link = "link_0";
  rod.parent.xyz << 0.2, 0.1, -0.1;
  rod.child.link = "link_5";
  rod.child.xyz << 0.1, 0.3, 0.2;
  scene.closures = {rod};
  scene.actuated = {"joint_1", "joint_2", "joint_4"};
  Scene start = scene;
  start.assembly = {{"joint_3", Geared::kConstant}};
  ConditionedLoops loops(robots.free, start, robots.gear());
  ClosedLoops oracle(robots.mimic, scene, {true, {}, {"rod"}, false, false});
  expectNear(oracle.assembly(), Geared::without(loops.assembly));

  Motion motion = fullMotion();
  motion.q *= 0.3;
  Motion reduced(4);
  reduced.q = Geared::without(motion.q);
  reduced.qd = Geared::without(motion.qd);
  reduced.qdd = Geared::without(motion.qdd);
  ASSERT_TRUE(loops.complete(motion));
  ASSERT_TRUE(oracle.complete(reduced));
  EXPECT_GT(std::abs(reduced.qd[3]), 0.1);
  expectNear(reduced.q, Geared::without(motion.q));
  expectNear(reduced.qd, Geared::without(motion.qd));
  expectNear(reduced.qdd, Geared::without(motion.qdd));
  oracle.compute(reduced);
  expectNear(oracle.effort(), Geared::without(loops.efforts(motion)));
  ASSERT_EQ(loops.groups.size(), 1u);
  ASSERT_EQ(loops.forces[0].solution().closures.size(), 1u);
  expectNear(oracle.rootAxes()[0].force, loops.forces[0].solution().closures[0].force);
}

// Two gears that say the same: one of them is redundant, which changes no effort.
TEST(LoopConditions, RedundantGearsAreCounted) {
  const Geared robots(JointType::kRevolute);
  Scene scene;
  scene.actuated = {"joint_1", "joint_2", "joint_4", "joint_5"};
  ConditionedLoops one(robots.free, scene, robots.gear());
  ConditionedLoops two(robots.free, scene, ConditionedLoops::joined(robots.gear(), robots.gear()));
  Motion motion = fullMotion();
  ASSERT_TRUE(two.complete(motion));
  expectNear(one.efforts(motion), two.efforts(motion));
  EXPECT_EQ(two.forces[0].redundantConstraints(), 1);
  ASSERT_EQ(two.forces[0].directions(), 1);
  const LoopForces::State& open = two.forces[0].direction(0);
  EXPECT_TRUE(open.touched_closures.empty());
  EXPECT_NEAR(open.x[1] + open.x[2], 0, kConditionTolerance);
}

// Each pair is redundant by itself; what is open in one leaves the other alone.
TEST(LoopConditions, OpenDirectionsOfGearsAreKeptApart) {
  const Geared robots(JointType::kRevolute);
  Scene scene;
  scene.actuated = {"joint_1", "joint_2", "joint_5"};
  const auto third = std::make_shared<Gear>(robots.free, 2, 0, Geared::kRatio, Geared::kConstant);
  const auto fourth = std::make_shared<Gear>(robots.free, 3, 0, 0.6, 0.1);
  ConditionedLoops loops(robots.free, scene, {third, third, fourth, fourth});
  Motion motion = fullMotion();
  ASSERT_TRUE(loops.complete(motion));
  loops.efforts(motion);
  ASSERT_EQ(loops.groups.size(), 1u);
  LoopForces& forces = loops.forces[0];
  ASSERT_EQ(forces.directions(), 2);
  for (const Eigen::Index i : {0, 1, 0}) {
    const Eigen::VectorXd& x = forces.direction(i).x;
    EXPECT_NEAR(x[1] + x[2], 0, kConditionTolerance);
    EXPECT_NEAR(x[3] + x[4], 0, kConditionTolerance);
    EXPECT_NEAR(x.norm(), 1, kConditionTolerance);
  }
}

TEST(LoopConditions, GearKeepsThePhaseOfItsAssembly) {
  const Geared robots(JointType::kRevolute);
  Scene scene;
  scene.actuated = {"joint_1", "joint_2", "joint_4", "joint_5"};
  scene.assembly = {{"joint_1", 0.2}, {"joint_3", -0.9}};
  ConditionedLoops loops(robots.free, scene,
                         {std::make_shared<Gear>(robots.free, 2, 0, Geared::kRatio)});
  EXPECT_EQ(loops.assembly[2], -0.9);
  Motion motion = fullMotion();
  ASSERT_TRUE(loops.complete(motion));
  EXPECT_NEAR(motion.q[2], -0.9 + Geared::kRatio * (motion.q[0] - 0.2), kConditionTolerance);
}

TEST(LoopConditions, RefusesAGearThatCannotBeAssembled) {
  const Geared robots(JointType::kRevolute);
  Scene scene;
  scene.actuated = {"joint_1", "joint_2", "joint_3", "joint_4", "joint_5"};
  const ConditionSets twice = ConditionedLoops::joined(
      robots.gear(), {std::make_shared<Gear>(robots.free, 2, 0, Geared::kRatio, 1.4)});
  try {
    ConditionedLoops loops(robots.free, scene, twice);
    FAIL() << "assembled";
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()).find("gears: 'gear' cannot be assembled"), 0u)
        << error.what();
  }
}

// q_2 = f(t): the multiplier is the effort of a motor that would drive the joint.
TEST(LoopConditions, DriveMovesAndLoadsLikeAMotor) {
  const Mechanism robot = chainOf(3).build();
  const Law law{[](double t) { return 0.1 + 0.3 * std::sin(2 * t); },
                [](double t) { return 0.6 * std::cos(2 * t); },
                [](double t) { return -1.2 * std::sin(2 * t); }};
  Scene scene;
  scene.actuated = {"joint_1", "joint_3"};
  ConditionedLoops loops(robot, scene, {std::make_shared<Drive>(robot, 1, law)});
  EXPECT_NEAR(loops.assembly[1], law.f(0), kConditionTolerance);
  for (const double t : {0.0, 0.4, 1.3, 2.9}) {
    Motion motion(3);
    motion.q << 0.5, 0, -0.8;
    loops.kinematics.setTime(t);
    ASSERT_TRUE(loops.complete(motion)) << t;
    EXPECT_NEAR(motion.q[1], law.f(t), kConditionTolerance);
    EXPECT_NEAR(motion.qd[1], law.fd(t), kConditionTolerance);
    EXPECT_NEAR(motion.qdd[1], law.fdd(t), kConditionTolerance);
    const Eigen::VectorXd efforts = loops.efforts(motion), tree = loops.treeEfforts(motion);
    EXPECT_EQ(efforts[0], tree[0]);
    EXPECT_EQ(efforts[1], 0);
    EXPECT_NEAR(loops.forces[0].solution().x[0] * kConditionLength, tree[1], kConditionTolerance);
  }
}

TEST(LoopConditions, CopiesShareSetsAndKeepPositionsOfTheirOwn) {
  const Geared robots(JointType::kRevolute);
  LoopKinematics one(robots.free, robots.gear());
  one.setPosition(Eigen::VectorXd::Zero(5));
  LoopKinematics two = one;
  two.setPosition(Eigen::VectorXd::Ones(5));
  EXPECT_EQ(&one.set(0), &two.set(0));
  EXPECT_NEAR(one.phi()[0], -Geared::kConstant, kConditionTolerance);
  EXPECT_NEAR(two.phi()[0], 1 - Geared::kRatio - Geared::kConstant, kConditionTolerance);
}

TEST(LoopConditions, RowsOfClosuresHaveNamesAndUnits) {
  const Mechanism robot = chainOf(3).build();
  Scene scene;
  Closure pin;
  pin.name = "pin";
  pin.type = ClosureType::kRevolute;
  pin.parent.link = "link_0";
  pin.child.link = "link_3";
  scene.closures = {pin};
  const LoopKinematics kinematics(robot, scene);
  const std::vector<std::string> names = {"pin.x", "pin.y", "pin.z", "pin.xz", "pin.yz"};
  ASSERT_EQ(kinematics.conditions(), 5);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Condition& condition = kinematics.condition(static_cast<Eigen::Index>(i));
    EXPECT_EQ(condition.name, names[i]);
    EXPECT_EQ(condition.unit, i < 3 ? Unit::kMetre : Unit::kRadian);
    EXPECT_TRUE(condition.has_position);
    EXPECT_FALSE(condition.drives);
  }
  EXPECT_EQ(kinematics.set(0).place(), "closures: 'pin'");
}

}  // namespace
}  // namespace virtual_work_dynamics
