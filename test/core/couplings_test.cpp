#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "coupled_shafts.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// A recursion and a factorization of trees in general position against another recursion.
constexpr double kSameTree = 1e-12;

// Project Chrono, utest_CH_shafts.cpp: two shafts, a gear with w_B = r w_A, a torque on A.
TEST(Couplings, GearOfChronoShafts) {
  const double ratio = -0.1, torque = 6;
  CoupledShafts shafts({{10, false}, {100, false}});
  shafts.couple("gear", {{2, 1}, {1, -ratio}});
  shafts.actuate(1);
  ClosedLoopResults found(shafts.mechanism(), shafts.scene);
  Motion motion(2);
  motion.q << 0.4, 0;
  motion.qdd << 6.0 / 11, 0;
  ASSERT_TRUE(found.dynamics.complete(motion));
  expectClose(motion.q[1], -0.04);
  expectClose(motion.qdd[1], -0.6 / 11);
  found.dynamics.compute(motion);
  expectClose(found.dynamics.effort()[0], torque);
  EXPECT_EQ(found.dynamics.effort()[1], 0);
  const double on_b = found.dynamics.effort()[2];
  EXPECT_NEAR(on_b, -5.4545454545, 5e-11);
  EXPECT_NEAR(-ratio * on_b, -0.5454545, 5e-8);
  expectClose(on_b, 100 * motion.qdd[1]);
  // A coupling loads no bearing.
  for (const char* joint : {"joint_1", "joint_2"}) {
    EXPECT_LE(found.root(joint).force.norm(), kTenRoundings) << joint;
    EXPECT_LE(found.root(joint).torque.head<2>().norm(), kTenRoundings) << joint;
  }
}

// Factors of slides and turns have different units, so that none is small beside another. What
// drives the slide's 100 N is off by no more than their rounding over the size of the mechanism,
// the radius of gyration of its shaft.
TEST(Couplings, FactorsCountHoweverSmallTheyAre) {
  const double advance = 1e-13;  // m/rad
  CoupledShafts shafts({{10, false}, {100, true}});
  shafts.couple("screw", {{2, 1}, {1, -advance}});
  shafts.actuate(1);
  ClosedLoopResults found(shafts.mechanism(), shafts.scene);
  Motion motion(2);
  motion.qdd << 0, 1;
  found.dynamics.compute(motion);
  EXPECT_NEAR(found.dynamics.effort()[0], 100 * advance, 100 * 2.2e-16 * std::sqrt(1.5 * 10));
}

// Two motors on one screw share its load by least squares over its size, wherever it is: the
// distance of its joints, or its advance where they are closer, at one point or beside it by
// rounding.
TEST(Couplings, MotorsOnAScrewShareItsLoadWhereverItIs) {
  const double advance = 0.02;  // m/rad
  const auto balanced = [&](const Vector3l& first, long double apart) {
    CoupledShafts shafts({{10, false}, {100, true}}, first, apart);
    shafts.couple("screw", {{2, 1}, {1, -advance}});
    shafts.actuate(1);
    shafts.actuate(2);
    ClosedLoopResults found(shafts.mechanism(), shafts.scene);
    Motion motion(2);
    motion.qdd << 1, advance;
    found.dynamics.compute(motion);
    const double load = 10 + 100 * advance * advance;
    const double share = advance / std::max(std::sqrt(1.5 * 10), static_cast<double>(apart));
    const double turning = load / (1 + share * share);
    EXPECT_NEAR(found.dynamics.effort()[0], turning, 1e-9) << first << ", " << apart;
    EXPECT_NEAR(found.dynamics.effort()[1], (load - turning) / advance, 1e-7)
        << first << ", " << apart;
    EXPECT_LT(found.dynamics.determinacy().condition, 10) << first << ", " << apart;
  };
  for (const long double apart : {5.0L, 0.05L, 1e-6L, 1e-12L, 3e-18L, 0.0L}) {
    for (const long double away : {0.0L, 1e3L, 1e5L}) balanced({away, 0, 0}, apart);
  }
}

