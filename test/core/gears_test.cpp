#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kDegree = M_PI / 180;
// Roundings of some ten operations, relative to forces of some hundred newtons.
constexpr double kClosedForm = 1e-12;
// Half a unit of the last digit that is printed.
constexpr double kPrinted = 5e-9;

void expectNear(const Eigen::Vector3d& found, const Eigen::Vector3d& expected, double tolerance) {
  ASSERT_TRUE(found.allFinite());
  EXPECT_LE((found - expected).norm(), tolerance)
      << found.transpose() << " instead of " << expected.transpose();
}

Closure gear(const std::string& name, const std::string& parent, const std::string& child,
             double parent_radius, double child_radius, double pressure = 20 * kDegree,
             double helix = 0) {
  Closure closure;
  closure.name = name;
  closure.type = ClosureType::kGear;
  closure.parent.link = parent;
  closure.child.link = child;
  closure.teeth = {parent_radius, child_radius, pressure, helix};
  return closure;
}

// Wheels about z. Links are balanced; the mass is 1 and the inertia is what is given.
class Wheels {
 public:
  Wheels() : builder_(1) { scene.gravity.setZero(); }
  int add(int parent, const Vector3l& at, double inertia, JointType type = JointType::kContinuous,
          const Vector3l& axis = Vector3l::UnitZ()) {
    const int link = builder_.add(type, parent, axis, Matrix3l::Identity(), at);
    builder_.removeInertia(link);
    builder_.link(link).mass = 1;
    builder_.link(link).inertia_Cm_K = inertia * Matrix3l::Identity();
    return link;
  }
  RobotBuilder& builder() { return builder_; }
  Mechanism mechanism() const { return builder_.build(); }
  Scene scene;

 private:
  RobotBuilder builder_;
};

// Project Chrono, utest_CH_gears.cpp: wheels of radii 4 and 2 m, the first one held by its motor, a
// torque of 1000 N m on the second, teeth of 20 degrees and a helix of 10.
class ChronoGears : public testing::Test {
 protected:
  ChronoGears() {
    wheels.add(0, Vector3l(0, 0, -1), 3);
    wheels.add(0, Vector3l(6, 0, -1), 2);
    wheels.scene.closures = {gear("teeth", "link_1", "link_2", 4, 2, 20 * kDegree, 10 * kDegree)};
    wheels.scene.actuated = std::vector<std::string>{"joint_1"};
  }
  ClosedLoopResults withTorque(double torque) {
    AppliedWrench applied;
    applied.link = "link_2";
    applied.torque = {0, 0, torque};
    wheels.scene.applied_wrenches = {applied};
    return {wheels.mechanism(), wheels.scene, Motion(2)};
  }
  Wheels wheels;
};

TEST_F(ChronoGears, ToothForceAndBearings) {
  const double P_t = 1000.0 / 2, P_r = P_t * std::tan(20 * kDegree) / std::cos(10 * kDegree),
               P_a = P_t * std::tan(10 * kDegree);
  EXPECT_NEAR(P_r, 184.79253090, kPrinted);
  EXPECT_NEAR(P_a, 88.16349035, kPrinted);
  const ClosedLoopResults found = withTorque(1000);
  // What the teeth exert on the second wheel, and what its bearing does against that.
  expectNear(found.root("teeth").force, {P_r, P_t, P_a}, 500 * kClosedForm);
  expectNear(found.root("joint_2").force, {-P_r, -P_t, -P_a}, 500 * kClosedForm);
  EXPECT_NEAR(found.root("teeth").force.norm(), 540.3, 0.05);
  expectNear(found.root("joint_1").force, {P_r, P_t, P_a}, 500 * kClosedForm);
  // About the wheel's centre: the pitch point is 2 m before it.
  expectNear(found.root("teeth").torque,
             Eigen::Vector3d(-2, 0, 0).cross(Eigen::Vector3d(P_r, P_t, P_a)), 1000 * kClosedForm);
  // The motor holds the first wheel: 4 m times the tooth force.
  EXPECT_NEAR(found.dynamics.effort()[0], 2000, 1000 * kClosedForm);
  EXPECT_EQ(found.dynamics.effort()[1], 0);
  EXPECT_EQ(found.rootDetermined("teeth"), kAllComponents);
}

