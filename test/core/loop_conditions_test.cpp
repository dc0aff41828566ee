#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "closed_loops.h"
#include "condition_kinds.h"
#include "loops/assembly.h"
#include "loops/completion.h"
#include "loops/forces.h"
#include "loops/groups.h"
#include "loops/kinematics.h"
#include "loops/residuals.h"
#include "robot_builder.h"
#include "scene/resolved_loops.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Roundings of a few ten operations with numbers up to a hundred.
constexpr double kTolerance = 1e-12;
// Compares moments with forces; no result depends on it, and it shows where a unit is forgotten.
constexpr double kLength = 0.7;

void expectNear(const Eigen::VectorXd& expected, const Eigen::VectorXd& found) {
  ASSERT_EQ(expected.size(), found.size());
  ASSERT_TRUE(found.allFinite());
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(expected[i], found[i], kTolerance * std::max(1.0, std::abs(expected[i]))) << i;
  }
}

// What ClosedLoopDynamics makes of a scene, with conditions that a scene cannot have.
struct Loops {
  Loops(const Mechanism& robot, const Scene& scene, const ConditionSets& more)
      : mechanism(robot),
        resolved(resolveLoopScene(robot, scene)),
        kinematics(robot, joined(makeConditions(robot, scene), more)),
        groups(loopGroups(robot, kinematics)),
        completion(robot, kinematics, groups, resolved.rank_tolerance, kLength),
        assembly(assemble(scene, resolved, completion, kinematics)) {
    for (const LoopGroup& group : groups) {
      forces.emplace_back(robot, kinematics, resolved, group, kLength);
    }
  }

  static ConditionSets joined(ConditionSets sets, const ConditionSets& more) {
    sets.insert(sets.end(), more.begin(), more.end());
    return sets;
  }

  bool complete(Motion& motion) {
    return completion.complete(kinematics, motion, resolved.actuated);
  }

  // Of actuated coordinates; zero elsewhere.
  Eigen::VectorXd efforts(const Motion& motion) {
    Eigen::VectorXd efforts = treeEfforts(motion);
    kinematics.setPosition(motion.q);
    const std::vector<Wrench> no_reactions(mechanism.joints().size());
    for (LoopForces& group : forces) {
      group.setPosition();
      group.solve(efforts, no_reactions);
    }
    for (const LoopForces& group : forces) {
      for (const int i : group.group().coordinates) efforts[i] = 0;
      for (const LoopUnknowns::Effort& effort : group.efforts()) {
        efforts[static_cast<Eigen::Index>(effort.index)] =
            effort.unit * group.solution().x[effort.unknown];
      }
    }
    return efforts;
  }

  Eigen::VectorXd treeEfforts(const Motion& motion) const {
    Request request;
    request.efforts = true;
    const InverseDynamics tree(mechanism, Scene(), request);
    Workspace workspace = tree.makeWorkspace();
    tree.compute(motion, workspace);
    return workspace.effort();
  }