// The reducer of the same file, t0 = -50 / 100, truss C fixed: (1 - t0) w_B - w_A + t0 w_C = 0.
TEST(Couplings, PlanetaryReducerOfChronoShafts) {
  const double t0 = -0.5, torque = 10;
  CoupledShafts shafts({{0.5, false}, {0.5, false}, {0.2, false}});
  shafts.couple("planetary", {{2, 1 - t0}, {1, -1}, {3, t0}});
  shafts.couple("truss", {{3, 1}});
  shafts.actuate(1);
  ClosedLoopResults found(shafts.mechanism(), shafts.scene);
  const double acceleration = torque / (0.5 + 0.5 / 2.25);
  Motion motion(3);
  motion.qdd[0] = acceleration;
  ASSERT_TRUE(found.dynamics.complete(motion));
  expectClose(motion.qdd[1], acceleration / 1.5);
  EXPECT_EQ(motion.qdd[2], 0);
  found.dynamics.compute(motion);
  expectClose(found.dynamics.effort()[0], torque);
  const double on_b = 0.5 * motion.qdd[1];
  expectClose(found.dynamics.effort()[3], on_b / 1.5);
  expectClose(found.dynamics.effort()[4], -t0 * on_b / 1.5);  // what holds the truss
}

// The same one held by a brake on B: torques of planetary sets are as their ratios, whatever moves.
TEST(Couplings, BrakedReducerHoldsTheTorque) {
  CoupledShafts shafts({{0.5, false}, {0.5, false}, {0.2, false}});
  shafts.couple("planetary", {{2, 1.5}, {1, -1}, {3, -0.5}});
  shafts.actuate(2);
  shafts.actuate(3);
  shafts.load(1, -10);  // a torque of 10 N m drives A
  ClosedLoopResults found(shafts.mechanism(), shafts.scene, Motion(3));
  expectClose(found.dynamics.effort()[3], 10);
  expectClose(found.dynamics.effort()[1], -15);
  expectClose(found.dynamics.effort()[2], 5);
}

// Gazebo's test of gearboxes, joint_gearbox.cc: ratios -1.5 and -2.5 of the first wheel to the
// third; a force on one is balanced by the ratio times it on the other.
TEST(Couplings, GearboxesOfGazebo) {
  for (const double ratio : {-1.5, -2.5}) {
    CoupledShafts shafts({{1, false}, {1, false}});
    shafts.couple("gearbox", {{2, 1}, {1, ratio}});  // q_3 = -ratio q_1
    shafts.actuate(2);
    shafts.load(1, 1);
    ClosedLoopResults found(shafts.mechanism(), shafts.scene, Motion(2));
    expectClose(found.dynamics.effort()[1], -1 / ratio);
  }
}

struct MimicRow {
  double multiplier, offset, reference;
};

// The table of gz-physics, joint_mimic_features.cc: follower = multiplier (leader - reference) +
// offset, of joints of both kinds, and of one that follows a follower.
TEST(Couplings, MimicTableOfGzPhysics) {
  constexpr MimicRow kRows[] = {{1, 0, 0},    {-1, 0, 0},        {1, 0.1, 0}, {1, 0.05, 0.05},
                                {-1, 0.2, 0}, {-1, 0.05, -0.05}, {-2, 0, 0},  {2, 0.1, 0}};
  for (const MimicRow& row : kRows) {
    for (const bool leader_slides : {false, true}) {
      for (const bool follower_slides : {false, true}) {
        CoupledShafts shafts({{2, leader_slides}, {3, follower_slides}, {1, false}});
        for (const int follower : {2, 3}) {
          shafts.couple("mimic_" + std::to_string(follower),
                        {{follower, 1}, {follower - 1, -row.multiplier}});
          shafts.scene.couplings.back().offset = row.offset - row.multiplier * row.reference;
        }
        shafts.actuate(1);
        ClosedLoopResults found(shafts.mechanism(), shafts.scene);
        const double m = row.multiplier;
        for (const double leader : {-0.7, 0.0, 0.3}) {
          Motion motion(3);
          motion.q[0] = leader;
          motion.qd[0] = 0.2;
          motion.qdd[0] = -1.1;
          ASSERT_TRUE(found.dynamics.complete(motion));
          const double follower = m * (leader - row.reference) + row.offset;
          expectClose(motion.q[1], follower);
          expectClose(motion.q[2], m * (follower - row.reference) + row.offset);
          expectClose(motion.qd[2], m * m * 0.2);
          found.dynamics.compute(motion);
          expectClose(found.dynamics.effort()[0], -1.1 * (2 + m * m * 3 + m * m * m * m));
        }
      }
    }
  }
}

