#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "coupled_shafts.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/passive_joints.h"

namespace virtual_work_dynamics {
namespace {

// A recursion and a factorization of trees in general position against another recursion.
constexpr double kSameEfforts = 1e-12;

// Motors turn for hours: what cancels to rounding is no gap.
TEST(CouplingRules, CloseAfterManyTurns) {
  for (const bool says_offset : {true, false}) {
    CoupledShafts shafts({{1, false}, {1, false}, {1, false}});
    shafts.couple("gear", {{1, 0.3}, {2, -101.3}, {3, 0.7}});
    if (says_offset) shafts.scene.couplings[0].offset = 0.25;
    shafts.actuate(2);
    shafts.actuate(3);
    ClosedLoopResults found(shafts.mechanism(), shafts.scene);
    for (const double turned : {1e3, 1e6, 1e9}) {
      Motion motion(3);
      motion.q << 0, turned, 0.1 * turned;
      EXPECT_TRUE(found.dynamics.complete(motion)) << turned;
      EXPECT_NEAR(motion.q[0], (101.3 * turned - 0.07 * turned) / 0.3, 1e-12 * 337 * turned + 1);
    }
  }
}

// Ten radians of a motor are not ten less two turns, and a long way is gone at once.
TEST(CouplingRules, WholeTurnsCount) {
  CoupledShafts shafts({{1, false}, {1, false}});
  shafts.couple("gear", {{1, 1}, {2, -50}}).offset = 0;
  shafts.actuate(1);
  const Mechanism mechanism = shafts.mechanism();
  const Dynamics dynamics(mechanism, shafts.scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  PassiveJoints passive(mechanism, dynamics);
  for (const double turned : {10.0, 9.0, 5000.0, -3.0}) {
    Motion motion(2);
    motion.q[0] = turned;
    ASSERT_TRUE(passive.complete(motion, dynamics, workspace)) << turned;
    EXPECT_EQ(motion.q[0], turned);
    expectClose(motion.q[1], turned / 50);
  }
}

// Ties velocities and not positions: these have to be given.
TEST(CouplingRules, RateOnlyTiesNoPositions) {
  CoupledShafts shafts({{10, false}, {100, false}});
  shafts.couple("belt", {{2, 1}, {1, 0.1}}).rate_only = true;
  shafts.actuate(1);
  const Mechanism mechanism = shafts.mechanism();
  const Dynamics dynamics(mechanism, shafts.scene);
  EXPECT_FALSE(dynamics.closuresDetermine());
  EXPECT_EQ(dynamics.given().coordinates, (std::vector<bool>{true, true}));
  EXPECT_EQ(dynamics.judge(dynamics.given()).freedom, 0);
  Given driver = dynamics.given();
  driver.coordinates[1] = false;
  EXPECT_EQ(dynamics.judge(driver).freedom, 1);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(2);
  motion.q << 0.4, 77;
  motion.qd << 1, 0;
  motion.qdd << 6.0 / 11, 0;
  ASSERT_TRUE(dynamics.complete(motion, workspace));
  EXPECT_EQ(motion.q[1], 77);
  expectClose(motion.qd[1], -0.1);
  dynamics.compute(motion, workspace);
  expectClose(workspace.results().effort[0], 6);
  EXPECT_EQ(workspace.results().loops.residuals[0].position, 0);
}

// What a coupling exerts does no work and is no actuator's: certificates and the other formalism
// hold with it, and only with it.
TEST(CouplingRules, CertificatesHoldOnTheTree) {
  RobotBuilder builder = chainOf(5, 3);
  const Mechanism mechanism = builder.build();
  Scene scene;
  Coupling coupling;
  coupling.name = "belt";
  coupling.terms = {{"joint_1", 1}, {"joint_3", -0.6}, {"joint_5", 2}};
  scene.couplings = {coupling};
  scene.actuated = std::vector<std::string>{"joint_1", "joint_2", "joint_3", "joint_4"};
  Request request;
  request.child_axes = {"joint_2", "joint_4"};
  const Request extended = Certifier::extended(request);
  const Dynamics dynamics(mechanism, scene, extended);
  Certifier certifier(mechanism, dynamics.tree());
  LagrangeDynamics<long double> lagrange(mechanism, dynamics.tree(), dynamics.treeRequest());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const std::size_t ground = Certifier::groundIndex(extended);
  for (const Motion& random : builder.motions(30)) {
    Motion motion = random;
    ASSERT_TRUE(dynamics.complete(motion, workspace));
    dynamics.compute(motion, workspace);
    const Results& results = workspace.results();
    Load load(dynamics.tree());
    dynamics.getTreeLoad(results, load);
    const Certificates found =
        certifier.check(motion, load, results.treeEffort(5), results.child_axes[ground]);
    EXPECT_LE(found.largest(), 1e-13);
    lagrange.compute(motion, load);
    for (int i = 0; i < 5; ++i) {
      expectClose(results.treeEffort(5)[i], lagrange.effort()[i], kSameEfforts);
    }
    EXPECT_GT(std::abs(results.effort[5]), 1e-3);
    expectClose(results.loops.actuated_positions[0],
                motion.q[0] - 0.6 * motion.q[2] + 2 * motion.q[4], kSameEfforts);
    EXPECT_LE(std::abs(results.loops.actuated_velocities[0]), kSameEfforts * motion.qd.norm());
  }
}

// Two couplings that say the same share what they bear: each is open, their sum and the efforts are
// not.
TEST(CouplingRules, RedundantOnesAreFlagged) {
  CoupledShafts shafts({{10, false}, {100, false}, {4, false}, {5, false}});
  shafts.couple("gear", {{2, 1}, {1, 0.1}}).offset = 0.2;
  shafts.couple("belt", {{2, 10}, {1, 1}}).offset = 2;
  shafts.couple("other", {{4, 1}, {3, -3}}).offset = 0;
  shafts.actuate(1);
  shafts.actuate(3);
  ClosedLoopResults found(shafts.mechanism(), shafts.scene);
  Motion motion(4);
  motion.qdd << 6.0 / 11, 0, 1, 0;
  ASSERT_TRUE(found.dynamics.complete(motion));
  found.dynamics.compute(motion);
  const std::vector<bool>& determined = found.dynamics.effortDetermined();
  EXPECT_EQ(determined, (std::vector<bool>{true, true, true, true, false, false, true}));
  EXPECT_EQ(found.dynamics.determinacy().redundant_constraints, 1);
  const Eigen::VectorXd& effort = found.dynamics.effort();
  expectClose(effort[0], 6);
  expectClose(effort[4] + 10 * effort[5], -60.0 / 11);
  EXPECT_GT(std::abs(effort[4]), 0.01);
  EXPECT_GT(std::abs(effort[5]), 0.01);
  expectClose(effort[6], 15);
}

// More motors than freedoms: the motors share, whatever the coupling then bears.
TEST(CouplingRules, CoupledMotorsShareTheLoad) {
  CoupledShafts shafts({{2, false}, {2, false}});
  shafts.couple("belt", {{1, 1}, {2, -1}});
  shafts.actuate(1);
  shafts.actuate(2);
  shafts.load(1, 10);
  ClosedLoopResults found(shafts.mechanism(), shafts.scene, Motion(2));
  expectClose(found.dynamics.effort()[0], 5);
  expectClose(found.dynamics.effort()[1], 5);
  expectClose(found.dynamics.effort()[2], 5);  // 10 - 5 on joint_1, -5 on joint_2
  EXPECT_EQ(found.dynamics.effortDetermined(), (std::vector<bool>{false, false, false}));
}

// Residuals say how far a motion of all joints violates a coupling.
TEST(CouplingRules, ResidualsOfMotionsThatViolateThem) {
  CoupledShafts shafts({{2, false}, {2, true}});
  shafts.couple("rack", {{2, 1}, {1, -0.05}}).offset = 0.01;
  shafts.actuate(1);
  const Dynamics dynamics(shafts.mechanism(), shafts.scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(2);
  motion.q << 2, 0.12;
  motion.qd << 3, 0.2;
  motion.qdd << -1, 0;
  dynamics.compute(motion, workspace);
  const ClosureResidual& residual = workspace.results().loops.residuals[0];
  expectClose(residual.position, 0.01);
  expectClose(residual.velocity, 0.05);
  expectClose(residual.acceleration, 0.05);
  EXPECT_EQ(dynamics.closureNames(), std::vector<std::string>{"rack"});
  EXPECT_NE(dynamics.whyOpen(motion, std::vector<bool>(2, true), workspace)
                .find("the loops cannot be closed: coupling 'rack' stays open by 0.0"),
            std::string::npos);
}

}  // namespace
}  // namespace virtual_work_dynamics