  const Mechanism& mechanism;
  LoopScene resolved;
  LoopKinematics kinematics;
  std::vector<LoopGroup> groups;
  LoopCompletion completion;
  Eigen::VectorXd assembly;
  std::vector<LoopForces> forces;
};

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
    Loops loops(robots.free, scene, robots.gear());
    ASSERT_EQ(loops.groups.size(), 1u);
    EXPECT_EQ(loops.groups[0].coordinates, (std::vector<int>{0, 2}));
    EXPECT_EQ(loops.kinematics.condition(0).unit, robots.free.unitOf(2));

    Motion motion = fullMotion();
    ASSERT_TRUE(loops.complete(motion));
    EXPECT_NEAR(motion.q[2], Geared::kRatio * motion.q[0] + Geared::kConstant, kTolerance);
    EXPECT_NEAR(motion.qd[2], Geared::kRatio * motion.qd[0], kTolerance);
    EXPECT_NEAR(motion.qdd[2], Geared::kRatio * motion.qdd[0], kTolerance);

    const InverseDynamics oracle(robots.mimic, Scene());
    Workspace workspace = oracle.makeWorkspace();
    Motion reduced(4);
    reduced.q = Geared::without(motion.q);
    reduced.qd = Geared::without(motion.qd);
    reduced.qdd = Geared::without(motion.qdd);
    oracle.compute(reduced, workspace);
    expectNear(workspace.effort(), Geared::without(loops.efforts(motion)));
    // The gear's multiplier bears what the tree demands of its coordinate.
    const double unit = effortScaleOf(robots.free.unitOf(2), kLength);
    EXPECT_NEAR(loops.forces[0].solution().x[1] * unit, loops.treeEfforts(motion)[2], kTolerance);
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
  Loops loops(robots.free, start, robots.gear());
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
  Loops one(robots.free, scene, robots.gear());
  Loops two(robots.free, scene, Loops::joined(robots.gear(), robots.gear()));
  Motion motion = fullMotion();
  ASSERT_TRUE(two.complete(motion));
  expectNear(one.efforts(motion), two.efforts(motion));
  EXPECT_EQ(two.forces[0].redundantConstraints(), 1);
  ASSERT_EQ(two.forces[0].directions(), 1);
  const LoopForces::State& open = two.forces[0].direction(0);
  EXPECT_TRUE(open.touched_closures.empty());
  EXPECT_NEAR(open.x[1] + open.x[2], 0, kTolerance);
}

TEST(LoopConditions, GearKeepsThePhaseOfItsAssembly) {
  const Geared robots(JointType::kRevolute);
  Scene scene;
  scene.actuated = {"joint_1", "joint_2", "joint_4", "joint_5"};
  scene.assembly = {{"joint_1", 0.2}, {"joint_3", -0.9}};
  Loops loops(robots.free, scene, {std::make_shared<Gear>(robots.free, 2, 0, Geared::kRatio)});
  EXPECT_EQ(loops.assembly[2], -0.9);
  Motion motion = fullMotion();
  ASSERT_TRUE(loops.complete(motion));
  EXPECT_NEAR(motion.q[2], -0.9 + Geared::kRatio * (motion.q[0] - 0.2), kTolerance);
}

TEST(LoopConditions, RefusesAGearThatCannotBeAssembled) {
  const Geared robots(JointType::kRevolute);
  Scene scene;
  scene.actuated = {"joint_1", "joint_2", "joint_3", "joint_4", "joint_5"};
  const ConditionSets twice = Loops::joined(
      robots.gear(), {std::make_shared<Gear>(robots.free, 2, 0, Geared::kRatio, 1.4)});
  try {
    Loops loops(robots.free, scene, twice);
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
  Loops loops(robot, scene, {std::make_shared<Drive>(robot, 1, law)});
  EXPECT_NEAR(loops.assembly[1], law.f(0), kTolerance);
  for (const double t : {0.0, 0.4, 1.3, 2.9}) {
    Motion motion(3);
    motion.q << 0.5, 0, -0.8;
    loops.kinematics.setTime(t);
    ASSERT_TRUE(loops.complete(motion)) << t;
    EXPECT_NEAR(motion.q[1], law.f(t), kTolerance);
    EXPECT_NEAR(motion.qd[1], law.fd(t), kTolerance);
    EXPECT_NEAR(motion.qdd[1], law.fdd(t), kTolerance);
    const Eigen::VectorXd efforts = loops.efforts(motion), tree = loops.treeEfforts(motion);
    EXPECT_EQ(efforts[0], tree[0]);
    EXPECT_EQ(efforts[1], 0);
    EXPECT_NEAR(loops.forces[0].solution().x[0] * kLength, tree[1], kTolerance);
  }
}

class BladeTest : public testing::Test {
 protected:
  // A body that slides along x and y and turns about z, an arm on it, and a hand on that.
  static Mechanism robot(bool has_hand = false) {
    RobotBuilder builder(5);
    const Matrix3l R = Matrix3l::Identity();
    builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), R, Vector3l::Zero());
    builder.add(JointType::kPrismatic, 1, Vector3l::UnitY(), R, Vector3l::Zero());
    builder.add(JointType::kRevolute, 2, Vector3l::UnitZ(), R, Vector3l::Zero());
    builder.add(JointType::kRevolute, 3, Vector3l::UnitX(), R, {0.1L, 0.2L, 0});
    if (has_hand) builder.add(4);
    return builder.build();
  }
  static Scene sceneOf(const std::vector<std::string>& actuated) {
    Scene scene;
    scene.actuated = actuated;
    scene.assembly = {{"joint_2", 0.25}};
    return scene;
  }

  const Law speed{[](double t) { return 0.2 + 0.5 * t; }, [](double) { return 0.5; },
                  [](double) { return 0.0; }};
  const std::shared_ptr<const ConditionSet> blade = std::make_shared<Blade>(speed);
  const Mechanism mechanism = robot();
};

