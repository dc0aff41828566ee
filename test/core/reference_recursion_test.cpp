#include "reference_recursion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pendulum_closed_form.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
// Both evaluate the same formulas in double, in frames and orders of their own: sums of a few
// hundred terms, each of which loses half a unit of its last digit.
constexpr double kReordered = 500 * kEps;

double largestOf(const std::vector<ReferenceBody>& bodies) {
  double largest = 1;
  for (const ReferenceBody& body : bodies) {
    for (const auto& v : {body.v, body.w, body.f, body.m}) largest = std::max(largest, v.norm());
  }
  return largest;
}

void expectClose(const Eigen::VectorXd& found, const Eigen::VectorXd& expected, double largest) {
  ASSERT_EQ(found.size(), expected.size());
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    ASSERT_TRUE(std::isfinite(found[i]) && std::isfinite(expected[i]));
    EXPECT_NEAR(found[i], expected[i], kReordered * largest) << "entry " << i;
  }
}

// Efforts, reactions in both axes and velocities, of ground and of fixed joints too.
void expectReference(const Mechanism& mechanism, const Scene& scene, const Motion& motion) {
  Request request;
  request.child_axes.emplace_back(kGround);
  for (const Joint& joint : mechanism.joints()) request.child_axes.push_back(joint.name);
  request.root_axes = request.child_axes;
  request.twists = true;
  const InverseDynamics dynamics(mechanism, scene, request);
  Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);

  std::vector<ReferenceBody> bodies = referenceMotion(mechanism, motion);
  const Eigen::VectorXd effort = referenceForces(mechanism, scene, bodies);
  const double largest = largestOf(bodies);
  expectClose(workspace.effort(), effort, largest);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    SCOPED_TRACE(request.child_axes[k]);
    expectClose(workspace.childAxes()[k].force, bodies[k].F, largest);
    expectClose(workspace.childAxes()[k].torque, bodies[k].M, largest);
    expectClose(workspace.rootAxes()[k].force, bodies[k].f, largest);
    expectClose(workspace.rootAxes()[k].torque, bodies[k].m, largest);
    const Eigen::Matrix3d to_root = bodies[k].a_0.transpose();
    expectClose(workspace.twists()[k].linear, to_root * bodies[k].v, largest);
    expectClose(workspace.twists()[k].angular, to_root * bodies[k].w, largest);
  }
}

bool has(const Mechanism& mechanism, JointType type) {
  const auto& joints = mechanism.joints();
  return std::any_of(joints.begin(), joints.end(),
                     [&](const Joint& joint) { return joint.type == type; });
}

bool hasMimic(const Mechanism& mechanism) {
  const auto& joints = mechanism.joints();
  return std::any_of(joints.begin(), joints.end(), [](const Joint& joint) { return joint.mimics; });
}

bool branches(const Mechanism& mechanism) {
  const auto& joints = mechanism.joints();
  return std::adjacent_find(joints.begin(), joints.end(), [](const Joint& a, const Joint& b) {
           return b.parent_link != a.child_link;
         }) != joints.end();
}

TEST(ReferenceRecursion, AgreesOnThePapersPendulum) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  for (int i = 0; i <= 6; ++i) expectReference(mechanism, pendulumScene(), pendulumMotion(i));
}

// The sample has what the recursion has a case for.
TEST(ReferenceRecursion, AgreesOnTrees) {
  bool prismatic = false, fixed = false, mimic = false, branched = false;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot robot(seed, 3 + static_cast<int>(seed));
    const Mechanism mechanism = readUrdf(robot.urdf());
    Scene scene;
    scene.gravity = {0.3, -1.1, -9.81};
    expectReference(mechanism, scene, robot.motion(mechanism));
    prismatic = prismatic || has(mechanism, JointType::kPrismatic);
    fixed = fixed || has(mechanism, JointType::kFixed);
    mimic = mimic || hasMimic(mechanism);
    branched = branched || branches(mechanism);
  }
  EXPECT_TRUE(prismatic && fixed && mimic && branched);
}

TEST(ReferenceRecursion, AgreesOnAppliedWrenches) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    RandomRobot robot(seed, 8);
    const Mechanism mechanism = readUrdf(robot.urdf());
    Scene scene;
    for (const Axes axes : {Axes::kLink, Axes::kRoot, Axes::kLink, Axes::kRoot}) {
      AppliedWrench applied;
      applied.link = mechanism.links()[static_cast<std::size_t>(robot.pick(8))].name;
      applied.axes = axes;
      applied.at = {robot.uniform(-1, 1), robot.uniform(-1, 1), robot.uniform(-1, 1)};
      applied.force = {robot.uniform(-20, 20), robot.uniform(-20, 20), robot.uniform(-20, 20)};
      applied.torque = {robot.uniform(-5, 5), robot.uniform(-5, 5), robot.uniform(-5, 5)};
      scene.applied_wrenches.push_back(applied);
    }
    expectReference(mechanism, scene, robot.motion(mechanism));
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
