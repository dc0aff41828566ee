#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Both mechanisms are the same numbers in the same order, except for the places of mimic joints.
constexpr double kSame = 1e-12;

std::string link(const std::string& name, const std::string& centre, const std::string& mass) {
  return "<link name='" + name + "'><inertial><origin xyz='" + centre + "'/><mass value='" + mass +
         "'/><inertia ixx='0.002' ixy='0.0002' ixz='0' iyy='0.004' iyz='0.0001' izz='0.005'/>"
         "</inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& origin, const std::string& axis,
                  const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin " + origin + "/>" +
         (axis.empty() ? "" : "<axis xyz='" + axis + "'/>") +
         "<limit lower='-1' upper='1' effort='1' velocity='1'/>" + more + "</joint>";
}

const std::string kBase = "rpy='0.4 0.1 0'", kTip = "xyz='0.1 0 0' rpy='0.2 0.3 0.1'",
                  kNone = "xyz='0 0 0'";

// A crank with a coupler whose far end a rocker holds by a ball: one freedom. The crank is a screw;
// the coupler hangs on it by `u`, a joint of two freedoms.
std::string linkage(const std::string& joints) {
  return "<robot name='linkage'><link name='base'/>" + link("crank", "0.05 0 0.01", "0.8") +
         link("coupler", "0.2 0.01 0", "1.1") + link("rocker", "0 0.15 0.02", "0.9") + joints +
         joint("rocker_joint", "continuous", "base", "rocker",
               "xyz='0.45 -0.3 0.1' rpy='0.1 -0.2 0'", "0 0 1") +
         "</robot>";
}

std::string closure(const std::string& type) {
  return "closures: [{name: ball, type: " + type +
         ", parent: {link: coupler, xyz: [0.4, 0, 0], rpy: [0.3, 0.2, 0]},"
         " child: {link: rocker, xyz: [0.05, 0.32, 0.1]}}]\n"
         "gravity: [1, 2, -9]\nredundancy: {length: 0.3}\n";
}

struct Loops {
  Loops(const Mechanism& mechanism, const Scene& scene, const Request& request)
      : robot(mechanism), dynamics(robot, scene, request), workspace(dynamics.makeWorkspace()) {}

  const Results& compute(double q, double qd, double qdd) {
    motion = Motion(dynamics.coordinates());
    motion.q = dynamics.assembly();
    const int crank = robot.coordinateIndex("crank_joint");
    motion.q[crank] += q;
    motion.qd[crank] = qd;
    motion.qdd[crank] = qdd;
    EXPECT_TRUE(dynamics.complete(motion, workspace));
    dynamics.compute(motion, workspace);
    return workspace.results();
  }

  Mechanism robot;
  Dynamics dynamics;
  Dynamics::Workspace workspace;
  Motion motion;
};

Request requestOf(const std::string& u) {
  Request request;
  request.child_axes = request.root_axes = {kGround, "crank_joint", u, "rocker_joint", "ball"};
  return request;
}

