#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "compound_cases.h"
#include "compound_oracle.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr unsigned kTrees = 120;

// All joints of the description, fixed ones too, and ground.
Request everyJoint(const Mechanism& described) {
  Request request;
  request.child_axes.push_back(kGround);
  for (const Joint& joint : described.joints()) request.child_axes.push_back(joint.name);
  request.root_axes = request.child_axes;
  return request;
}

double distance(const Wrench& found, const CompoundOracle::Wrench& expected, double unit,
                const WrenchMagnitude& magnitude) {
  const auto share = [&](const Eigen::Vector3d& a, const Vector3l& b, double size) {
    const double error = static_cast<double>((a.cast<long double>() - b).norm());
    return size > 0 ? error / (unit * size) : error;
  };
  return std::max(share(found.force, expected.force, magnitude.force),
                  share(found.torque, expected.torque, magnitude.moment));
}

std::size_t placeOf(const Mechanism& mechanism, const std::string& name) {
  return name == kGround ? 0 : static_cast<std::size_t>(mechanism.reactionIndex(name)) + 1;
}

// The magnitude of an ErrorBound that belongs to the reaction of a name. The moment that a thread
// bears is made of a force.
WrenchMagnitude magnitudeOf(const Mechanism& mechanism, const ErrorBound& bound,
                            const std::string& name) {
  const std::size_t place = placeOf(mechanism, name);
  WrenchMagnitude magnitude = bound.wrenches()[place];
  if (place == 0) return magnitude;
  const CompoundJoint* const compound = mechanism.compoundOf(static_cast<int>(place) - 1);
  if (compound && compound->type == CompoundType::kScrew) {
    magnitude.moment += std::abs(compound->pitch) / (2 * M_PI) * magnitude.force;
  }
  return magnitude;
}

// The largest error over 4 L eps S.
double errorOf(const CompoundCase& compound) {
  const Request request = everyJoint(compound.described);
  const InverseDynamics dynamics(compound.mechanism, compound.scene, request);
  Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(compound.motion, workspace);
  ErrorBound bound(compound.mechanism, compound.scene);
  bound.compute(compound.motion);
  const CompoundOracle oracle(compound.described, compound.mechanism, compound.scene,
                              compound.motion, compound.turns);
  double worst = 0;
  for (std::size_t i = 0; i < request.child_axes.size(); ++i) {
    const std::string& name = request.child_axes[i];
    const WrenchMagnitude magnitude = magnitudeOf(compound.mechanism, bound, name);
    const double unit = 4 * kEps * bound.depths()[placeOf(compound.mechanism, name)];
    const int joint = static_cast<int>(i) - 1;
    worst = std::max(
        worst, distance(workspace.childAxes()[i], oracle.childReaction(joint), unit, magnitude));
    worst =
        std::max(worst, distance(workspace.rootAxes()[i], oracle.reaction(joint), unit, magnitude));
  }
  const auto efforts = oracle.efforts();
  EXPECT_EQ(efforts.size(), compound.mechanism.coordinates().size());
  for (const auto& [name, effort] : efforts) {
    const int i = compound.mechanism.coordinateIndex(name);
    const auto at = static_cast<std::size_t>(i);
    const double unit = 4 * kEps * bound.effortDepths()[at] * bound.efforts()[at];
    const double error =
        static_cast<double>(std::abs(effort - static_cast<long double>(workspace.effort()[i])));
    worst = std::max(worst, unit > 0 ? error / unit : error);
  }
  return worst;
}

TEST(CompoundJoints, AreThoseOfNewtonAndEuler) {
  double worst = 0;
  for (unsigned seed = 1; seed <= kTrees; ++seed) {
    const double error = errorOf(CompoundCase(seed, seed % 6 == 0));
    EXPECT_LE(error, 1) << "seed " << seed;
    worst = std::max(worst, error);
  }
  RecordProperty("worst", std::to_string(worst));
}

TEST(CompoundJoints, OfLagrangesEquationsAreTheSame) {
  for (unsigned seed = 1; seed <= kTrees; ++seed) {
    const CompoundCase compound(seed, seed % 6 == 0);
    const Request request = everyJoint(compound.described);
    LagrangeDynamics<double> lagrange(compound.mechanism, compound.scene, request);
    lagrange.compute(compound.motion);
    ErrorBound bound(compound.mechanism, compound.scene);
    bound.compute(compound.motion);
    const CompoundOracle oracle(compound.described, compound.mechanism, compound.scene,
                                compound.motion, compound.turns);
    for (std::size_t i = 0; i < request.child_axes.size(); ++i) {
      const WrenchMagnitude magnitude =
          magnitudeOf(compound.mechanism, bound, request.child_axes[i]);
      const int joint = static_cast<int>(i) - 1;
      EXPECT_LE(distance(lagrange.childAxes()[i], oracle.childReaction(joint), 1e-13, magnitude), 1)
          << seed << " " << request.child_axes[i];
      EXPECT_LE(distance(lagrange.rootAxes()[i], oracle.reaction(joint), 1e-13, magnitude), 1)
          << seed << " " << request.child_axes[i];
    }
    for (const auto& [name, effort] : oracle.efforts()) {
      const int i = compound.mechanism.coordinateIndex(name);
      EXPECT_NEAR(lagrange.effort()[i], static_cast<double>(effort),
                  1e-13 * bound.efforts()[static_cast<std::size_t>(i)])
          << seed << " " << name;
    }
  }
}

