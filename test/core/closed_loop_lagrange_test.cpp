#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "closed_chain.h"
#include "closed_loop_results.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

// Relative to the largest effort or force, times the condition of the loops: two routes in double.
constexpr double kTolerance = 1e-11;
constexpr double kWellConditioned = 300;

// Closures as they act on their links, for a route that knows of no loops.
Scene openScene(const ClosedLoopResults& results, const Scene& scene) {
  Scene open;
  open.gravity = scene.gravity;
  open.joints = scene.joints;
  open.applied_wrenches = scene.applied_wrenches;
  for (const Closure& closure : scene.closures) {
    const Wrench& reaction = results.root(closure.name);
    AppliedWrench on_child;
    on_child.axes = Axes::kRoot;
    on_child.link = closure.child.link;
    on_child.at = closure.child.xyz;
    on_child.force = reaction.force;
    on_child.torque = reaction.torque;
    open.applied_wrenches.push_back(on_child);
  }
  return open;
}

// Both links meet at the child's origin, where the opposite acts on the parent.
void addOppositeOnParents(const Mechanism& mechanism, const Motion& motion,
                          const ClosedLoopResults& results, const Scene& scene, Scene& open) {
  Request request;
  request.poses = true;
  for (const Joint& joint : mechanism.joints()) request.root_axes.push_back(joint.name);
  const InverseDynamics tree(mechanism, Scene(), request);
  Workspace workspace = tree.makeWorkspace();
  tree.compute(motion, workspace);
  const auto poseOf = [&](const std::string& link) {
    const int index = mechanism.linkIndex(link);
    return index == 0 ? Pose() : workspace.poses()[static_cast<std::size_t>(index - 1)];
  };
  for (const Closure& closure : scene.closures) {
    const Pose child = poseOf(closure.child.link), parent = poseOf(closure.parent.link);
    const Eigen::Vector3d at = child.position + child.orientation * closure.child.xyz;
    const Wrench& reaction = results.root(closure.name);
    AppliedWrench on_parent;
    on_parent.axes = Axes::kRoot;
    on_parent.link = closure.parent.link;
    on_parent.at = parent.orientation.inverse() * (at - parent.position);
    on_parent.force = -reaction.force;
    on_parent.torque = -reaction.torque;
    open.applied_wrenches.push_back(on_parent);
  }
}

// The closures' wrenches make Lagrange's equations give no effort where nothing is actuated, and
// the same efforts and reactions elsewhere.
void expectLagrangeAgrees(ClosedChain& chain, int samples, int& compared) {
  const Mechanism& mechanism = chain.mechanism();
  const Scene& scene = chain.scene();
  ClosedLoopResults results(mechanism, scene);
  ClosedLoops& dynamics = results.dynamics;
  Motion motion(mechanism.coordinates().size());
  for (int n = 0; n < samples; ++n) {
    const Motion random = chain.builder().motion();
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      motion.q[i] = dynamics.assembly()[i];
      if (!dynamics.actuated()[static_cast<std::size_t>(i)]) continue;
      motion.q[i] += 0.02 * random.q[i];
      motion.qd[i] = random.qd[i];
      motion.qdd[i] = random.qdd[i];
    }
    if (!dynamics.complete(motion)) continue;
    dynamics.compute(motion);
    if (dynamics.determinacy().condition > kWellConditioned) continue;
    ++compared;
    EXPECT_EQ(dynamics.determinacy().redundancy, 0);
    Scene open = openScene(results, scene);
    addOppositeOnParents(mechanism, motion, results, scene, open);
    Request request;
    for (const std::string& name : dynamics.request().root_axes) {
      if (mechanism.jointIndex(name) >= 0) request.root_axes.push_back(name);
    }
    LagrangeDynamics<double> lagrange(mechanism, open, request);
    lagrange.compute(motion);
    double largest = dynamics.effort().cwiseAbs().maxCoeff();
    for (const Wrench& wrench : dynamics.rootAxes()) {
      largest = std::max({largest, wrench.force.norm(), wrench.torque.norm()});
    }
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      EXPECT_NEAR(lagrange.effort()[i], dynamics.effort()[i], kTolerance * largest);
      const bool actuated = dynamics.actuated()[static_cast<std::size_t>(i)];
      EXPECT_TRUE(actuated || dynamics.effort()[i] == 0);
    }
    for (std::size_t i = 0; i < request.root_axes.size(); ++i) {
      const Wrench& wrench = results.root(request.root_axes[i]);
      EXPECT_LE((lagrange.rootAxes()[i].force - wrench.force).norm(), kTolerance * largest);
      EXPECT_LE((lagrange.rootAxes()[i].torque - wrench.torque).norm(), kTolerance * largest);
    }
  }
}