// The other flank presses the wheels apart as well, and pushes along the axis the other way.
TEST_F(ChronoGears, OtherFlank) {
  const double P_t = -500, P_r = 500 * std::tan(20 * kDegree) / std::cos(10 * kDegree),
               P_a = P_t * std::tan(10 * kDegree);
  const ClosedLoopResults found = withTorque(-1000);
  expectNear(found.root("teeth").force, {P_r, P_t, P_a}, 500 * kClosedForm);
  expectNear(found.root("joint_2").force, {-P_r, -P_t, -P_a}, 500 * kClosedForm);
  expectNear(found.root("joint_1").force, {P_r, P_t, P_a}, 500 * kClosedForm);
  EXPECT_NEAR(found.dynamics.effort()[0], -2000, 1000 * kClosedForm);
}

// Two pairs of teeth, 1 m above and below the wheels, share the tooth force 1 N; a torque about x
// makes the second one bear on its other flank. With t = tan(20 deg) and forces S +- D over two,
// the bearings' forces are t D along x, and their moments D and D - 10 about x: least squares of
// these and of what the teeth bear, divided by their stiffness. Those for the first flank had D
// = 5.4 N.
TEST(Gears, StiffnessDecidesWhichFlankBears) {
  Wheels wheels;
  wheels.add(0, Vector3l(0, 0, 0), 3);
  wheels.add(0, Vector3l(6, 0, 0), 2);
  wheels.scene.closures = {gear("up", "link_1", "link_2", 4, 2),
                           gear("down", "link_1", "link_2", 4, 2)};
  wheels.scene.closures[0].child.xyz = {0, 0, 1};
  wheels.scene.closures[1].child.xyz = {0, 0, -1};
  wheels.scene.actuated = std::vector<std::string>{"joint_1"};
  const double stiffness = 1000;
  wheels.scene.redundancy.policy = RedundancyPolicy::kStiffness;
  wheels.scene.redundancy.stiffness = {{"up", stiffness}, {"down", stiffness}};
  wheels.scene.redundancy.length = 1;
  AppliedWrench applied;
  applied.link = "link_2";
  applied.torque = {10, -5, 2};
  wheels.scene.applied_wrenches = {applied};
  const ClosedLoopResults found(wheels.mechanism(), wheels.scene, Motion(2));
  const double t = std::tan(20 * kDegree);
  const double D = 2 * 10 / (4 + 4 * t * t + (5 + t * t) / stiffness);
  const double up = (1 + D) / 2, down = (1 - D) / 2;
  EXPECT_LT(down, 0);
  expectNear(found.root("up").force, {t * up, up, 0}, 100 * kClosedForm);
  expectNear(found.root("down").force, {-t * down, down, 0}, 100 * kClosedForm);
}

// Wheels turn against each other as their radii, from where they are put together.
TEST_F(ChronoGears, TurnAgainstEachOther) {
  wheels.scene.assembly = {{"joint_1", 0.3}, {"joint_2", 0.7}};
  ClosedLoopResults found(wheels.mechanism(), wheels.scene);
  Motion motion(2);
  motion.q[0] = 50.3;
  motion.qd[0] = 3;
  motion.qdd[0] = -2;
  ASSERT_TRUE(found.dynamics.complete(motion));
  EXPECT_NEAR(motion.q[1], 0.7 - 100, 100 * kClosedForm);
  EXPECT_NEAR(motion.qd[1], -6, kClosedForm);
  EXPECT_NEAR(motion.qdd[1], 4, kClosedForm);
  found.dynamics.compute(motion);
  EXPECT_NEAR(found.dynamics.effort()[0], -2 * (3 + 4 * 2), 100 * kClosedForm);
}

