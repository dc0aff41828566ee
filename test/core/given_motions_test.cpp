// Motions that are given by other coordinates than the actuated ones, against closed forms.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/number_text.h"
#include "dynamics/shifted_samples.h"
#include "exact_derivatives.h"
#include "loop_examples.h"
#include "robot_builder.h"
#include "slider_crank.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/passive_joints.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

// A closed form in long double against a least-squares solution in double.
constexpr double kClosedForm = 1e-12;
const Request kNothing{false, {}, {}, false, false};

void expectNear(const Eigen::VectorXd& found, const Eigen::VectorXd& expected) {
  ASSERT_TRUE(found.allFinite());
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    EXPECT_LE(std::abs(found[i] - expected[i]), kClosedForm * std::max(1.0, std::abs(expected[i])))
        << i;
  }
}

// The driven numbers of the platform's pose. The quaternion's length is no matter.
Motion drivenPose(long double t, long double length = 1) {
  using Turn = Eigen::AngleAxis<long double>;
  const auto numbers = [&](long double time) {
    const Eigen::Quaternion<long double> turn =
        Turn(0.15L * std::cos(2 * time), Vector3l::UnitX()) *
        Turn(0.2L * std::sin(2.5L * time), Vector3l::UnitY()) *
        Turn(0.3L * std::sin(time), Vector3l::UnitZ());
    VectorXl pose(7);
    pose << platformPose(time).p, length * (1 + 0.3L * std::sin(time)) * turn.coeffs();
    return pose;
  };
  const auto exact = withDerivatives(numbers, t);
  Motion driven;
  driven.q = exact.value.cast<double>();
  driven.qd = exact.rate.cast<double>();
  driven.qdd = exact.acceleration.cast<double>();
  return driven;
}

Given platformGiven(const Mechanism& mechanism) {
  Given given;
  given.coordinates.assign(mechanism.coordinates().size(), false);
  given.links = {mechanism.linkIndex("platform")};
  return given;
}

// The inverse kinematics of the Stewart-Gough platform: the length of a leg is that of the vector
// from its base point to its platform point, and its cross has that vector's angles.
TEST(GivenMotions, PosesMoveTheLegsOfAPlatform) {
  const LoopExample example("stewart_gough");
  const Dynamics dynamics(example.mechanism, example.scene, kNothing);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  PassiveJoints follower(example.mechanism, dynamics, platformGiven(example.mechanism));
  double worst = 0;
  for (int i = 0; i < 120; ++i) {
    const long double t = i < 100 ? 0.037L * i : 1.3L * i;  // close by, and far away
    Motion motion(dynamics.coordinates());
    // Also the opposite quaternion, and one of another length.
    const Motion driven = drivenPose(t, i % 3 == 1 ? -1 : i % 3 == 2 ? 2.5L : 1);
    ASSERT_TRUE(follower.complete(motion, driven, dynamics, workspace))
        << follower.whyOpen(dynamics, workspace);
    const Motion expected = motionAt(example.mechanism, stewartGoughAt, t);
    expectNear(motion.q, expected.q);
    expectNear(motion.qd, expected.qd);
    expectNear(motion.qdd, expected.qdd);
    worst = std::max(worst, (motion.q - expected.q).lpNorm<Eigen::Infinity>());
  }
  RecordProperty("largest difference", numberText(worst));
}

TEST(GivenMotions, PosesOutOfReachAreNamed) {
  const LoopExample example("planar_3rrr");
  const Dynamics dynamics(example.mechanism, example.scene, kNothing);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Given given;
  given.coordinates.assign(example.mechanism.coordinates().size(), false);
  given.links = {example.mechanism.linkIndex("platform")};
  ASSERT_GT(given.links[0], 0);
  PassiveJoints follower(example.mechanism, dynamics, given);
  Motion motion(dynamics.coordinates()), driven(7);
  driven.q << 2, 0, 0, 0, 0, 0, 1;
  EXPECT_FALSE(follower.complete(motion, driven, dynamics, workspace));
  EXPECT_NE(follower.whyOpen(dynamics, workspace).find("the loops cannot be closed: "),
            std::string::npos);
}

