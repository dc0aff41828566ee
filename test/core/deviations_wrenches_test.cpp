// Deviations by wrenches that are uncertain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "deviation_sources.h"
#include "dynamics/effort_doubts.h"
#include "dynamics/live_wrenches.h"
#include "four_bar.h"
#include "random_motions.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using deviation_sources::expectDrawn;
using deviation_sources::kDraws;
using deviation_sources::sceneWithWrenches;
using deviation_sources::Sources;

TEST(DeviationsOfWrenches, OpenAndClosedMatchDrawnLoads) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('B');
  RandomRobot robot(5, 8);
  const Mechanism tree = readUrdf(robot.urdf());
  for (const bool closed : {false, true}) {
    SCOPED_TRACE(closed);
    const Mechanism& mechanism = closed ? cut.mechanism : tree;
    Scene scene = closed ? cut.scene : Scene();
    const std::size_t last = mechanism.links().size() - 1;
    scene.applied_wrenches =
        sceneWithWrenches({mechanism.link(static_cast<int>(last)).name, mechanism.link(1).name,
                           mechanism.link(static_cast<int>(last) - 1).name})
            .applied_wrenches;
    scene.applied_wrenches[0].deviation = WrenchDeviation{1, 1};
    scene.applied_wrenches[1].axes = Axes::kRoot;
    scene.applied_wrenches[2].axes = Axes::kRoot;
    scene.applied_wrenches[2].deviation = WrenchDeviation{1, 1};
    const Motion motion =
        closed ? cut.motion(four_bar.turnings(1.1, 3.1, -4.2)) : robot.motion(tree);
    Sources sources(8);
    sources.ofWrenches(3);
    sources.ofCoordinates(motion.q.size(), 0.01);
    expectDrawn(mechanism, scene, motion, sources);
  }
}

TEST(DeviationsOfWrenches, TheScenesCountUnlessOthersAreGiven) {
  RandomRobot robot(5, 8);
  const Mechanism mechanism = readUrdf(robot.urdf());
  const Motion motion = robot.motion(mechanism);
  Scene scene = sceneWithWrenches({mechanism.link(7).name});
  scene.applied_wrenches[0].deviation = WrenchDeviation{2, 0.3};
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  MotionCovariance covariance;
  covariance.coordinates.assign(mechanism.coordinates().size(), Eigen::Matrix3d::Zero());
  deviations.computeMotion(motion, covariance, workspace);
  const Eigen::VectorXd own = workspace.motion().effort;
  EXPECT_GT(own.maxCoeff(), 0);
  covariance.wrenches = wrenchCovariances(scene);
  deviations.computeMotion(motion, covariance, workspace);
  EXPECT_EQ(workspace.motion().effort, own);
  covariance.wrenches[0] *= 4;
  deviations.computeMotion(motion, covariance, workspace);
  EXPECT_LT((workspace.motion().effort - 2 * own).norm(), 1e-9 * own.norm());
  covariance.wrenches.resize(2, WrenchCovariance::Zero());
  EXPECT_THROW(deviations.computeMotion(motion, covariance, workspace), MotionError);
  covariance.wrenches.clear();
  covariance.turns.resize(1, TurnCovariance::Zero());
  EXPECT_THROW(deviations.computeMotion(motion, covariance, workspace), MotionError);
  scene.applied_wrenches[0].deviation = WrenchDeviation{-1, 0};
  EXPECT_THROW(Deviations(mechanism, scene, Request()), SceneError);
}