// The parent may be either wheel: nothing that is determined changes but the sign of the reaction.
TEST_F(ChronoGears, EitherWheelMayBeTheParent) {
  const ClosedLoopResults found = withTorque(1000);
  Closure& teeth = wheels.scene.closures[0];
  std::swap(teeth.parent, teeth.child);
  std::swap(teeth.teeth.parent_radius, teeth.teeth.child_radius);
  teeth.teeth.helix_angle *= -1;  // the other wheel's hand
  const ClosedLoopResults other = withTorque(1000);
  expectNear(other.root("teeth").force, -found.root("teeth").force, 500 * kClosedForm);
  for (const char* joint : {"joint_1", "joint_2"}) {
    expectNear(other.root(joint).force, found.root(joint).force, 500 * kClosedForm);
    expectNear(other.root(joint).torque, found.root(joint).torque, 1e4 * kClosedForm);
  }
  EXPECT_NEAR(other.dynamics.effort()[0], found.dynamics.effort()[0], 2000 * kClosedForm);
}

// A coupling of the same wheels gives the same efforts and loads no bearing.
TEST_F(ChronoGears, CouplingLoadsNoBearing) {
  const ClosedLoopResults geared = withTorque(1000);
  wheels.scene.closures.clear();
  Coupling coupling;
  coupling.name = "plain";
  coupling.terms = {{"joint_1", 4}, {"joint_2", 2}};
  wheels.scene.couplings = {coupling};
  const ClosedLoopResults coupled = withTorque(1000);
  EXPECT_NEAR(coupled.dynamics.effort()[0], geared.dynamics.effort()[0], 2000 * kClosedForm);
  expectNear(coupled.root("joint_2").force, Eigen::Vector3d::Zero(), kClosedForm);
}

// Rack and pinion: x = r phi, and the tooth force along the rack is what moves it.
TEST(Gears, RackAndPinion) {
  Wheels wheels;
  wheels.add(0, Vector3l(0, 0.2L, 0), 0.01);
  wheels.add(0, Vector3l(0, 0, 0), 1, JointType::kPrismatic, Vector3l::UnitX());
  Closure rack = gear("rack", "link_1", "link_2", 0.2, 0);
  rack.type = ClosureType::kRack;
  wheels.scene.closures = {rack};
  wheels.scene.actuated = std::vector<std::string>{"joint_1"};
  ClosedLoopResults found(wheels.mechanism(), wheels.scene);
  for (const double acceleration : {7.0, -7.0}) {
    Motion motion(2);
    motion.q[0] = 1.5;
    motion.qdd[0] = acceleration;
    ASSERT_TRUE(found.dynamics.complete(motion));
    EXPECT_NEAR(motion.q[1], 0.2 * 1.5, kClosedForm);
    found.dynamics.compute(motion);
    const double along = 0.2 * acceleration;  // of 1 kg
    EXPECT_NEAR(found.dynamics.effort()[0], 0.01 * acceleration + 0.2 * along, kClosedForm);
    // The pinion lies above: its teeth press the rack down.
    expectNear(found.root("rack").force, {along, -std::abs(along) * std::tan(20 * kDegree), 0},
               10 * kClosedForm);
  }
}

// A planetary set by its teeth: z_sun = 2, planet 1, ring -4 in units of 0.1 m; the carrier drives.
class PlanetarySet : public testing::Test {
 protected:
  static constexpr double kSun = 0.2, kPlanet = 0.1, kRing = -0.4;
  PlanetarySet() {
    // carrier 1 with planet 2, ring 3, sun 4
    wheels.add(0, Vector3l::Zero(), 0.5);
    wheels.add(1, Vector3l(0.3L, 0, 0), 0.02);
    wheels.add(0, Vector3l::Zero(), 0.7);
    wheels.add(0, Vector3l::Zero(), 0.3);
    wheels.scene.closures = {gear("sun_teeth", "link_4", "link_2", kSun, kPlanet),
                             gear("ring_teeth", "link_2", "link_3", kPlanet, kRing)};
    wheels.scene.actuated = std::vector<std::string>{"joint_1", "joint_3"};
  }
  Wheels wheels;
};