// The slide as the free axis of a closure on a table that turns.
TEST(GivenMotions, TheSlideOfAClosureMovesOnATable) {
  const Mechanism mechanism = sliderCrankOfPins(true);
  Scene scene;
  scene.closures = {slideOfPins(true)};
  scene.actuated = std::vector<std::string>{"joint_1", "slide"};
  scene.given = scene.actuated;
  scene.assembly = {{"joint_2", 0.7}, {"joint_3", -1.0}, {"joint_4", 0.3}};
  const Dynamics dynamics(mechanism, scene, kNothing);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  PassiveJoints follower(mechanism, dynamics);
  for (int i = 0; i < 20; ++i) {
    const Motion crank = SliderCrank::motion(0.5 + 0.1 * i, 1.5, -0.7);
    Motion motion(4), driven(1);
    motion.q[0] = 0.2 * i;
    motion.qd[0] = 2.1;
    motion.qdd[0] = -1.3;
    driven.q[0] = crank.q[2] - 0.2;
    driven.qd[0] = crank.qd[2];
    driven.qdd[0] = crank.qdd[2];
    ASSERT_TRUE(follower.complete(motion, driven, dynamics, workspace)) << i;
    expectNear(motion.q.segment(1, 2), crank.q.head(2));
    expectNear(motion.qd.segment(1, 2), crank.qd.head(2));
    expectNear(motion.qdd.segment(1, 2), crank.qdd.head(2));
  }
}

// The slide as the free axis of a closure, which a slider-crank of three pins has.
TEST(GivenMotions, TheSlideOfAClosureMovesTheCrank) {
  const Mechanism mechanism = sliderCrankOfPins(false);
  Scene scene;
  scene.closures = {slideOfPins(false)};
  scene.actuated = std::vector<std::string>{"slide"};
  scene.given = scene.actuated;
  scene.assembly = {{"joint_1", 0.7}, {"joint_2", -1.0}, {"joint_3", 0.3}};
  const Dynamics dynamics(mechanism, scene);
  EXPECT_EQ(dynamics.given().closures, (std::vector<std::size_t>{0}));
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  PassiveJoints follower(mechanism, dynamics);
  for (int i = 0; i < 30; ++i) {
    const Motion crank = SliderCrank::motion(0.3 + 0.08 * i, 1.5, -0.7);
    Motion motion(3), driven(1);
    driven.q[0] = crank.q[2];
    driven.qd[0] = crank.qd[2];
    driven.qdd[0] = crank.qdd[2];
    ASSERT_TRUE(follower.complete(motion, driven, dynamics, workspace)) << i;
    expectNear(motion.q.head(2), crank.q.head(2));
    expectNear(motion.qd.head(2), crank.qd.head(2));
    expectNear(motion.qdd.head(2), crank.qdd.head(2));
    dynamics.compute(motion, workspace);
    EXPECT_NEAR(workspace.results().loops.actuated_positions[0], crank.q[2], kClosedForm);
    EXPECT_NEAR(workspace.results().loops.actuated_velocities[0], crank.qd[2], kClosedForm);
  }
}

// The error of a motion is that of what it gives.
TEST(GivenMotions, AreWhatDeviationsShift) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  Scene scene = slider_crank.scene("joint_1");
  EXPECT_EQ(independentCoordinates({mechanism, scene, kNothing}),
            (std::vector<bool>{true, false, false}));
  scene.given = std::vector<std::string>{"joint_3"};
  EXPECT_EQ(independentCoordinates({mechanism, scene, kNothing}),
            (std::vector<bool>{false, false, true}));
}

// A pose tells a planar mechanism what it knows already, which is not to be taken for news where
// its axes are known to rounding only.
TEST(GivenMotions, PosesMoveATiltedPlanarMechanism) {
  using Turn = Eigen::AngleAxis<long double>;
  const Matrix3l tilt = (Turn(0.7L, Vector3l::UnitX()) * Turn(-1.1L, Vector3l::UnitY()) *
                         Turn(0.4L, Vector3l::UnitZ()))
                            .toRotationMatrix();
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  const Vector3l z = Vector3l::UnitZ();
  builder.add(JointType::kContinuous, 0, z, tilt, Vector3l::Zero());
  builder.add(JointType::kContinuous, 1, z, R, Vector3l(SliderCrank::kCrank, 0, 0));
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), tilt, Vector3l::Zero());
  const Mechanism mechanism = builder.build();
  const Scene scene = SliderCrank().scene("joint_1");
  const Dynamics dynamics(mechanism, scene, kNothing);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Given given;
  given.coordinates.assign(3, false);
  given.links = {mechanism.linkIndex("link_2")};  // the rod
  EXPECT_EQ(dynamics.judge(given).freedom, 0);
  EXPECT_EQ(dynamics.judge(given).follow, std::vector<std::string>());
  PassiveJoints follower(mechanism, dynamics, given);
  for (int i = 0; i < 20; ++i) {
    const double angle = 0.5 + 0.1 * i;
    const Motion expected = SliderCrank::motion(angle, 0, 0);
    Motion motion(3), driven(7);
    const Vector3l tip(SliderCrank::kCrank * std::cos(angle), SliderCrank::kCrank * std::sin(angle),
                       0);
    const Matrix3l turn =
        tilt * Turn(expected.q[0] + expected.q[1], Vector3l::UnitZ()).toRotationMatrix();
    driven.q << (tilt * tip).cast<double>(),
        Eigen::Quaternion<long double>(turn).cast<double>().coeffs();
    ASSERT_TRUE(follower.complete(motion, driven, dynamics, workspace))
        << follower.whyOpen(dynamics, workspace);
    expectNear(motion.q, expected.q);
  }
}

