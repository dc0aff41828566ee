// Deviations by what is uncertain besides coordinates: the root's motion and free turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "compound_cases.h"
#include "deviation_sources.h"
#include "dynamics/root_by_link.h"
#include "four_bar.h"
#include "moving_roots.h"
#include "random_motions.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using deviation_sources::expectDrawn;
using deviation_sources::Sources;

// A tree whose root moves, by what is uncertain.
struct MovedTree {
  explicit MovedTree(unsigned seed) : robot(seed, 8), sources(seed) {
    motion.root = randomRootMotion(sources.generator);
    scene.root_moves = true;
    scene.reactions = ReactionSelection::kNamed;
    scene.reaction_names = {kGround, "joint_1"};
    sources.ofRoot();
  }

  RandomRobot robot;
  Mechanism mechanism = readUrdf(robot.urdf());
  Motion motion = robot.motion(mechanism);
  Scene scene;
  Sources sources;
};

struct MovedFourBar {
  MovedFourBar() {
    motion.root = randomRootMotion(sources.generator);
    cut.scene.root_moves = true;
    sources.ofRoot();
  }

  FourBar four_bar;
  FourBar::Cut cut = four_bar.cut('C');
  Motion motion = cut.motion(four_bar.turnings(1.1, 3.1, -4.2));
  Sources sources{4};
};

TEST(DeviationsOfRoots, OpenChainsMatchDrawnMotions) {
  for (const unsigned seed : {2u, 5u}) {
    SCOPED_TRACE(seed);
    MovedTree tree(seed);
    tree.sources.ofCoordinates(tree.motion.q.size(), seed == 2 ? 0 : 1);
    expectDrawn(tree.mechanism, tree.scene, tree.motion, tree.sources);
  }
}

TEST(DeviationsOfRoots, ClosedLoopsMatchDrawnMotions) {
  MovedFourBar four_bar;
  four_bar.sources.ofCoordinates(four_bar.motion.q.size(), 0.1);
  expectDrawn(four_bar.cut.mechanism, four_bar.cut.scene, four_bar.motion, four_bar.sources);
}

// A sensor on a link that joints move: their doubts are the root's, too.
TEST(DeviationsOfRoots, BySensorsOnOtherLinksMatchDrawnMotions) {
  for (const unsigned seed : {2u, 5u}) {
    SCOPED_TRACE(seed);
    MovedTree tree(seed);
    tree.sources.covariance.root *= 1e-4;  // so that what the joints do to it counts
    tree.sources.ofCoordinates(tree.motion.q.size(), 1);
    tree.sources.covariance.root_link = static_cast<int>(tree.mechanism.links().size()) - 1;
    expectDrawn(tree.mechanism, tree.scene, tree.motion, tree.sources);
  }
  MovedFourBar four_bar;
  four_bar.sources.covariance.root *= 1e-6;
  four_bar.sources.ofCoordinates(four_bar.motion.q.size(), 0.1);
  four_bar.sources.covariance.root_link = 1;
  expectDrawn(four_bar.cut.mechanism, four_bar.cut.scene, four_bar.motion, four_bar.sources);
}

TEST(DeviationsOfRoots, BySensorsOnOtherLinksCoverFreeTurns) {
  unsigned seed = 1;
  while (CompoundCase(seed).mechanism.orientations() == 0) ++seed;
  CompoundCase tree(seed);
  Scene scene = tree.scene;
  scene.applied_wrenches.clear();
  scene.root_moves = true;
  Sources sources(seed);
  tree.motion.root = randomRootMotion(sources.generator);
  sources.ofRoot();
  sources.ofTurns(tree.mechanism.orientations());
  sources.ofCoordinates(tree.motion.q.size(), 0);
  sources.covariance.root_link = tree.mechanism.freeJoint(0).last + 1;
  expectDrawn(tree.mechanism, scene, tree.motion, sources);
}

// A force in inertial axes on the link whose attitude is measured: in axes of this link it turns by
// the attitude's error alone, whatever the joint before it does.
TEST(DeviationsOfRoots, LoadsInInertialAxesFollowTheMeasuredLink) {
  const Mechanism mechanism = readUrdf(
      "<robot name='r'><link name='base'/><link name='a'/><joint name='j' type='continuous'>"
      "<parent link='base'/><child link='a'/><origin xyz='0 0 1'/><axis xyz='0 1 0'/></joint>"
      "</robot>");
  const Eigen::Vector3d at(0.5, 0.3, 0.2), force(10, -4, 30);
  Scene scene;
  scene.root_moves = true;
  scene.gravity.setZero();
  AppliedWrench wrench;
  wrench.link = "a";
  wrench.at = at;
  wrench.axes = Axes::kRoot;
  scene.applied_wrenches = {wrench};
  const Deviations deviations(mechanism, scene, {});
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const LoadLaw law = [&](const Motion& motion, Load& load) {
    load.wrenches[0].force = motion.root.orientation.conjugate() * force;
    load.wrenches[0].torque.setZero();
  };
  Motion motion(1);
  motion.q[0] = 0.4;
  MotionCovariance covariance{{Eigen::Matrix3d::Zero()}};
  covariance.root_link = mechanism.linkIndex("a");
  covariance.coordinates[0](0, 0) = 1e-6;
  deviations.computeMotion(motion, covariance, law, workspace);
  EXPECT_NEAR(workspace.motion().effort[0], 0, 1e-12);
  covariance.coordinates[0].setZero();
  const Eigen::Vector3d in_link = Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY()) * force;
  for (int axis = 0; axis < 3; ++axis) {
    covariance.root.setZero();
    covariance.root(axis, axis) = 1e-8;
    deviations.computeMotion(motion, covariance, law, workspace);
    const Eigen::Vector3d change = in_link.cross(Eigen::Vector3d::Unit(axis));
    EXPECT_NEAR(workspace.motion().effort[0], 1e-4 * std::abs(at.cross(change).y()), 1e-6) << axis;
  }
}