// qd_1 = (u + sin qd_0) / cos and its derivative; no position follows.
TEST_F(BladeTest, NonHolonomicConditionGivesRatesWithoutPositions) {
  Loops loops(mechanism, sceneOf({"joint_1", "joint_3", "joint_4"}), {blade});
  EXPECT_EQ(loops.assembly[1], 0.25);
  EXPECT_EQ(loops.completion.rank(loops.kinematics, std::vector<bool>(4, false)), 0);
  for (int n = 0; n < 20; ++n) {
    const double t = 0.1 * n, s = std::sin(-1.2 + 0.1 * n), c = std::cos(-1.2 + 0.1 * n);
    Motion motion(4);
    motion.q << 0.3, 0.7, -1.2 + 0.1 * n, 0.4;
    if (n > 0) motion.qd << 0.8 - 0.1 * n, 0, 0.5, -0.3;
    if (n > 0) motion.qdd << -0.6, 0, 0.9, 0.2;
    loops.kinematics.setTime(t);
    ASSERT_TRUE(loops.complete(motion)) << n;
    EXPECT_EQ(motion.q[1], 0.7);
    const double u = speed.f(t), x = motion.qd[0], turn = motion.qd[2];
    const double y = (u + s * x) / c;
    EXPECT_NEAR(motion.qd[1], y, kTolerance * std::max(1.0, std::abs(y)));
    const double yd =
        (speed.fd(t) + s * motion.qdd[0] + c * turn * x) / c + (u + s * x) * s * turn / (c * c);
    EXPECT_NEAR(motion.qdd[1], yd, kTolerance * std::max(1.0, std::abs(yd)));
  }
}

// The blade's edge bears the whole load across it: f_1 = cos lambda, f_0 = F_0 - sin lambda.
TEST_F(BladeTest, MultiplierBearsTheLoadAcrossTheBlade) {
  Loops loops(mechanism, sceneOf({"joint_1", "joint_3", "joint_4"}), {blade});
  Motion motion(4);
  motion.q << 0.3, 0.7, 0.6, 0.4;
  motion.qd << 0.8, 0, 0.5, -0.3;
  motion.qdd << -0.6, 0, 0.9, 0.2;
  ASSERT_TRUE(loops.complete(motion));
  const Eigen::VectorXd tree = loops.treeEfforts(motion);
  Eigen::VectorXd expected = tree;
  expected[0] += std::tan(0.6) * tree[1];
  expected[1] = 0;
  expectNear(expected, loops.efforts(motion));
}