// Two joints on one axis, which is along z up to rounding: a pose does not tell them apart,
// although the components of their axes along x and y, which are rounding errors, differ.
TEST(GivenMotions, RoundingErrorsOfAPoseAreNoConditions) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RobotBuilder builder(seed);
    const Matrix3l R = builder.rotation();
    const Vector3l axis = R.transpose() * Vector3l::UnitZ();
    builder.add(JointType::kContinuous, 0, axis, R, Vector3l::Zero());
    builder.add(JointType::kContinuous, 1, axis, Matrix3l::Identity(), Vector3l::Zero());
    const Mechanism mechanism = builder.build();
    Scene scene;
    scene.actuated = mechanism.coordinateNames();
    const Dynamics dynamics(mechanism, scene, kNothing);
    Given given;
    given.coordinates.assign(2, false);
    given.links = {mechanism.linkIndex("link_2")};
    EXPECT_EQ(dynamics.judge(given).freedom, 1) << seed;
    given.coordinates[0] = true;
    EXPECT_EQ(dynamics.judge(given).freedom, 0) << seed;
  }
}

std::string problemWith(const Mechanism& mechanism, const Scene& scene) {
  try {
    const Dynamics dynamics(mechanism, scene, kNothing);
    return "";
  } catch (const SceneError& error) {
    return error.what();
  }
}

TEST(GivenMotions, AreJudgedWhereTheSceneNamesThem) {
  const LoopExample example("stewart_gough");
  Scene scene = example.scene;
  const auto problem = [&](std::vector<std::string> given) {
    scene.given = std::move(given);
    return problemWith(example.mechanism, scene);
  };
  EXPECT_EQ(problem({"pose.platform"}), "");
  EXPECT_EQ(problem({"leg_1", "leg_2", "leg_3", "leg_4", "leg_5", "leg_6"}), "");
  // The leg that bears the platform, by its own joints.
  EXPECT_EQ(problem({"leg_1_x", "leg_1_y", "leg_1", "ball_1_x", "ball_1_y", "ball_1_z"}), "");
  EXPECT_EQ(problem({"pose.platform", "leg_3"}),
            "given: too much is given: 'leg_3' follows from the rest; leave it out, or give all "
            "joints and nothing else");
  EXPECT_EQ(problem({"leg_1", "leg_2", "leg_3", "leg_4", "leg_5"})
                .find("given: too little is given: the motion of "),
            0u);
  EXPECT_EQ(problem({"pose.floor"}).find("given[0]: no link 'floor'"), 0u);
  EXPECT_EQ(problem({"pose.base"}), "given[0]: 'base' is the root link");
  EXPECT_EQ(problem({"ball_2"}), "given: closure 'ball_2' is neither revolute nor prismatic");
  EXPECT_EQ(problem({"leg_1", "leg_1"}), "given: 'leg_1' is given twice");
  EXPECT_EQ(problem({"lag_1"}).find("given[0]: no joint or closure 'lag_1'; did you mean"), 0u);
}

// The height of the wheel follows, and with it all positions; but the rates that are left tie each
// other, so that the noise of one of them would contradict the closures.
TEST(GivenMotions, AreJudgedByTheirRatesToo) {
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  const Vector3l o = Vector3l::Zero();
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), R, o);
  builder.add(JointType::kPrismatic, 1, Vector3l::UnitZ(), R, o);
  builder.add(JointType::kContinuous, 2, Vector3l::UnitY(), R, o);
  const Mechanism mechanism = builder.build();
  Scene scene =
      readScene(YAML::Load("rolling: [{name: edge, link: link_3, axis: [0, 1, 0], radius: 0.5, "
                           "plane: {link: link_0}}]\nassembly: [{name: joint_2, position: 0.5}]\n"
                           "actuated: [joint_3]\n"));
  const auto problem = [&](std::vector<std::string> given) {
    scene.given = std::move(given);
    return problemWith(mechanism, scene);
  };
  EXPECT_EQ(
      problem({"joint_1", "joint_3"}),
      "given: too much is given: rates of 'joint_1', 'joint_3' follow from each other, though "
      "their positions do not; give all joints and nothing else");
  EXPECT_EQ(problem({"joint_1", "joint_2", "joint_3"}), "");
  EXPECT_EQ(problem({"joint_3"}).find("given: too little is given: the motion of 'joint_1'"), 0u);
}

}  // namespace
}  // namespace virtual_work_dynamics
