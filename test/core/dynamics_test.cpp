#include "virtual_work_dynamics/dynamics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "pushed_mechanisms.h"
#include "result_differences.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Two routes through a few bodies in double, relative to the largest force or moment.
constexpr double kTwoRoutes = 1e-11;

TEST(Dynamics, OfAnOpenChainIsInverseDynamics) {
  OpenChain chain;
  for (const InstructionSet set : supportedInstructionSets()) {
    const InverseDynamics expected(chain.mechanism, chain.scene, chain.request, set);
    const Dynamics dynamics(chain.mechanism, chain.scene, chain.request, set);
    Workspace of_chain = expected.makeWorkspace();
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    const Load load = otherLoad(chain.scene);
    for (int i = 0; i < 20; ++i) {
      const Motion motion = chain.robot.motion(chain.mechanism);
      expected.compute(motion, load, of_chain);
      dynamics.compute(motion, load, workspace);
      EXPECT_EQ(differences(workspace.results(), of_chain.results()), "");
      expected.compute(motion, of_chain);
      EXPECT_NE(differences(workspace.results(), of_chain.results()), "");
      dynamics.compute(motion, workspace);
      EXPECT_EQ(differences(workspace.results(), of_chain.results()), "");
    }
    EXPECT_EQ(dynamics.summary().multiplications, expected.summary().multiplications);
    EXPECT_EQ(dynamics.summary().bodies, expected.summary().bodies);
  }
}

TEST(Dynamics, OfClosedLoopsIsClosedLoopDynamics) {
  for (const std::vector<std::string>& actuated :
       {std::vector<std::string>{"A"}, std::vector<std::string>{"A", "D"}}) {
    const ClosedLinkage linkage(actuated);
    const ClosedLoopDynamics expected(linkage.cut.mechanism, linkage.cut.scene, linkage.request);
    const Dynamics dynamics(linkage.cut.mechanism, linkage.cut.scene, linkage.request);
    ClosedLoopDynamics::Workspace of_loops = expected.makeWorkspace();
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    const Load load = otherLoad(linkage.cut.scene);
    EXPECT_EQ(dynamics.assembly(), expected.assembly());
    for (long double angle = 0.3L; angle < 7; angle += 0.4L) {
      Motion completed = linkage.incomplete(angle), expected_motion = completed;
      const bool closes = angle < 3 ? dynamics.complete(completed, workspace)
                                    : dynamics.completeFromCloseBy(completed, workspace);
      ASSERT_TRUE(closes);
      ASSERT_TRUE(angle < 3 ? expected.complete(expected_motion, of_loops)
                            : expected.completeFromCloseBy(expected_motion, of_loops));
      EXPECT_EQ(completed.q, expected_motion.q);
      EXPECT_EQ(completed.qd, expected_motion.qd);
      EXPECT_EQ(completed.qdd, expected_motion.qdd);
      expected.compute(completed, load, of_loops);
      dynamics.compute(completed, load, workspace);
      EXPECT_EQ(differences(workspace.results(), of_loops.results()), "");
      expected.compute(completed, of_loops);
      EXPECT_NE(differences(workspace.results(), of_loops.results()), "");
      dynamics.compute(completed, workspace);
      EXPECT_EQ(differences(workspace.results(), of_loops.results()), "");
    }
    EXPECT_EQ(dynamics.summary().multiplications, expected.summary().multiplications);
  }
}

