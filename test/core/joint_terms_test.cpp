#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "judge.h"
#include "plain_results.h"
#include "robot_builder.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

JointTerms allTerms(const std::string& joint) {
  JointTerms terms;
  terms.joint = joint;
  terms.stiffness = 300;
  terms.rest = 0.7;
  terms.damping = 5;
  terms.coulomb = 11;
  terms.coulomb_velocity = 0.5;
  terms.rotor_inertia = 3;
  terms.offset = -17;
  return terms;
}

// Two joints that turn, one that slides, and one that follows the first.
RobotBuilder arm() {
  RobotBuilder builder = chainOf(2);
  builder.add(JointType::kPrismatic, 2, builder.direction(), builder.rotation(), {0.1, 0, 0});
  builder.add(3);
  builder.mimicFirst(-0.75, 0.25);
  return builder;
}

TEST(JointTerms, AddToTheEffortAndToNoReaction) {
  RobotBuilder builder = chainOf(2);
  const Mechanism mechanism = builder.build();
  Scene bare, scene;
  scene.joints = {allTerms("joint_2")};
  Motion motion(2);
  motion.q << 0.3, 1.7;
  motion.qd << 1, 0.25;
  motion.qdd << 2, -4;
  const InverseDynamics with(mechanism, scene), without(mechanism, bare);
  Workspace a = with.makeWorkspace(), b = without.makeWorkspace();
  with.compute(motion, a);
  without.compute(motion, b);
  // 300 (1.7 - 0.7) + 5 * 0.25 + 11 * 0.5 (3 - 0.25) / 2 + 3 * -4 - 17
  const double expected = 300 + 1.25 + 7.5625 - 12 - 17;
  EXPECT_NEAR(a.effort()[1] - b.effort()[1], expected, 8 * kEps * 300);
  EXPECT_EQ(a.effort()[0], b.effort()[0]);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.rootAxes()[i].force, b.rootAxes()[i].force);
    EXPECT_EQ(a.rootAxes()[i].torque, b.rootAxes()[i].torque);
    EXPECT_EQ(a.childAxes()[i].torque, b.childAxes()[i].torque);
  }
}

TEST(JointTerms, DryFrictionIsAllThereBeyondItsVelocityAndOddBelow) {
  RobotBuilder builder(1);
  builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), Matrix3l::Identity(), {0, 0, 0});
  builder.removeInertia(1);
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.joints = {JointTerms()};
  scene.joints[0].joint = "joint_1";
  scene.joints[0].coulomb = 2;
  scene.joints[0].coulomb_velocity = 0.125;
  const InverseDynamics dynamics(mechanism, scene);
  Workspace workspace = dynamics.makeWorkspace();
  const auto friction = [&](double rate) {
    Motion motion(1);
    motion.qd[0] = rate;
    dynamics.compute(motion, workspace);
    return workspace.effort()[0];
  };
  EXPECT_EQ(friction(0), 0);
  EXPECT_EQ(friction(0.0625), 2 * 0.6875);
  EXPECT_EQ(friction(-0.0625), -2 * 0.6875);
  for (const double rate : {0.125, 0.2, 1e9, 1e300}) {
    EXPECT_EQ(friction(rate), 2) << rate;
    EXPECT_EQ(friction(-rate), -2) << rate;
  }
}

TEST(JointTerms, StaticScenesHaveSpringsAndOffsetsOnly) {
  RobotBuilder builder = chainOf(1);
  const Mechanism mechanism = builder.build();
  Scene scene, bare;
  scene.static_motion = bare.static_motion = true;
  scene.joints = {allTerms("joint_1")};
  Motion motion(1);
  motion.q[0] = 1.7;
  motion.qd[0] = motion.qdd[0] = 100;
  EXPECT_NEAR(singleResults(InverseDynamics(mechanism, scene), motion).effort[0] -
                  singleResults(InverseDynamics(mechanism, bare), motion).effort[0],
              300 - 17, 8 * kEps * 300);
}