// Newton's method goes by the gear alone, in one step and one that finds no more to do, although
// the blade lets y not move.
TEST_F(BladeTest, PositionsFollowConditionsThatHaveThem) {
  const ConditionSets sets = {blade, std::make_shared<Gear>(mechanism, 3, 1, 2.0, 0.1)};
  Loops loops(mechanism, sceneOf({"joint_1", "joint_3", "joint_4"}), sets);
  Eigen::VectorXd q(4);
  q << 0.3, 0.3, 0.6, 0.4;
  ASSERT_TRUE(loops.completion.close(loops.kinematics, q, loops.resolved.actuated));
  EXPECT_NEAR(q[1], 0.15, kTolerance);
  EXPECT_LE(loops.completion.steps(), 2);
  EXPECT_EQ(loops.completion.rank(loops.kinematics, std::vector<bool>(4, false)), 1);
  // Both conditions on the speed of y: they contradict each other.
  Motion motion(4);
  motion.q = q;
  EXPECT_FALSE(loops.complete(motion));
  motion.qd[3] = 2 * speed.f(0) / std::cos(0.6);
  motion.qdd[3] = 2 * speed.fd(0) / std::cos(0.6);
  EXPECT_TRUE(loops.complete(motion));
}

// A group of conditions without positions has nothing to say while another is being closed.
TEST_F(BladeTest, BladeAloneDoesNotDisturbOtherLoops) {
  const Mechanism with_hand = robot(true);
  const ConditionSets sets = {blade, std::make_shared<Gear>(with_hand, 4, 3, 2.0, 0.1)};
  Loops loops(with_hand, sceneOf({"joint_1", "joint_3", "joint_4"}), sets);
  ASSERT_EQ(loops.groups.size(), 2u);
  Motion motion(5);
  motion.q << 0.3, 0.7, 0.6, 0.4, 0;
  ASSERT_TRUE(loops.complete(motion));
  EXPECT_GT(loops.completion.steps(), 0);
  EXPECT_EQ(motion.q[1], 0.7);
  EXPECT_NEAR(motion.q[4], 0.9, kTolerance);
  EXPECT_NEAR(motion.qd[1], speed.f(0) / std::cos(0.6), kTolerance);
}

// Where y is free but for the blade it stays as near as the gear lets it, and moves as the blade
// says.
TEST_F(BladeTest, GearAndBladeTogetherDetermineTheMotion) {
  const ConditionSets sets = {blade, std::make_shared<Gear>(mechanism, 3, 1, 2.0, 0.1)};
  Loops loops(mechanism, sceneOf({"joint_1", "joint_3"}), sets);
  Motion motion(4);
  motion.q << 0.3, 0.7, 0.6, 0.4;
  motion.qd << 0.8, 0, 0.5, 0;
  ASSERT_TRUE(loops.complete(motion));
  EXPECT_NEAR(motion.q[3], 2 * motion.q[1] + 0.1, kTolerance);
  const double y = (speed.f(0) + std::sin(0.6) * 0.8) / std::cos(0.6);
  EXPECT_NEAR(motion.qd[1], y, kTolerance);
  EXPECT_NEAR(motion.qd[3], 2 * y, kTolerance);
  // Residuals are those of closures, of which there are none; the rows of the conditions vanish.
  loops.kinematics.setMotion(motion);
  EXPECT_LE(loops.kinematics.phi().cwiseAbs().maxCoeff(), kTolerance);
  EXPECT_LE(loops.kinematics.rates().cwiseAbs().maxCoeff(), kTolerance);
  EXPECT_LE(loops.kinematics.accelerations().cwiseAbs().maxCoeff(), kTolerance);
}

TEST(LoopConditions, CopiesShareSetsAndKeepPositionsOfTheirOwn) {
  const Geared robots(JointType::kRevolute);
  LoopKinematics one(robots.free, robots.gear());
  one.setPosition(Eigen::VectorXd::Zero(5));
  LoopKinematics two = one;
  two.setPosition(Eigen::VectorXd::Ones(5));
  EXPECT_EQ(&one.set(0), &two.set(0));
  EXPECT_NEAR(one.phi()[0], -Geared::kConstant, kTolerance);
  EXPECT_NEAR(two.phi()[0], 1 - Geared::kRatio - Geared::kConstant, kTolerance);
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