TEST(ClosedLoopDynamics, LagrangesEquationsAgreeForEveryTypeOfClosure) {
  for (int type = 0; type < 8; ++type) {
    // Closed to ground, and to a link that moves.
    for (const int parent : {0, 1}) {
      int compared = 0;
      for (unsigned seed = 1; seed <= 10; ++seed) {
        ClosedChain chain(seed, 8);
        chain.close(static_cast<ClosureType>(type), parent, 8);
        expectLagrangeAgrees(chain, 3, compared);
      }
      EXPECT_GE(compared, 10) << "type " << type << " on link " << parent;
    }
  }
}

TEST(ClosedLoopDynamics, LagrangesEquationsAgreeWithTwoLoopsAndJointTerms) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    ClosedChain chain(seed, 11);
    chain.close(ClosureType::kSpherical, 1, 7);
    chain.close(ClosureType::kRevolute, 0, 11);
    chain.scene().joints = {{"joint_10", 30, 0.2, 1.0, 0.5, 0.1, 0.02},
                            {"joint_1", 5, 0, 2.0, 0.1, 0.1, 0.3}};
    AppliedWrench push;
    push.link = "link_5";
    push.force << 3, -4, 5;
    push.torque << 1, 2, -1;
    chain.scene().applied_wrenches = {push};
    expectLagrangeAgrees(chain, 3, compared);
  }
  EXPECT_GE(compared, 10);
}

// Which closure comes first is nobody's business.
TEST(ClosedLoopDynamics, OrderOfClosuresDoesNotMatter) {
  ClosedChain chain(2, 11);
  chain.close(ClosureType::kSpherical, 1, 7);
  chain.close(ClosureType::kRevolute, 0, 11);
  Scene swapped = chain.scene();
  std::swap(swapped.closures[0], swapped.closures[1]);
  Motion motion(11);
  motion.q = chain.position();
  for (Eigen::Index i = 0; i < 3; ++i) motion.qd[i] = 0.4, motion.qdd[i] = -1.2;
  ClosedLoopResults one(chain.mechanism(), chain.scene());
  ASSERT_TRUE(one.dynamics.complete(motion));
  one.dynamics.compute(motion);
  const ClosedLoopResults other(chain.mechanism(), swapped, motion);
  const double largest = one.dynamics.effort().cwiseAbs().maxCoeff();
  EXPECT_LE((one.dynamics.effort() - other.dynamics.effort()).norm(), kTolerance * largest);
  for (const std::string& name : one.dynamics.request().root_axes) {
    const double force = std::max(largest, one.root(name).force.norm());
    EXPECT_LE((one.root(name).force - other.root(name).force).norm(), kTolerance * force);
    EXPECT_LE((one.root(name).torque - other.root(name).torque).norm(), kTolerance * force);
  }
}

// What a closure leaves free bears nothing.
TEST(ClosedLoopDynamics, ClosuresBearNothingWhereTheyMove) {
  const std::vector<std::vector<int>> free = {{}, {5}, {2}, {2, 5}, {}, {3, 4, 5}, {0, 1, 5}, {}};
  for (int type = 0; type < 7; ++type) {
    ClosedChain chain(3, 8);
    chain.close(static_cast<ClosureType>(type), 0, 8);
    Motion motion(8);
    motion.q = chain.position();
    const ClosedLoopResults results(chain.mechanism(), chain.scene(), motion);
    const Wrench& wrench = results.child("closure_0");
    Eigen::Matrix<double, 6, 1> numbers;
    numbers << wrench.force, wrench.torque;
    EXPECT_GT(numbers.norm(), 1e-3);
    for (const int i : free[static_cast<std::size_t>(type)]) {
      EXPECT_LE(std::abs(numbers[i]), 1e-14 * numbers.norm()) << "type " << type;
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
