#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "four_bar.h"
#include "loops/groups.h"
#include "result_differences.h"
#include "slider_crank.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kTolerance = 1e-13;  // of numbers up to ten

TEST(ClosedLoopDynamics, PosesAndTwistsOfClosuresAreTheirChildFrames) {
  const SliderCrank slider_crank;
  Scene scene = slider_crank.scene("joint_1");
  const double turn = 0.4;
  scene.closures[0].child.rpy.z() = turn;
  Request request;
  request.root_axes = {"pin", "joint_1", "joint_3"};
  request.poses = request.twists = true;
  ClosedLoops dynamics(slider_crank.mechanism(), scene, request);
  const Motion motion = slider_crank.motion(0.7, 2, 1);
  dynamics.compute(motion);
  EXPECT_NEAR(dynamics.poses()[0].position.x(), motion.q[2], kTolerance);
  EXPECT_NEAR(dynamics.poses()[0].orientation.angularDistance(
                  Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))),
              0, 1e-7);  // as sharp as an angle is that comes from a cosine
  EXPECT_NEAR(dynamics.twists()[0].linear.x(), motion.qd[2], kTolerance);
  EXPECT_EQ(dynamics.twists()[0].angular.norm(), 0);
  EXPECT_NEAR(dynamics.poses()[1].orientation.angularDistance(Eigen::Quaterniond::Identity()), 0.7,
              1e-7);
  EXPECT_EQ(dynamics.twists()[1].angular.z(), 2);
  EXPECT_NEAR(dynamics.poses()[2].position.x(), motion.q[2], kTolerance);
}

// Without them, the component reported along an axis is zero; everything computed stays the same.
TEST(ClosedLoopDynamics, ActiveComponentsCanBeLeftOut) {
  const FourBar four_bar;
  for (const char pivot : {'A', 'C'}) {
    FourBar::Cut cut = four_bar.cut(pivot);
    cut.scene.redundancy.policy = RedundancyPolicy::kStiffness;
    const Motion motion = cut.motion(four_bar.turnings(1.1, 3, -2));
    const ClosedLoopResults with(cut.mechanism, cut.scene, motion);
    cut.scene.include_active = false;
    const ClosedLoopResults without(cut.mechanism, cut.scene, motion);
    EXPECT_GT(std::abs(with.child("A").torque.z()), 1);
    EXPECT_NEAR(without.child("A").torque.z(), 0, kTolerance);
    EXPECT_EQ(without.child("A").force, with.child("A").force);
    EXPECT_LE((without.child("A").torque - with.child("A").torque).head(2).norm(), kTolerance);
    EXPECT_EQ(without.dynamics.effort(), with.dynamics.effort());
    EXPECT_EQ(without.child("D").force, with.child("D").force);
  }
}

TEST(ClosedLoopDynamics, StaticScenesIgnoreVelocitiesAndAccelerations) {
  const FourBar four_bar;
  FourBar::Cut cut = four_bar.cut('D');
  Motion motion = cut.motion(four_bar.turnings(1.1, 0, 0));
  const ClosedLoopResults at_rest(cut.mechanism, cut.scene, motion);
  cut.scene.static_motion = true;
  motion.qd << 1, 2, 3;
  motion.qdd << 4, 5, 6;
  const ClosedLoopResults still(cut.mechanism, cut.scene, motion);
  EXPECT_NEAR(still.dynamics.effort()[0], at_rest.dynamics.effort()[0], kTolerance);
  EXPECT_EQ(still.dynamics.residuals()[0].velocity, 0);
  EXPECT_EQ(still.dynamics.residuals()[0].acceleration, 0);
}