// An offset alone is a term, and that of a mimic joint reaches its master by the ratio.
TEST(JointTerms, OffsetsAreConstantEfforts) {
  RobotBuilder builder = arm();
  const Mechanism mechanism = builder.build();
  Scene scene;
  for (const char* name : {"joint_1", "joint_3", "joint_4"}) {
    scene.joints.emplace_back();
    scene.joints.back().joint = name;
    scene.joints.back().offset = 8;
  }
  for (const Motion& motion : builder.motions(3)) {
    const auto with = singleResults(InverseDynamics(mechanism, scene), motion);
    const auto without = singleResults(InverseDynamics(mechanism, Scene()), motion);
    EXPECT_NEAR(with.effort[0] - without.effort[0], 8 - 0.75 * 8, 64 * kEps * 8);
    EXPECT_EQ(with.effort[1], without.effort[1]);
    EXPECT_NEAR(with.effort[2] - without.effort[2], 8, 64 * kEps * 8);
    EXPECT_EQ(with.root_axes, without.root_axes);
  }
}

TEST(JointTerms, CostNothingWhenNoEffortIsRequested) {
  const Mechanism mechanism = arm().build();
  Scene scene;
  scene.joints = {allTerms("joint_1"), allTerms("joint_4")};
  Request request;
  request.efforts = false;
  request.child_axes = {"joint_3"};
  const PlanSummary with = InverseDynamics(mechanism, scene, request).summary();
  const PlanSummary without = InverseDynamics(mechanism, Scene(), request).summary();
  EXPECT_EQ(with.multiplications, without.multiplications);
  EXPECT_EQ(with.additions, without.additions);
}

TEST(JointTerms, DescriptionCountsOnlyWhenAsked) {
  const char* urdf = R"(<robot name="r"><link name="a"/>
    <link name="b"><inertial><mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
      <dynamics damping="0.5" friction="3"/></joint></robot>)";
  const Mechanism mechanism = readUrdf(urdf);
  EXPECT_EQ(mechanism.joints()[0].damping, 0.5);
  EXPECT_EQ(mechanism.joints()[0].friction, 3);
  Motion motion(1);
  motion.qd[0] = 4;
  const auto effort = [&](const Scene& scene) {
    return singleResults(InverseDynamics(mechanism, scene), motion).effort[0];
  };
  Scene scene;
  EXPECT_EQ(effort(scene), 0);
  scene.use_urdf_dynamics = true;
  EXPECT_EQ(effort(scene), 5);
  scene.joints = {JointTerms()};  // gives neither
  scene.joints[0].joint = "j";
  EXPECT_EQ(effort(scene), 5);
  scene.joints[0].damping = 0;
  EXPECT_EQ(effort(scene), 3);
  scene.joints[0].coulomb = 1;
  EXPECT_EQ(effort(scene), 1);
}