TEST(CompoundJoints, AreCertified) {
  for (unsigned seed = 1; seed <= kTrees; ++seed) {
    const CompoundCase compound(seed);
    const Request request = Certifier::extended({});
    const InverseDynamics dynamics(compound.mechanism, compound.scene, request);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(compound.motion, workspace);
    Certifier certifier(compound.mechanism, compound.scene);
    EXPECT_LE(certifier
                  .check(compound.motion, workspace.effort(),
                         workspace.childAxes()[Certifier::groundIndex(request)])
                  .largest(),
              1e-14)
        << seed;
  }
}

constexpr char kTwo[] =
    "<robot name='r'><link name='base'/><link name='arm'><inertial><mass value='2'/>"
    "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>"
    "<link name='hand'/><joint name='j' type='TYPE'><parent link='base'/><child link='arm'/>"
    "<origin xyz='1 2 3'/><axis xyz='0 0 1'/>"
    "<limit lower='-2' upper='2' effort='1' velocity='1'/><dynamics damping='0.5'/></joint>"
    "<joint name='wrist' type='continuous'><parent link='arm'/><child "
    "link='hand'/></joint></robot>";

std::string described(const std::string& type) {
  std::string text = kTwo;
  return text.replace(text.find("TYPE"), 4, type);
}

using Names = std::vector<std::string>;

TEST(CompoundJoints, OfADescriptionThatIsPlanarAreChains) {
  const Mechanism robot = readUrdf(described("planar"));
  EXPECT_EQ(robot.coordinateNames(), (Names{"j.x", "j.y", "j.angle", "wrist"}));
  ASSERT_EQ(robot.compounds().size(), 1u);
  EXPECT_EQ(robot.compounds()[0].name, "j");
  EXPECT_EQ(robot.reactionIndex("j"), 2);
  EXPECT_EQ(robot.reactionIndex("j.x"), -1);
  EXPECT_EQ(robot.reactionName(2), "j");
  EXPECT_EQ(robot.link(3).name, "arm");
  EXPECT_EQ(requestedReactions(robot, Scene()), (Names{"j", "wrist"}));
  ASSERT_FALSE(robot.doubts().empty());
  EXPECT_NE(robot.doubts()[0].text.find("joint 'j': its <dynamics> is not used"),
            std::string::npos);
}

TEST(CompoundJoints, KeepWhatIsKnownOfTheMotionThatTheyHaveFromTheDescription) {
  Scene scene;
  JointTypeEntry entry;
  entry.joint = "j";
  entry.type = CompoundType::kCylindrical;
  scene.joint_types = {entry};
  const Mechanism turning = withJointTypes(readUrdf(described("revolute")), scene);
  EXPECT_EQ(turning.coordinateNames(), (Names{"j.slide", "j.angle", "wrist"}));
  EXPECT_EQ(turning.joint(0).damping, 0);
  EXPECT_EQ(turning.joint(1).damping, 0.5);
  EXPECT_EQ(turning.joint(0).effort_limit, 0);
  EXPECT_EQ(turning.joint(1).effort_limit, 1);
  EXPECT_EQ(turning.joint(1).upper, 2);
  const Mechanism sliding = withJointTypes(readUrdf(described("prismatic")), scene);
  EXPECT_EQ(sliding.joint(0).damping, 0.5);
  EXPECT_EQ(sliding.joint(1).damping, 0);
  scene.joint_types[0].axis = Eigen::Vector3d(1, 0, 0);
  EXPECT_EQ(withJointTypes(readUrdf(described("revolute")), scene).joint(1).damping, 0);
}

TEST(CompoundJoints, OfTheSceneReplaceThoseOfTheDescription) {
  Scene scene;
  JointTypeEntry entry;
  entry.joint = "j";
  entry.type = CompoundType::kScrew;
  entry.pitch = 0.02;
  scene.joint_types = {entry};
  const Mechanism screw = withJointTypes(readUrdf(described("planar")), scene);
  EXPECT_EQ(screw.coordinateNames(), (Names{"j", "wrist"}));
  EXPECT_EQ(screw.links().size(), 4u);
  EXPECT_EQ(screw.compounds()[0].type, CompoundType::kScrew);
  EXPECT_EQ(requestedReactions(screw, Scene()), (Names{"j", "wrist"}));
}

TEST(CompoundJoints, HaveTermsByTheirParts) {
  const Mechanism robot = readUrdf(described("planar"));
  Scene scene;
  scene.gravity.setZero();
  scene.joints.resize(1);
  scene.joints[0].joint = "j.y";
  scene.joints[0].stiffness = 100;
  scene.joints[0].rest = 0.25;
  const Dynamics dynamics(robot, scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(4);
  motion.q << 1, 0.5, 0.3, 0;
  dynamics.compute(motion, workspace);
  const Eigen::VectorXd& effort = workspace.results().effort;
  EXPECT_NEAR(effort[1], 25, 1e-12);
  EXPECT_NEAR(effort[0], 0, 1e-12);
  EXPECT_NEAR(effort[2], 0, 1e-12);
}

TEST(CompoundJoints, HaveMomentsAboutPointsOfTheParentsFrame) {
  const Mechanism robot = readUrdf(described("planar"));
  Scene scene;
  scene.gravity = {0, -10, 0};  // in the plane: the moment about the joint's frame is 20 N x
  scene.moments_about.resize(1);
  scene.moments_about[0].name = "j";
  scene.moments_about[0].frame = JointFrame::kParent;
  const Dynamics dynamics(robot, scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(4);
  motion.q << 3, 1, 0.3, 0;
  dynamics.compute(motion, workspace);
  EXPECT_NEAR(workspace.results().root_axes[0].torque.z(), 60, 1e-12);
}

}  // namespace
}  // namespace virtual_work_dynamics