TEST(DeviationsOfRoots, LinksThatAreNotThereAreRefused) {
  RandomRobot robot(2, 4);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene;
  scene.root_moves = true;
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const Motion motion(deviations.coordinates());
  MotionCovariance covariance;
  covariance.coordinates.assign(static_cast<std::size_t>(deviations.coordinates()),
                                Eigen::Matrix3d::Zero());
  for (const int link : {-1, static_cast<int>(mechanism.links().size())}) {
    covariance.root_link = link;
    EXPECT_THROW(deviations.computeMotion(motion, covariance, workspace), MotionError) << link;
  }
}

// A massless base that carries a point mass m at r: its weight, and what it takes to accelerate it.
TEST(DeviationsOfRoots, PointMassMatchesClosedForm) {
  const double m = 1.7;
  const Mechanism mechanism = readUrdf(
      "<robot name='r'><link name='base'><inertial><origin xyz='0 0 0'/><mass value='1.7'/>"
      "<inertia ixx='0' iyy='0' izz='0' ixy='0' ixz='0' iyz='0'/></inertial></link>"
      "<link name='flag'/><joint name='j' type='continuous'><parent link='base'/>"
      "<child link='flag'/></joint></robot>");
  Scene scene;
  scene.root_moves = true;
  Request request;
  request.root_axes = {kGround};
  const Deviations deviations(mechanism, scene, request);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  MotionCovariance covariance{{Eigen::Matrix3d::Zero()}};
  covariance.root.diagonal() << 1e-8, 4e-8, 9e-8, 1, 1, 1, 1, 1, 1, 4e-4, 1e-4, 9e-4;
  deviations.computeMotion(Motion(1), covariance, workspace);
  const Eigen::Vector3d found = workspace.motion().root_axes[0].force;
  // At rest the force is m g upwards; a turn about x leans it along y, one about y along x.
  const double weight = 9.81;
  EXPECT_NEAR(found.x(), m * std::hypot(2e-2, weight * 2e-4), 1e-6);
  EXPECT_NEAR(found.y(), m * std::hypot(1e-2, weight * 1e-4), 1e-6);
  EXPECT_NEAR(found.z(), m * 3e-2, 1e-6);
}

TEST(DeviationsOfTurns, TreesOfManyFreedomsMatchDrawnMotions) {
  int turning = 0;
  for (unsigned seed = 1; turning < 3 && seed < 60; ++seed) {
    CompoundCase tree(seed);
    if (tree.mechanism.orientations() == 0) continue;
    SCOPED_TRACE(seed);
    ++turning;
    Scene scene = tree.scene;
    scene.applied_wrenches.clear();
    Sources sources(seed);
    sources.ofTurns(tree.mechanism.orientations());
    sources.ofCoordinates(tree.motion.q.size(), 0);
    expectDrawn(tree.mechanism, scene, tree.motion, sources);
  }
  EXPECT_EQ(turning, 3);
}

// Angles behind the orientations turn on: the covariances are those of the whole turn.
TEST(DeviationsOfTurns, AnglesDoNotMatter) {
  unsigned seed = 1;
  while (CompoundCase(seed).mechanism.orientations() == 0) ++seed;
  CompoundCase tree(seed);
  Sources sources(seed);
  sources.ofTurns(tree.mechanism.orientations());
  sources.ofCoordinates(tree.motion.q.size(), 0);
  Request request;
  request.child_axes = requestedReactions(tree.mechanism, tree.scene);
  request.efforts = false;
  const Deviations deviations(tree.mechanism, tree.scene, request);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  deviations.computeMotion(tree.motion, sources.covariance, workspace);
  const std::vector<double> expected = numbersOf(workspace.motion());
  ASSERT_GT(*std::max_element(expected.begin(), expected.end()), 1e-3);
  Motion turned = tree.motion;
  const int first = tree.mechanism.anglesOf(0);
  // The same attitude by an angle about x, at which angles' rates are those of the turn.
  FreeTurn turn = freeTurnOf(tree.mechanism, 0, tree.motion);
  const Eigen::Quaterniond half(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  turned.orientations[0] = turn.orientation * half.conjugate();
  turned.q[first] = 0.5;
  const FreeTurn found = freeTurnOf(tree.mechanism, 0, turned);
  ASSERT_LT((found.angular_velocity - turn.angular_velocity).norm(), 1e-12);
  deviations.computeMotion(turned, sources.covariance, workspace);
  const std::vector<double> other = numbersOf(workspace.motion());
  for (std::size_t i = 0; i < other.size(); ++i)
    EXPECT_NEAR(other[i], expected[i], 1e-6 * (1 + expected[i])) << i;
}

}  // namespace
}  // namespace virtual_work_dynamics