// Compares joints of two freedoms with chains that are written out.
void expectAsChain(const std::string& type, const std::string& axes, const std::string& chain,
                   const std::vector<std::string>& parts, const std::vector<std::string>& written,
                   bool include_active, const std::string& closure_type = "spherical") {
  const std::string more = include_active ? "" : "include_active: false\n";
  const Scene scene = readScene(
      YAML::Load(closure(closure_type) + more +
                 "actuated: [crank_joint]\njoint_types: [{name: crank_joint, type: screw, "
                 "pitch: 0.05}, {name: u, type: " +
                 type + axes + "}]\n"));
  const Mechanism described =
      readUrdf(linkage(joint("crank_joint", "continuous", "base", "crank", kBase, "0 0 1") +
                       joint("u", "fixed", "crank", "coupler", kTip, "")));
  Loops compound(withJointTypes(described, scene), scene, requestOf("u"));

  const Scene plain =
      readScene(YAML::Load(closure(closure_type) + more + "actuated: [crank_joint]\n"));
  const std::string mimic = "<mimic joint='crank_joint' multiplier='0.007957747154594767'/>";
  Loops written_out(
      readUrdf(linkage("<link name='nut'/><link name='cross'/>" +
                       joint("advance", "prismatic", "base", "nut", kBase, "0 0 1", mimic) +
                       joint("crank_joint", "continuous", "nut", "crank", kNone, "0 0 1") + chain)),
      plain, requestOf(written.back()));

  const Results& found = compound.compute(0.4, 1.5, -2);
  const Results& expected = written_out.compute(0.4, 1.5, -2);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int one = compound.robot.coordinateIndex(parts[i]);
    const int other = written_out.robot.coordinateIndex(written[i]);
    EXPECT_NEAR(compound.motion.q[one], written_out.motion.q[other], kSame) << parts[i];
    EXPECT_NEAR(compound.motion.qdd[one], written_out.motion.qdd[other], 100 * kSame) << parts[i];
  }
  const int crank = compound.robot.coordinateIndex("crank_joint");
  EXPECT_NEAR(found.effort[crank],
              expected.effort[written_out.robot.coordinateIndex("crank_joint")], 10 * kSame);
  EXPECT_GT(std::abs(found.effort[crank]), 0.1);
  for (std::size_t i = 0; i < found.child_axes.size(); ++i) {
    const std::string name = requestOf("u").child_axes[i];
    if (name == "crank_joint" && !include_active) continue;  // a screw is more than its turn
    EXPECT_TRUE(found.child_axes[i].force.isApprox(expected.child_axes[i].force, 10 * kSame))
        << name;
    EXPECT_TRUE(found.root_axes[i].force.isApprox(expected.root_axes[i].force, 10 * kSame)) << name;
    // The passive freedoms bear nothing, so that taking their part away changes nothing.
    EXPECT_LE((found.child_axes[i].torque - expected.child_axes[i].torque).norm(), 20 * kSame)
        << name;
    EXPECT_LE((found.root_axes[i].torque - expected.root_axes[i].torque).norm(), 20 * kSame)
        << name;
    EXPECT_EQ(found.loops.child_axes_determined[i], expected.loops.child_axes_determined[i])
        << name;
  }
  if (!include_active) {
    const Wrench& borne = found.child_axes[1];
    EXPECT_NEAR(borne.torque.z() + borne.force.z() * 0.05 / (2 * M_PI), 0, kSame);
  }

  LagrangeDynamics<double> lagrange(compound.robot, compound.dynamics.tree(),
                                    compound.dynamics.treeRequest());
  Load load(compound.dynamics.tree());
  compound.dynamics.getTreeLoad(found, load);
  lagrange.compute(compound.motion, load);
  for (Eigen::Index i = 0; i < lagrange.effort().size(); ++i) {
    EXPECT_NEAR(lagrange.effort()[i], found.effort[i], 20 * kSame);
  }
  for (std::size_t i = 0; i < lagrange.childAxes().size(); ++i) {
    EXPECT_LE((lagrange.childAxes()[i].torque - found.child_axes[i].torque).norm(), 20 * kSame);
    EXPECT_LE((lagrange.childAxes()[i].force - found.child_axes[i].force).norm(), 100 * kSame);
  }
}

TEST(CompoundJoints, OfLoopsMayBeUniversal) {
  const std::string chain = joint("first", "continuous", "crank", "cross", kTip, "0 0 1") +
                            joint("second", "continuous", "cross", "coupler", kNone, "0 1 0");
  for (const bool include_active : {true, false}) {
    expectAsChain("universal", ", axis: [0, 0, 1], axis2: [0, 1, 0]", chain,
                  {"u.angle1", "u.angle2"}, {"first", "second"}, include_active);
  }
}

TEST(CompoundJoints, OfLoopsMayBeCylindrical) {
  const std::string chain = joint("along", "prismatic", "crank", "cross", kTip, "0 0 1") +
                            joint("about", "continuous", "cross", "coupler", kNone, "0 0 1");
  for (const bool include_active : {true, false}) {
    expectAsChain("cylindrical", ", axis: [0, 0, 1]", chain, {"u.slide", "u.angle"},
                  {"along", "about"}, include_active);
  }
}

// A ball that closures leave passive: three angles from the orientation that it has in the
// assembly.
TEST(CompoundJoints, OfLoopsMayBeSpherical) {
  const std::string chain = "<link name='cross2'/>" +
                            joint("first", "continuous", "crank", "cross", kTip, "1 0 0") +
                            joint("second", "continuous", "cross", "cross2", kNone, "0 1 0") +
                            joint("third", "continuous", "cross2", "coupler", kNone, "0 0 1");
  for (const bool include_active : {true, false}) {
    expectAsChain("spherical", "", chain, {"u.rx", "u.ry", "u.rz"}, {"first", "second", "third"},
                  include_active, "universal");
  }
}

// What closures leave passive, motions need not give, and names of whole joints stand for all.
TEST(CompoundJoints, AreActuatedWholeByTheirNames) {
  const Mechanism robot =
      readUrdf("<robot name='r'><link name='base'/>" + link("cart", "0 0 0.1", "2") +
               joint("plane", "planar", "base", "cart", kNone, "0 0 1") + "</robot>");
  const Scene scene = readScene(YAML::Load("actuated: [plane]"));
  const Dynamics dynamics(robot, scene);
  EXPECT_EQ(dynamics.actuated(), std::vector<bool>(3, true));
  const Scene part = readScene(YAML::Load("{actuated: [plane.x, plane.y], free_motion: true}"));
  const Dynamics free(robot, part);
  EXPECT_EQ(free.effortNames(),
            (std::vector<std::string>{"plane.x", "plane.y", "residual.motion.plane.angle"}));
}

}  // namespace
}  // namespace virtual_work_dynamics