TEST_F(PlanetarySet, TurnsAsWillisSays) {
  ClosedLoopResults found(wheels.mechanism(), wheels.scene);
  Motion motion(4);
  motion.qd[0] = 3;    // carrier
  motion.qd[2] = 0.5;  // ring
  motion.qdd[0] = 1;
  ASSERT_TRUE(found.dynamics.complete(motion));
  // 0.2 (w_s - w_c) + 0.4 (w_r - w_c) = 0
  EXPECT_NEAR(motion.qd[3], 3 - 2 * (0.5 - 3), 10 * kClosedForm);
  // The planet's is relative to the carrier: 0.1 w_p = 0.4 (w_r - w_c).
  EXPECT_NEAR(motion.qd[1], 4 * (0.5 - 3), 10 * kClosedForm);
  EXPECT_NEAR(motion.qdd[3], 3, 10 * kClosedForm);
}

// At rest a torque on the sun is held by carrier and ring as radii say, and the planet's bearing
// carries both tooth forces.
TEST_F(PlanetarySet, HoldsTorquesAndLoadsThePlanetsBearing) {
  AppliedWrench applied;
  applied.link = "link_4";
  applied.torque = {0, 0, 10};
  wheels.scene.applied_wrenches = {applied};
  for (const double angle : {0.0, 0.8}) {
    Motion motion(4);
    motion.q[0] = angle;
    ClosedLoopResults found(wheels.mechanism(), wheels.scene);
    ASSERT_TRUE(found.dynamics.complete(motion));
    found.dynamics.compute(motion);
    const double P = 10 / kSun;
    EXPECT_NEAR(found.dynamics.effort()[0], -10 * (1 + 2), 100 * kClosedForm);
    EXPECT_NEAR(found.dynamics.effort()[2], 10 * 2, 100 * kClosedForm);
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3d along = Eigen::Vector3d::UnitZ().cross(out);
    const double press = P * std::tan(20 * kDegree);
    // The sun pushes the planet along and outwards; the ring pushes it along and inwards.
    expectNear(found.root("sun_teeth").force, P * along + press * out, 1000 * kClosedForm);
    expectNear(found.root("ring_teeth").force, -P * along + press * out, 1000 * kClosedForm);
    expectNear(found.root("joint_2").force, -2 * P * along, 1000 * kClosedForm);
    EXPECT_LE(found.root("joint_2").torque.norm(), 100 * kClosedForm);
    EXPECT_EQ(found.rootDetermined("joint_2"), kAllComponents);
  }
}

// Certificates and Lagrange's equations see the tooth forces as loads of the tree.
TEST_F(PlanetarySet, CertificatesHold) {
  wheels.scene.gravity = {1, -9, 2};
  wheels.scene.root_moves = false;
  for (Closure& closure : wheels.scene.closures) closure.teeth.helix_angle = 0.3;
  wheels.builder().link(2).p_KoCm_K << 0.01L, 0.02L, 0;
  Request request;
  request.child_axes = {"joint_1", "joint_2", "joint_3", "joint_4"};
  const Request extended = Certifier::extended(request);
  const Dynamics dynamics(wheels.mechanism(), wheels.scene, extended);
  Certifier certifier(wheels.mechanism(), dynamics.tree());
  LagrangeDynamics<long double> lagrange(wheels.mechanism(), dynamics.tree(),
                                         dynamics.treeRequest());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  int other_flanks = 0;
  for (const Motion& random : wheels.builder().motions(40)) {
    Motion motion = random;
    ASSERT_TRUE(dynamics.complete(motion, workspace));
    dynamics.compute(motion, workspace);
    const Results& results = workspace.results();
    Load load(dynamics.tree());
    dynamics.getTreeLoad(results, load);
    const std::size_t ground = Certifier::groundIndex(extended);
    EXPECT_LE(
        certifier.check(motion, load, results.treeEffort(4), results.child_axes[ground]).largest(),
        1e-13);
    lagrange.compute(motion, load);
    double size = 1;
    for (std::size_t i = 0; i < 4; ++i) {
      size = std::max(size, lagrange.childAxes()[i].force.norm());
    }
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(results.treeEffort(4)[i], lagrange.effort()[i], 1e-12 * size);
      const auto place = static_cast<std::size_t>(i);
      expectNear(results.child_axes[place].force, lagrange.childAxes()[place].force, 1e-12 * size);
      expectNear(results.child_axes[place].torque, lagrange.childAxes()[place].torque,
                 1e-12 * size);
    }
    // Whatever the flank, the sun presses the planet outwards.
    const double c = std::cos(motion.q[0]), s = std::sin(motion.q[0]);
    const Eigen::Vector3d out(c, s, 0), along(-s, c, 0);
    const Wrench& sun = results.loops.tree_wrenches[0];
    const double tooth = sun.force.dot(along);
    if (tooth < 0) ++other_flanks;
    EXPECT_NEAR(sun.force.dot(out), std::abs(tooth) * std::tan(20 * kDegree) / std::cos(0.3),
                1e-12 * size);
    EXPECT_NEAR(sun.force.z(), tooth * std::tan(0.3), 1e-12 * size);
  }
  EXPECT_GE(other_flanks, 5);
  EXPECT_LE(other_flanks, 35);
}