// Without the flags everything else stays the same, also where a position is singular.
TEST(ClosedLoopDynamics, FlagsAreFoundOnRequestOnly) {
  const SliderCrank slider_crank(1.5, true);
  Scene scene = slider_crank.scene("joint_3");
  scene.actuated->push_back("joint_4");
  scene.gravity << 0, -9.81, 0;
  Request request;
  request.child_axes = request.root_axes = {"pin", "joint_1"};
  ClosedLoops with(slider_crank.mechanism(), scene, request);
  request.determinacy = false;
  ClosedLoops without(slider_crank.mechanism(), scene, request);
  for (const double angle : {0.7, 0.0, 0.4}) {  // singular in between
    const Motion motion = slider_crank.motion(angle, 2, 1, 4);
    with.compute(motion);
    without.compute(motion);
    EXPECT_EQ(with.results().singular(), angle == 0);
    EXPECT_TRUE(without.effortDetermined().empty());
    EXPECT_TRUE(without.childAxesDetermined().empty());
    EXPECT_TRUE(without.rootAxesDetermined().empty());
    EXPECT_EQ(without.effort(), with.effort());
    EXPECT_EQ(without.effortExists(), with.effortExists());
    EXPECT_EQ(without.childAxesExist(), with.childAxesExist());
    EXPECT_EQ(without.rootAxesExist(), with.rootAxesExist());
    EXPECT_EQ(without.rootAxesExist()[0] == kAllComponents, angle != 0);
    for (std::size_t i = 0; i < request.child_axes.size(); ++i) {
      EXPECT_EQ(without.childAxes()[i].force, with.childAxes()[i].force);
      EXPECT_EQ(without.childAxes()[i].torque, with.childAxes()[i].torque);
    }
    EXPECT_EQ(without.determinacy().redundant_constraints,
              with.determinacy().redundant_constraints);
  }
}

TEST(ClosedLoopDynamics, ALoadReplacesTheAppliedWrenchesOfOneSample) {
  const FourBar four_bar;
  FourBar::Cut cut = four_bar.cut('D');
  AppliedWrench push;
  push.link = "coupler";
  push.at << 0.2, 0.1, 0;
  cut.scene.applied_wrenches = {push};
  const Motion motion = cut.motion(four_bar.turnings(1.1, 3, -2));
  PointSpring spring;
  spring.link_a = "base";
  spring.link_b = "coupler";
  spring.stiffness = 3;
  cut.scene.springs = {spring};
  const ClosedLoopResults own(cut.mechanism, cut.scene, motion);
  ClosedLoopResults replaced(cut.mechanism, cut.scene);
  cut.scene.applied_wrenches[0].force << 10, -20, 5;
  cut.scene.applied_wrenches[0].torque << 1, 2, 3;
  const ClosedLoopResults given(cut.mechanism, cut.scene, motion);
  Load load;
  load.wrenches = {{{10, -20, 5}, {1, 2, 3}}};
  for (int i = 0; i < 2; ++i) {
    replaced.dynamics.compute(motion, load);
    EXPECT_EQ(differences(replaced.dynamics.results(), given.dynamics.results()), "");
    EXPECT_NE(differences(replaced.dynamics.results(), own.dynamics.results()), "");
    replaced.dynamics.compute(motion);
    EXPECT_EQ(differences(replaced.dynamics.results(), own.dynamics.results()), "");
  }
  load.wrenches.resize(2);
  EXPECT_THROW(replaced.dynamics.compute(motion, load), SceneError);
  EXPECT_THROW(replaced.dynamics.compute(motion, Load()), SceneError);
}