// Drake's coupler, q_0 = rho q_1 + dq, and the linear part of MuJoCo's equality, y - y0 = a0 + a1
// (x
// - x0): one relation with two constants.
TEST(Couplings, ConstantIsThatOfTheSceneOrOfTheAssembly) {
  CoupledShafts shafts({{1, false}, {1, false}});
  shafts.couple("coupler", {{1, 1}, {2, -2.5}}).offset = 0.3;
  shafts.actuate(2);
  Motion motion(2);
  motion.q[1] = 0.4;
  {
    ClosedLoopResults found(shafts.mechanism(), shafts.scene);
    ASSERT_TRUE(found.dynamics.complete(motion));
    expectClose(motion.q[0], 1.3);
    expectClose(found.dynamics.assembly()[0], 0.3);
  }
  shafts.scene.couplings[0].offset.reset();
  shafts.scene.assembly = {{"joint_1", 0.9}, {"joint_2", 0.1}};
  ClosedLoopResults found(shafts.mechanism(), shafts.scene);
  EXPECT_EQ(found.dynamics.assembly()[0], 0.9);
  ASSERT_TRUE(found.dynamics.complete(motion));
  expectClose(motion.q[0], 2.5 * 0.4 + 0.9 - 2.5 * 0.1);
}

// A differential: the case turns at the mean of both sides and its torque is halved.
TEST(Couplings, DifferentialHalvesTheTorque) {
  CoupledShafts shafts({{0.3, false}, {0.7, false}, {0.9, false}});  // case, left, right
  shafts.couple("differential", {{2, 1}, {3, 1}, {1, -2}}).offset = 0;
  shafts.actuate(1);
  shafts.scene.given = std::vector<std::string>{"joint_2", "joint_3"};
  shafts.scene.free_motion = true;  // one side may run away from the other
  const Dynamics dynamics(shafts.mechanism(), shafts.scene);
  EXPECT_EQ(dynamics.effortNames(), (std::vector<std::string>{"joint_1", "residual.motion.joint_2",
                                                              "joint_3", "differential"}));
  EXPECT_EQ(dynamics.couplings(), 1u);
  EXPECT_EQ(dynamics.closureLabel(0), "coupling 'differential'");
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(3);
  motion.q << 1, 0.5, 1.5;
  motion.qd << 2, -1, 5;
  // Both sides feel the same torque: 0.7 a_l = 0.9 a_r.
  motion.qdd << 0.8, 0.9, 0.7;
  dynamics.compute(motion, workspace);
  const Eigen::VectorXd& effort = workspace.results().effort;
  expectClose(effort[3], 0.63);
  expectClose(effort[0], 0.3 * 0.8 + 2 * 0.63);
  EXPECT_LE(std::abs(effort[1]), kTenRoundings);
}

// Joints 5 and 6 of a wrist whose motors stand behind: motor 6 turns with both, and friction and
// rotors are those of the motors. By virtual work the motors' torques are those of the joints.
TEST(Couplings, CoupledWristHasItsFrictionAndRotorsAtTheMotors) {
  const double n5 = 45, n6 = 32, share = 1, rotor5 = 2e-5, rotor6 = 3e-5, viscous = 4e-4;
  RobotBuilder builder = chainOf(6, 7);
  const Matrix3l R = Matrix3l::Identity();
  for (int motor = 0; motor < 2; ++motor) {
    builder.removeInertia(
        builder.add(JointType::kContinuous, 0, Vector3l::UnitZ(), R, Vector3l::Zero()));
  }
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.couplings.resize(2);
  scene.couplings[0].name = "wrist_5";
  scene.couplings[0].terms = {{"joint_7", 1}, {"joint_5", -n5}};
  scene.couplings[1].name = "wrist_6";
  scene.couplings[1].terms = {{"joint_8", 1}, {"joint_6", -n6}, {"joint_5", -n6 * share}};
  scene.actuated =
      std::vector<std::string>{"joint_1", "joint_2", "joint_3", "joint_4", "joint_7", "joint_8"};
  for (const auto& [name, rotor] : {std::pair("joint_7", rotor5), std::pair("joint_8", rotor6)}) {
    JointTerms terms;
    terms.joint = name;
    terms.rotor_inertia = rotor;
    terms.damping = viscous;
    scene.joints.push_back(terms);
  }
  scene.given =
      std::vector<std::string>{"joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6"};
  ClosedLoopResults found(mechanism, scene);
  Scene bare;
  const InverseDynamics tree(mechanism, bare);
  Workspace workspace = tree.makeWorkspace();
  for (const Motion& random : builder.motions(20)) {
    Motion motion = random;
    std::vector<bool> given(8, true);
    given[6] = given[7] = false;
    ASSERT_TRUE(found.dynamics.complete(motion, given));
    expectClose(motion.qd[6], n5 * motion.qd[4]);
    expectClose(motion.qdd[7], n6 * (motion.qdd[5] + share * motion.qdd[4]));
    found.dynamics.compute(motion);
    tree.compute(motion, workspace);
    const Eigen::VectorXd& joints = workspace.effort();
    const Eigen::VectorXd& motors = found.dynamics.effort();
    for (int i = 0; i < 4; ++i) expectClose(motors[i], joints[i], kSameTree);
    EXPECT_EQ(motors[4], 0);
    EXPECT_EQ(motors[5], 0);
    const double own5 = rotor5 * motion.qdd[6] + viscous * motion.qd[6];
    const double own6 = rotor6 * motion.qdd[7] + viscous * motion.qd[7];
    expectClose(motors[6], own5 + (joints[4] - share * joints[5]) / n5, kSameTree);
    expectClose(motors[7], own6 + joints[5] / n6, kSameTree);
    // The couplings carry what is left of it to the joints.
    expectClose(motors[8], own5 - motors[6], kSameTree);
    expectClose(motors[9], own6 - motors[7], kSameTree);
    // Reactions are those of the tree: what a coupling exerts is no wrench.
    for (std::size_t i = 0; i < 8; ++i) {
      const double size = workspace.rootAxes()[i].force.norm() + 1;
      EXPECT_LE((found.dynamics.rootAxes()[i].force - workspace.rootAxes()[i].force).norm(),
                kSameTree * size);
    }
  }
}