std::string refusalOf(const Wheels& wheels) {
  try {
    ClosedLoopResults(wheels.mechanism(), wheels.scene);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST_F(ChronoGears, Refusals) {
  Teeth& teeth = wheels.scene.closures[0].teeth;
  EXPECT_EQ(refusalOf(wheels), "");
  teeth.child_radius = 2.5;
  EXPECT_EQ(refusalOf(wheels), "closures: 'teeth': the centres are 6 m apart, 6.5 m by the radii");
  teeth.child_radius = 0;
  EXPECT_EQ(refusalOf(wheels), "closures: 'teeth': radii are finite numbers other than zero");
  teeth = {-4, -2, 0.3, 0};
  EXPECT_EQ(refusalOf(wheels),
            "closures: 'teeth': radii = [-4, -2]: one of two wheels may have its teeth inside, and "
            "the other one is smaller");
  teeth = {8, -2, 0.3, 0};
  EXPECT_EQ(refusalOf(wheels),
            "closures: 'teeth': radii = [8, -2]: a wheel inside of another is smaller than that");
  teeth = {4, 2, 1.6, 0};
  EXPECT_EQ(refusalOf(wheels),
            "closures: 'teeth': pressure_angle = 1.6 is not from 0 to below a right angle");
  teeth = {4, 2, 0.3, -1.6};
  EXPECT_EQ(refusalOf(wheels), "closures: 'teeth': helix_angle = -1.6 is not below a right angle");
  teeth = {4, 2, 0.3, 0};
  wheels.scene.closures[0].child.rpy.x() = 0.01;
  EXPECT_EQ(refusalOf(wheels),
            "closures: 'teeth': the wheels' axes z are not parallel, or do not stay so");
}

TEST(GearRefusals, WheelsThatDoNotStayInPlace) {
  Wheels wheels;
  wheels.add(0, Vector3l(0, 0, 0), 1);
  wheels.add(0, Vector3l(6, 0, 0), 1, JointType::kPrismatic, Vector3l::UnitX());
  wheels.add(2, Vector3l(0, 0, 0), 1);
  wheels.scene.closures = {gear("teeth", "link_1", "link_3", 4, 2)};
  const std::string refusal = refusalOf(wheels);
  EXPECT_EQ(refusal,
            "closures: 'teeth': joint 'joint_2' does not only turn a wheel about its axis");
}

TEST(GearRefusals, HelicalWheelThatSlidesAlongItsAxis) {
  Wheels wheels;
  wheels.add(0, Vector3l(0, 0, 0), 1);
  wheels.add(0, Vector3l(6, 0, 0), 1, JointType::kPrismatic);
  wheels.add(2, Vector3l(0, 0, 0), 1);
  wheels.scene.closures = {gear("teeth", "link_1", "link_3", 4, 2)};
  EXPECT_EQ(refusalOf(wheels), "");  // a wheel on a splined shaft
  wheels.scene.closures[0].teeth.helix_angle = 0.1;
  EXPECT_EQ(refusalOf(wheels),
            "closures: 'teeth': joint 'joint_2' does not only turn a wheel about its axis");
}

}  // namespace
}  // namespace virtual_work_dynamics