// Two loops share only the weld on which both stand: each is solved by itself, and what each leaves
// open of the weld's reaction counts.
TEST(ClosedLoopDynamics, LoopsOnOneWeldAreSolvedByThemselves) {
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  builder.add(JointType::kFixed, 0, Vector3l::UnitZ(), R, Vector3l(0, 0, 0.3L));
  builder.add(JointType::kPrismatic, 1, Vector3l::UnitX(), R, Vector3l::Zero());
  builder.add(JointType::kPrismatic, 1, Vector3l::UnitY(), R, Vector3l::Zero());
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.actuated.emplace();
  const auto rods = [&](const std::string& link, const Eigen::Vector3d& from, int count) {
    for (int i = 0; i < count; ++i) {
      Closure rod;
      rod.name = "rod_" + std::to_string(scene.closures.size());
      rod.type = ClosureType::kDistance;
      rod.parent = {"link_0", from + Eigen::Vector3d(0, 0, 0.3), {0, 0, 0}};
      rod.child.link = link;
      scene.closures.push_back(rod);
    }
  };
  rods("link_2", {2, 0, 0}, 2);
  rods("link_3", {0, 2, 0}, 3);
  scene.reactions = ReactionSelection::kNamed;
  scene.reaction_names = {"joint_1", "joint_2", "joint_3", "rod_0", "rod_4", "ground"};
  const ClosedLoopResults results(mechanism, scene, Motion(2));
  EXPECT_EQ(results.dynamics.determinacy().redundant_constraints, 3);
  EXPECT_EQ(results.dynamics.determinacy().rank, 2);
  // All rods of a loop pull in one line: their sum is determined, and so is all behind them.
  const Determined all{true, true, true, true, true, true};
  for (const char* name : {"joint_1", "joint_2", "joint_3", "ground"}) {
    EXPECT_EQ(results.rootDetermined(name), all) << name;
  }
  EXPECT_EQ(results.rootDetermined("rod_0"), (Determined{false, true, true, true, true, true}));
  EXPECT_EQ(results.rootDetermined("rod_4"), (Determined{true, false, true, true, true, true}));
  // In another line they twist the weld, each loop about its own axis.
  Scene twisted = scene;
  twisted.closures[1].parent.xyz.z() += 0.5;
  twisted.closures[1].child.xyz.z() += 0.5;
  const ClosedLoopResults with(mechanism, twisted, Motion(2));
  EXPECT_EQ(with.rootDetermined("joint_1"), (Determined{true, true, true, true, false, true}));
  EXPECT_EQ(with.rootDetermined("joint_3"), all);
}

TEST(LoopGroups, LengthIsTheLargestDistanceOnALoop) {
  const FourBar four_bar;
  const auto turnings = four_bar.turnings(3.0, 0, 0);
  const FourBar::Vector2 B = four_bar.lengths[0] * FourBar::along(turnings[0].angle);
  const FourBar::Vector2 D(four_bar.lengths[3], 0);
  for (const char pivot : {'A', 'B', 'C', 'D'}) {
    const FourBar::Cut cut = four_bar.cut(pivot);
    LoopKinematics kinematics(cut.mechanism, cut.scene);
    const auto groups = loopGroups(cut.mechanism, kinematics);
    ASSERT_EQ(groups.size(), 1u);
    EXPECT_EQ(groups[0].coordinates, (std::vector<int>{0, 1, 2}));
    kinematics.setPosition(cut.motion(turnings).q);
    EXPECT_NEAR(loopLength(groups, kinematics), static_cast<double>((D - B).norm()), kTolerance);
    EXPECT_EQ(loopLength({}, kinematics), 1);
  }
}

// The positions given close the linkage to three digits only, and everything is actuated.
TEST(ClosedLoopDynamics, OverActuatedLinkageIsAssembledFromRoughPositions) {
  const FourBar four_bar;
  FourBar::Cut cut = four_bar.cut('D');
  cut.scene.actuated.reset();
  for (NamedNumber& start : cut.scene.assembly) start.value = std::round(start.value * 1e3) / 1e3;
  ClosedLoopResults results(cut.mechanism, cut.scene);
  Motion motion(3);
  motion.q = results.dynamics.assembly();
  results.dynamics.compute(motion);
  EXPECT_LE(results.dynamics.residuals()[0].position, 1e-15);
  EXPECT_NEAR(motion.q[0], 0.8, 2e-3);
  EXPECT_EQ(results.dynamics.determinacy().redundancy, 5);
  EXPECT_EQ(results.dynamics.determinacy().redundant_constraints, 3);
}

}  // namespace
}  // namespace virtual_work_dynamics