void expectRefusal(const Mechanism& mechanism, const Scene& scene, const std::string& part) {
  try {
    InverseDynamics(mechanism, scene);
    ADD_FAILURE() << "accepted; expected to read: " << part;
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

void expectRefusal(const Mechanism& mechanism, const JointTerms& terms, const std::string& part) {
  Scene scene;
  scene.joints = {terms};
  expectRefusal(mechanism, scene, part);
}

TEST(JointTerms, RefusesByName) {
  RobotBuilder builder = chainOf(1);
  builder.add(JointType::kFixed, 1, Vector3l::Zero(), Matrix3l::Identity(), {0, 0, 0});
  const Mechanism mechanism = builder.build();
  expectRefusal(mechanism, allTerms("elbow"), "no joint 'elbow'");
  expectRefusal(mechanism, allTerms("joint_2"), "'joint_2' is a fixed joint");
  JointTerms terms = allTerms("joint_1");
  terms.stiffness = -1;
  expectRefusal(mechanism, terms, "'joint_1': stiffness = -1");
  terms = allTerms("joint_1");
  terms.damping = -2;
  expectRefusal(mechanism, terms, "'joint_1': damping = -2");
  terms = allTerms("joint_1");
  terms.coulomb = std::nan("");
  expectRefusal(mechanism, terms, "'joint_1': coulomb");
  terms = allTerms("joint_1");
  terms.rotor_inertia = -0.5;
  expectRefusal(mechanism, terms, "'joint_1': rotor_inertia = -0.5");
  terms = allTerms("joint_1");
  terms.offset = INFINITY;
  expectRefusal(mechanism, terms, "'joint_1': offset is not finite");
  terms = allTerms("joint_1");
  terms.coulomb_velocity = 0;
  expectRefusal(mechanism, terms, "'joint_1': coulomb_velocity = 0");
  terms.coulomb_velocity = INFINITY;
  expectRefusal(mechanism, terms, "'joint_1': coulomb_velocity = inf is not a finite number");
  const Mechanism negative = readUrdf(R"(<robot name="r"><link name="a"/><link name="b"/>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
      <dynamics damping="-0.5" friction="0"/></joint></robot>)");
  Scene described;
  EXPECT_NO_THROW(InverseDynamics(negative, described));
  described.use_urdf_dynamics = true;
  expectRefusal(negative, described,
                "use_urdf_dynamics: joint 'j' of the description: damping = -0.5");
  Scene twice;
  twice.joints = {allTerms("joint_1"), allTerms("joint_1")};
  EXPECT_THROW(InverseDynamics(mechanism, twice), SceneError);
}

#ifdef VWD_HAS_REAL113

TEST(JointTerms, AgreeWith113BitsInAllKernels) {
  RobotBuilder builder = arm();
  const Mechanism mechanism = builder.build();
  Scene scene;
  for (const Joint& joint : mechanism.joints()) scene.joints.push_back(allTerms(joint.name));
  const std::vector<Motion> motions = builder.motions(19);
  const Request request = requestEveryJoint(mechanism);
  Judge judge(mechanism, scene);
  for (const InstructionSet set : supportedInstructionSets()) {
    const InverseDynamics dynamics(mechanism, scene, request, set);
    BlockInverseDynamics<double> block(dynamics, 1, set);
    FencedBlock<double> arrays(block, motions, BlockLayout::kRowMajor);
    arrays.compute(block);
    for (std::size_t n = 0; n < motions.size(); ++n) {
      const Errors one = judge.errorsOf(singleResults(dynamics, motions[n]), motions[n]);
      const Errors many = judge.errorsOf(arrays.sample(n), motions[n]);
      EXPECT_LE(one.over_bound, 1) << toString(set) << ": " << one.worst;
      EXPECT_LE(many.over_bound, 1) << toString(set) << ": " << many.worst;
    }
  }
}

// A pendulum on a spring of 1e9 N m/rad with a ripple of 1 kHz on its motion: the effort against
// its closed form, within four roundings of the terms that it is the sum of.
TEST(JointTerms, StiffPendulumIsExactToTheBound) {
  const Mechanism mechanism = readUrdf(R"(<robot name="pendulum"><link name="base"/>
    <link name="rod"><inertial><origin xyz="0.25 0 0"/><mass value="0.5"/>
      <inertia ixx="0" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
    <joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/>
      <axis xyz="0 0 1"/></joint></robot>)");
  Scene scene;
  scene.gravity = {9.81, 0, 0};
  scene.joints = {JointTerms()};
  scene.joints[0].joint = "hinge";
  scene.joints[0].stiffness = 1e9;
  scene.joints[0].rest = 0.25;
  const InverseDynamics dynamics(mechanism, scene);
  Workspace workspace = dynamics.makeWorkspace();
  const double pi = 3.14159265358979, ripple = 2 * pi * 1000;
  double worst = 0;
  for (int n = 0; n < 1000; ++n) {
    const double t = 1e-5 * n * std::sqrt(2.0);
    Motion motion(1);
    motion.q[0] = 0.25 + 0.1 * std::sin(2 * pi * t) + 1e-6 * std::sin(ripple * t);
    motion.qd[0] = 0.2 * pi * std::cos(2 * pi * t) + 1e-6 * ripple * std::cos(ripple * t);
    motion.qdd[0] =
        -0.4 * pi * pi * std::sin(2 * pi * t) - 1e-6 * ripple * ripple * std::sin(ripple * t);
    dynamics.compute(motion, workspace);
    ASSERT_TRUE(std::isfinite(workspace.effort()[0])) << t;  // the maximum passes over NaN
    const Real113 q = motion.q[0], inertia = Real113(0.01) + Real113(0.5) * 0.0625;
    const Real113 weight = Real113(0.5) * 0.25 * Real113(9.81) * sine(q);
    const Real113 spring = Real113(1e9) * (q - Real113(0.25));
    const Real113 expected = inertia * motion.qdd[0] + weight + spring;
    const Real113 scale = magnitude(inertia * motion.qdd[0]) + Real113(0.5) * 0.25 * 9.81 +
                          Real113(1e9) * (magnitude(q) + 0.25);
    worst = std::max(worst, static_cast<double>(magnitude(workspace.effort()[0] - expected) /
                                                (4 * kEps * scale)));
  }
  RecordProperty("error_over_bound", std::to_string(worst));
  EXPECT_LE(worst, 1);
}

#endif

}  // namespace
}  // namespace virtual_work_dynamics