TEST(Dynamics, TellsWhatAnOpenChainIs) {
  OpenChain chain;
  const Dynamics dynamics(chain.mechanism, chain.scene, chain.request);
  const std::size_t coordinates = chain.mechanism.coordinates().size();
  EXPECT_FALSE(dynamics.closed());
  EXPECT_FALSE(dynamics.closuresDetermine());
  EXPECT_EQ(dynamics.coordinates(), static_cast<Eigen::Index>(coordinates));
  EXPECT_EQ(dynamics.effortNames(), chain.mechanism.coordinateNames());
  EXPECT_EQ(dynamics.closureNames(), std::vector<std::string>());
  EXPECT_EQ(dynamics.actuated(), std::vector<bool>(coordinates, true));
  EXPECT_EQ(dynamics.assembly(), Eigen::VectorXd::Zero(dynamics.coordinates()));
  EXPECT_EQ(dynamics.request().root_axes, chain.request.root_axes);
  EXPECT_EQ(dynamics.treeRequest().efforts, chain.request.efforts);
  EXPECT_EQ(dynamics.treeRequest().child_axes, chain.request.child_axes);
  EXPECT_EQ(dynamics.treeRequest().root_axes, chain.request.root_axes);
  ASSERT_EQ(dynamics.tree().applied_wrenches.size(), chain.scene.applied_wrenches.size());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const Motion motion = chain.robot.motion(chain.mechanism);
  dynamics.compute(motion, workspace);
  Load load;
  dynamics.getTreeLoad(workspace.results(), load);
  const Load own(chain.scene);
  ASSERT_EQ(load.wrenches.size(), own.wrenches.size());
  for (std::size_t i = 0; i < own.wrenches.size(); ++i) {
    EXPECT_EQ(load.wrenches[i].force, own.wrenches[i].force);
    EXPECT_EQ(load.wrenches[i].torque, own.wrenches[i].torque);
  }
  for (const bool exists : {workspace.results().effortExists(0), !workspace.results().singular()}) {
    EXPECT_TRUE(exists);
  }
  EXPECT_EQ(workspace.results().rootAxesExist(0), kAllComponents);
  EXPECT_EQ(workspace.results().childAxesExist(0), kAllComponents);
}