// Of a sensor whose frame is another link's, between two measurements and behind the last one.
TEST(DeviationsOfWrenches, LiveOnesAreThoseOfDrawnMeasurements) {
  const Mechanism mechanism = readUrdf(
      "<robot name='r'><link name='base'/><link name='arm'/><link name='sensor'/>"
      "<joint name='a' type='continuous'><parent link='base'/><child link='arm'/><axis xyz='1 0 "
      "0'/>"
      "</joint><joint name='b' type='continuous'><parent link='arm'/><child link='sensor'/>"
      "<origin xyz='0.3 -0.5 0.2' rpy='0.3 0.4 0.5'/><axis xyz='0 1 0'/></joint></robot>");
  Scene scene;
  AppliedWrench live;
  live.link = "arm";
  live.name = "push";
  live.live = true;
  live.invert = true;
  live.deviation = WrenchDeviation{0.4, 0.03};
  scene.applied_wrenches = {AppliedWrench(), live};
  scene.applied_wrenches[0].link = "base";
  Motion motion(2);
  motion.q << 0.4, -0.9;
  std::mt19937 generator(6);
  std::normal_distribution<double> normal;
  for (const std::int64_t at : {1003000000LL, 1010000000LL, 1020000000LL}) {
    std::vector<WrenchCovariance> covariances(2, WrenchCovariance::Constant(7));
    WrenchCovariance sum = WrenchCovariance::Zero();
    for (int i = 0; i < kDraws; ++i) {
      LiveWrenches wrenches(mechanism, scene, 0.1);
      for (const std::int64_t stamp : {1000000000LL, 1010000000LL}) {
        MeasuredWrench measured{stamp, 2, {}};
        for (int c = 0; c < 3; ++c) {
          measured.value.force[c] = 0.4 * normal(generator);
          measured.value.torque[c] = 0.03 * normal(generator);
        }
        wrenches.push(0, measured);
      }
      ASSERT_FALSE(wrenches.read(at));
      Load load(scene);
      wrenches.getLoad(motion, load);
      wrenches.getCovariances(covariances);
      Eigen::Matrix<double, 6, 1> value;
      value << load.wrenches[1].force, load.wrenches[1].torque;
      sum += value * value.transpose() / kDraws;
    }
    EXPECT_EQ(covariances[0], WrenchCovariance::Constant(7));
    const WrenchCovariance& found = covariances[1];
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const double scale = std::sqrt(found(i, i) * found(j, j));
        EXPECT_NEAR(sum(i, j), found(i, j), 6 / std::sqrt(double(kDraws)) * scale) << i << j;
      }
    }
  }
}

TEST(DeviationsOfSources, DoubtsNameTheCause) {
  RandomRobot robot(5, 8);
  const Mechanism mechanism = readUrdf(robot.urdf());
  Scene scene = sceneWithWrenches({mechanism.link(7).name, mechanism.link(6).name});
  scene.root_moves = true;
  scene.applied_wrenches[0].deviation = WrenchDeviation{1e-3, 1e-3};
  scene.applied_wrenches[1].deviation = WrenchDeviation{1e-3, 1e-3};
  scene.applied_wrenches[1].name = "push";
  Motion motion = robot.motion(mechanism);
  std::mt19937 generator(3);
  motion.root = randomRootMotion(generator);
  const Deviations deviations(mechanism, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const std::vector<std::string> causes = otherCauses(scene);
  const std::vector<std::string> expected = {
      "the noise of the root's orientation",
      "the noise of the root's angular velocity",
      "the noise of the root's angular acceleration",
      "the noise of the root's acceleration",
      "the noise of the applied wrench on '" + mechanism.link(7).name + "'",
      "the noise of the wrench 'push'"};
  ASSERT_EQ(causes, expected);
  for (std::size_t cause = 0; cause < causes.size(); ++cause) {
    MotionCovariance covariance;
    covariance.coordinates.assign(mechanism.coordinates().size(), Eigen::Matrix3d::Zero());
    covariance.wrenches.assign(2, WrenchCovariance::Zero());
    if (cause < 4) {
      covariance.root.diagonal().segment<3>(3 * static_cast<Eigen::Index>(cause)).setConstant(1e-6);
    } else {
      covariance.wrenches[cause - 4].setIdentity();
    }
    deviations.computeMotion(motion, covariance, workspace);
    EffortDoubts doubts(deviations.effortNames(), deviations.residuals(),
                        mechanism.coordinateNames(), causes);
    doubts.add(Eigen::VectorXd::Ones(deviations.coordinates()), workspace, true, false);
    const std::vector<EffortDoubt> found = doubts.above(1e-9);
    ASSERT_FALSE(found.empty()) << cause;
    for (const EffortDoubt& doubt : found) EXPECT_EQ(doubt.cause, causes[cause]);
  }
  AppliedWrench bare;
  bare.name = "bare";
  bare.live = true;
  scene.applied_wrenches.push_back(bare);
  EXPECT_EQ(exactWrenches(scene), std::vector<std::string>{"bare"});
}

}  // namespace
}  // namespace virtual_work_dynamics