// The sum that is reported is that of the terms, with the offsets of joints that mimic.
TEST(Couplings, SumsHaveTheOffsetsOfMimicJoints) {
  for (const bool says_offset : {true, false}) {
    CoupledShafts shafts({{1, false}, {1, false}, {1, false}});
    shafts.builder().mimicFirst(2, 0.3);
    Coupling& coupling = shafts.couple("sum", {{2, 1}, {3, -3}});
    if (says_offset) coupling.offset = 1;
    shafts.actuate(2);
    ClosedLoopResults found(shafts.mechanism(), shafts.scene);
    Motion motion(2);
    motion.q[1] = 0.4;
    ASSERT_TRUE(found.dynamics.complete(motion));
    found.dynamics.compute(motion);
    const double sum = motion.q[1] - 3 * (2 * motion.q[0] + 0.3);
    expectClose(sum, says_offset ? 1 : -0.9);
    expectClose(found.dynamics.results().loops.actuated_positions[0], sum);
  }
}

// A mimic joint is a coupling that a description says.
TEST(Couplings, EqualMimicJoints) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    RobotBuilder mimicking = chainOf(3, seed), coupled = chainOf(3, seed);
    const double multiplier = 0.3 * seed - 6.2, offset = 0.01 * seed;
    mimicking.add(2);
    coupled.add(2);
    mimicking.mimicFirst(multiplier, offset);
    Scene scene;
    Coupling coupling;
    coupling.name = "belt";
    coupling.terms = {{"joint_4", 1}, {"joint_1", -multiplier}};
    coupling.offset = offset;
    scene.couplings = {coupling};
    const InverseDynamics whole(mimicking.build(), Scene());
    scene.actuated = std::vector<std::string>{"joint_1", "joint_2", "joint_3"};
    ClosedLoopResults found(coupled.build(), scene);
    Workspace workspace = whole.makeWorkspace();
    for (const Motion& motion : mimicking.motions(5)) {
      whole.compute(motion, workspace);
      Motion all(4);
      all.q.head<3>() = motion.q;
      all.qd.head<3>() = motion.qd;
      all.qdd.head<3>() = motion.qdd;
      ASSERT_TRUE(found.dynamics.complete(all));
      expectClose(all.q[3], multiplier * motion.q[0] + offset);
      found.dynamics.compute(all);
      for (int i = 0; i < 3; ++i) {
        expectClose(found.dynamics.effort()[i], workspace.effort()[i], 10 * kSameTree);
      }
      EXPECT_EQ(found.dynamics.effort()[3], 0);
      for (std::size_t i = 0; i < 4; ++i) {
        const Wrench& expected = workspace.childAxes()[i];
        const Wrench& value = found.dynamics.childAxes()[i];
        EXPECT_LE((value.force - expected.force).norm(), 10 * kSameTree * expected.force.norm());
        EXPECT_LE((value.torque - expected.torque).norm(),
                  10 * kSameTree * (expected.torque.norm() + expected.force.norm()));
      }
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