TEST(Dynamics, AMotionOfAnOpenChainIsComplete) {
  OpenChain chain;
  const Dynamics dynamics(chain.mechanism, chain.scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const Motion motion = chain.robot.motion(chain.mechanism);
  Motion completed = motion;
  EXPECT_TRUE(dynamics.complete(completed, workspace));
  EXPECT_TRUE(dynamics.completeFromCloseBy(completed, workspace));
  EXPECT_EQ(completed.q, motion.q);
  EXPECT_EQ(completed.qd, motion.qd);
  EXPECT_EQ(completed.qdd, motion.qdd);
}

TEST(Dynamics, TellsWhatClosedLoopsAre) {
  const ClosedLinkage linkage({"D", "A"});
  const Dynamics dynamics(linkage.cut.mechanism, linkage.cut.scene, linkage.request);
  EXPECT_TRUE(dynamics.closed());
  EXPECT_FALSE(dynamics.closuresDetermine());  // not where a closure is actuated
  EXPECT_EQ(dynamics.coordinates(), 3);
  EXPECT_EQ(dynamics.effortNames(), (std::vector<std::string>{"A", "B", "C", "D"}));
  EXPECT_EQ(dynamics.closureNames(), (std::vector<std::string>{"D"}));
  EXPECT_EQ(dynamics.actuated(), (std::vector<bool>{true, false, false}));
  EXPECT_LE((dynamics.assembly() - linkage.motion(0.8L).q).norm(), 1e-12);
  EXPECT_EQ(dynamics.request().child_axes, linkage.request.child_axes);
  EXPECT_TRUE(dynamics.treeRequest().efforts);
  EXPECT_EQ(dynamics.treeRequest().child_axes, (std::vector<std::string>{"A", "B", "C", kGround}));
  EXPECT_EQ(dynamics.treeRequest().root_axes, (std::vector<std::string>{kGround, "C", "A", "B"}));
  EXPECT_FALSE(needsClosedLoops(dynamics.tree()));
  const ClosedLinkage by_crank;
  const Dynamics driven(by_crank.cut.mechanism, by_crank.cut.scene, by_crank.request);
  EXPECT_TRUE(driven.closuresDetermine());
  EXPECT_EQ(driven.effortNames(), (std::vector<std::string>{"A", "B", "C"}));
}

TEST(Dynamics, SpringsBetweenPointsNeedLoopsButNoClosures) {
  ClosedLinkage linkage;
  linkage.cut.scene.closures.clear();
  linkage.cut.scene.actuated.reset();
  const Dynamics dynamics(linkage.cut.mechanism, linkage.cut.scene);
  EXPECT_TRUE(dynamics.closed());
  EXPECT_FALSE(dynamics.closuresDetermine());
  EXPECT_EQ(dynamics.closureNames(), std::vector<std::string>());
  EXPECT_EQ(dynamics.actuated(), (std::vector<bool>{true, true, true}));
}

TEST(Dynamics, CompilesEverythingTheSceneAsksFor) {
  ClosedLinkage linkage;
  linkage.cut.scene.reactions = ReactionSelection::kNamed;
  linkage.cut.scene.reaction_names = {"D", "B"};
  const Dynamics dynamics(linkage.cut.mechanism, linkage.cut.scene);
  EXPECT_TRUE(dynamics.request().efforts);
  EXPECT_EQ(dynamics.request().child_axes, (std::vector<std::string>{"B", "D"}));
  EXPECT_EQ(dynamics.request().root_axes, (std::vector<std::string>{"B", "D"}));
}

// Efforts and reactions of the tree, by a route that knows of no loops.
void expectLagrangeAgrees(const Mechanism& mechanism, const Dynamics& dynamics,
                          const Motion& motion) {
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  const Results& results = workspace.results();
  Load load;
  dynamics.getTreeLoad(results, load);
  LagrangeDynamics<long double> lagrange(mechanism, dynamics.tree(), dynamics.treeRequest());
  lagrange.compute(motion, load);
  double largest = 1;
  for (const Wrench& wrench : results.root_axes) {
    largest = std::max({largest, wrench.force.norm(), wrench.torque.norm()});
  }
  for (Eigen::Index i = 0; i < dynamics.coordinates(); ++i) {
    EXPECT_NEAR(results.effort[i], lagrange.effort()[i], kTwoRoutes * largest);
  }
  const auto expectSame =
      [&](const std::vector<std::string>& names, const std::vector<Wrench>& wrenches,
          const std::vector<std::string>& tree_names, const std::vector<Wrench>& expected) {
        ASSERT_EQ(expected.size(), tree_names.size());
        for (std::size_t i = 0; i < tree_names.size(); ++i) {
          const auto found = std::find(names.begin(), names.end(), tree_names[i]);
          ASSERT_NE(found, names.end());
          const Wrench& wrench = wrenches[static_cast<std::size_t>(found - names.begin())];
          EXPECT_LE((wrench.force - expected[i].force).norm(), kTwoRoutes * largest);
          EXPECT_LE((wrench.torque - expected[i].torque).norm(), kTwoRoutes * largest);
        }
      };
  expectSame(dynamics.request().child_axes, results.child_axes, dynamics.treeRequest().child_axes,
             lagrange.childAxes());
  expectSame(dynamics.request().root_axes, results.root_axes, dynamics.treeRequest().root_axes,
             lagrange.rootAxes());
}

TEST(Dynamics, LagrangesEquationsAgreeOnTheTreeWithItsLoad) {
  OpenChain chain;
  const Dynamics open(chain.mechanism, chain.scene, chain.request);
  expectLagrangeAgrees(chain.mechanism, open, chain.robot.motion(chain.mechanism));
  const ClosedLinkage linkage;
  const Dynamics closed(linkage.cut.mechanism, linkage.cut.scene, linkage.request);
  for (const long double angle : {0.4L, 2.0L, 4.1L}) {
    expectLagrangeAgrees(linkage.cut.mechanism, closed, linkage.motion(angle));
  }
}

TEST(Dynamics, OfAnOpenChainLeavesOutEffortsThatAreNotRequested) {
  OpenChain chain;
  Request request = chain.request;
  request.efforts = false;
  const Dynamics dynamics(chain.mechanism, chain.scene, request),
      with_efforts(chain.mechanism, chain.scene, chain.request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace(), expected = with_efforts.makeWorkspace();
  const Motion motion = chain.robot.motion(chain.mechanism);
  dynamics.compute(motion, workspace);
  with_efforts.compute(motion, expected);
  EXPECT_EQ(workspace.results().effort.size(), 0);
  EXPECT_EQ(differences(workspace.results(), expected.results()), " effort");
}

// They are solved for in any case, and what compares results with other routes has them.
TEST(Dynamics, OfClosedLoopsHasItsEffortsInAnyCase) {
  const ClosedLinkage linkage({"A", "D"});
  Request request = linkage.request;
  request.efforts = false;
  const Dynamics dynamics(linkage.cut.mechanism, linkage.cut.scene, request),
      with_efforts(linkage.cut.mechanism, linkage.cut.scene, linkage.request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace(), expected = with_efforts.makeWorkspace();
  dynamics.compute(linkage.motion(0.7L), workspace);
  with_efforts.compute(linkage.motion(0.7L), expected);
  EXPECT_EQ(workspace.results().effort.size(), 4);
  EXPECT_EQ(differences(workspace.results(), expected.results()), "");
}

}  // namespace
}  // namespace virtual_work_dynamics
