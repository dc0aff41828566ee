// Free bodies and bodies in absolute coordinates, against numbers that other programs' tests
// publish.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms in long double and printed numbers of 16 digits, of sizes of some tens.
constexpr double kClosedForm = 1e-13;
using Quaternionl = Eigen::Quaternion<long double>;

Results computed(const Mechanism& mechanism, const Scene& scene, const Request& request,
                 const Motion& motion) {
  const Dynamics dynamics(mechanism, scene, request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  return workspace.results();
}

// One body that floats on ground: `j`, coordinates j.x to j.z and j.rx to j.rz.
Mechanism floating(const Link& body, const Vector3l& at, const Matrix3l& axes) {
  std::vector<Link> links(2, body);
  links[0] = Link();
  links[0].name = "ground_link";
  links[1].name = "body";
  links[1].parent_joint = 0;
  std::vector<Joint> joints(1);
  joints[0].name = "j";
  joints[0].child_link = 1;
  joints[0].p_PoKo_P = at;
  joints[0].R_PK = axes;
  return withJointTypes(Mechanism("free", links, joints),
                        readScene(YAML::Load("joint_types: [{name: j, type: floating}]")));
}

Matrix3l turnAbout(const Vector3l& axis, long double angle) {
  return Eigen::AngleAxis<long double>(angle, axis.normalized()).toRotationMatrix();
}

Matrix3l symmetric(long double xx, long double yy, long double zz, long double xy, long double xz,
                   long double yz) {
  Matrix3l matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return matrix;
}

// Simbody, tests/TestMobilizerReactionForces.cpp, testFreeMobilizer: a body with a full inertia,
// a centre of mass off its origin and twisted frames, in free motion under a force, a moment and
// gravity: its mobilizer bears nothing. The accelerations come from Newton's and Euler's equations.
TEST(FreeBodies, OfSimbodyNeedNoForce) {
  const long double pi = std::acos(-1.0L), mass = 2;
  const Vector3l com_B(1, 2, 3), p_GF(-4, -5, -1), p_BM(0, 1.5L, 0);
  const Matrix3l R_GF = turnAbout({0.1L, -0.3L, 0.3L}, pi / 3),
                 R_BM = turnAbout({7, 5, 3}, -pi / 10), R_FM = turnAbout({-1.8L, 4, 2.2L}, pi / 9);
  const Vector3l p_FM(0.1L, 0.2L, 0.7L), w_F(0.99L, 2, 4), v_F(-1.2L, 4, 0.000333L);
  const Vector3l f(5, 0.6L, -1), t(-5.5L, 1.6L, -1.1L), at_B(-1, 0.27L, 4), g(0, -1, 0);
  // The link's frame is M.
  Link body;
  body.mass = mass;
  body.p_KoCm_K = R_BM.transpose() * (com_B - p_BM);
  body.inertia_Cm_K = R_BM.transpose() * (mass * symmetric(1, 1.5L, 2, 0.1L, 0.2L, 0.3L)) * R_BM;
  const Mechanism robot = floating(body, p_GF, R_GF);

  const Matrix3l R_GM = R_GF * R_FM;
  const Vector3l w = R_GF * w_F, r_C = R_GM * body.p_KoCm_K,
                 r_P = R_GM * R_BM.transpose() * (at_B - p_BM);
  const Matrix3l I = R_GM * body.inertia_Cm_K * R_GM.transpose();
  const Vector3l a_C = f / mass + g;
  const Vector3l moment = t + (r_P - r_C).cross(f) - w.cross(I * w);
  const Vector3l e = I.ldlt().solve(moment);
  const Vector3l a = a_C - e.cross(r_C) - w.cross(w.cross(r_C));

  Motion motion(6, 1);
  motion.q.head<3>() = p_FM.cast<double>();
  motion.qd.head<3>() = v_F.cast<double>();
  motion.qdd.head<3>() = (R_GF.transpose() * a).cast<double>();
  setFreeTurn(robot, 0,
              {Quaternionl(R_FM).cast<double>(), (R_FM.transpose() * w_F).cast<double>(),
               (R_GM.transpose() * e).cast<double>()},
              motion);
  Scene scene;
  scene.gravity = g.cast<double>();
  AppliedWrench wrench;
  wrench.link = "body";
  wrench.at = (R_BM.transpose() * (at_B - p_BM)).cast<double>();
  wrench.axes = Axes::kRoot;
  wrench.force = f.cast<double>();
  wrench.torque = t.cast<double>();
  scene.applied_wrenches = {wrench};
  Request request;
  request.child_axes = {"j"};
  const Results results = computed(robot, scene, request, motion);
  EXPECT_LE(results.effort.lpNorm<Eigen::Infinity>(), 50 * kClosedForm);
  EXPECT_LE(results.child_axes[0].force.norm(), 50 * kClosedForm);
  EXPECT_LE(results.child_axes[0].torque.norm(), 50 * kClosedForm);
  // It is not that nothing acts.
  EXPECT_GT(motion.qdd.head<3>().norm(), 10);
}

// RBDL, tests/FloatingBaseTests.cc: x, y and z, then turns about z, y and x, in Euler's angles.
struct EulerBase {
  Eigen::Matrix<double, 6, 1> q = Eigen::Matrix<double, 6, 1>::Zero(), qd = q, qdd = q;

  // Of a floating joint: turns one after the other, each about an axis that those before turn.
  void set(const Mechanism& robot, Motion& motion) const {
    using Turn = Eigen::AngleAxisd;
    const Eigen::Quaterniond first(Turn(q[3], Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond second = first * Turn(q[4], Eigen::Vector3d::UnitY());
    const Eigen::Quaterniond R = second * Turn(q[5], Eigen::Vector3d::UnitX());
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), y = first * Eigen::Vector3d::UnitY(),
                          x = second * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d of_z = qd[3] * z, of_y = of_z + qd[4] * y, w = of_y + qd[5] * x;
    const Eigen::Vector3d e =
        qdd[3] * z + qdd[4] * y + qdd[5] * x + of_z.cross(qd[4] * y) + of_y.cross(qd[5] * x);
    for (int i = 0; i < 3; ++i) {
      motion.q[i] = q[i];
      motion.qd[i] = qd[i];
      motion.qdd[i] = qdd[i];
    }
    setFreeTurn(robot, 0, {R, R.conjugate() * w, R.conjugate() * e}, motion);
  }
};

// TestCalcPointAcceleration...: how a point of the body accelerates, of the HuMAnS toolbox, is the
// force that moves a mass of 1 kg there.
TEST(FreeBodies, OfRbdlAccelerateAsInHumans) {
  Link body;
  body.mass = 1;
  body.p_KoCm_K = {-1.9L, -1.8L, 0};
  const Mechanism robot = floating(body, Vector3l::Zero(), Matrix3l::Identity());
  Scene scene;
  scene.gravity.setZero();
  Eigen::Matrix<double, 6, 1> values;
  values << 0.1, 1.1, 1.2, 1.3, 1.5, 1.7;
  struct Row {
    bool moves, accelerates;
    Eigen::Vector3d acceleration;
  };
  for (const Row& row :
       {Row{true, false, {-5.302760158847160, 6.541369639625232, -4.795115077652286}},
        Row{false, true, {2.44, -1.37, 0.99}},
        Row{true, true, {-4.993637532756404, 10.43238173517606, -0.6948370826218673}}}) {
    EulerBase base;
    if (row.moves) base.q = base.qd = values;
    if (row.accelerates) base.qdd = values;
    Motion motion(6, 1);
    base.set(robot, motion);
    Request request;
    request.root_axes = {"j"};
    const Results results = computed(robot, scene, request, motion);
    EXPECT_LE((results.effort.head<3>() - row.acceleration).norm(), kClosedForm)
        << results.effort.transpose();
    EXPECT_LE((results.root_axes[0].force - row.acceleration).norm(), kClosedForm);
    if (!row.moves) continue;
    const Eigen::Vector3d position(-0.6357089363622626, -0.6831041744630977, 2.968974805916970);
    request.poses = true;
    const Pose pose = computed(robot, scene, request, motion).poses[0];
    EXPECT_LE((pose.position + pose.orientation * Eigen::Vector3d(-1.9, -1.8, 0) - position).norm(),
              kClosedForm);
  }
}

// TestCalcDynamicFloatingBaseDoubleImplicit: a base with one more body, which falls, also turned,
// and under a torque of 1 N m between the two.
TEST(FreeBodies, OfRbdlWithASecondBodyFallAndTurn) {
  const std::string inertial =
      "<inertial><origin xyz='1 0 0'/><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
      "iyz='0' izz='1'/></inertial></link>";
  const Mechanism robot =
      readUrdf("<robot name='r'><link name='ground_link'/><link name='base'>" + inertial +
               "<link name='a'>" + inertial +
               "<joint name='j' type='floating'><parent link='ground_link'/><child link='base'/>"
               "</joint><joint name='k' type='continuous'><parent link='base'/><child link='a'/>"
               "<origin xyz='2 0 0'/><axis xyz='0 0 1'/></joint></robot>");
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  Motion motion(7, 1);
  const int k = robot.coordinateIndex("k");
  for (const double turned : {0.0, 0.8}) {
    EulerBase base;
    base.q[3] = turned;
    base.qdd[1] = -9.81;
    base.set(robot, motion);
    EXPECT_LE(computed(robot, scene, Request(), motion).effort.norm(), kClosedForm) << turned;
  }
  EulerBase base;
  base.qdd[1] = -8.81;
  base.qdd[3] = -1;
  base.set(robot, motion);
  motion.qdd[k] = 2;
  const Eigen::VectorXd effort = computed(robot, scene, Request(), motion).effort;
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(effort[i], i == k ? 1 : 0, kClosedForm) << i;
}

// RBDL, tests/InverseDynamicsWithConstraintsTests.cc,
// CorrectnessTestWithDoublePerpendicularPendulum: two bodies in absolute coordinates that hinges
// hold together, at 60 and 30 degrees. The torques are those of the pendulum in joint coordinates,
// in closed form.
TEST(FreeBodies, OfRbdlInAbsoluteCoordinatesTakeThePendulumsTorques) {
  const Mechanism robot = readUrdf(R"(<robot name="pendulum"><link name="ground_link"/>
    <link name="one"><inertial><origin xyz="0 -0.5 0"/><mass value="1"/>
      <inertia ixx="0.3" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.3"/></inertial></link>
    <link name="two"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
      <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.3"/></inertial></link>
    <joint name="first" type="floating"><parent link="ground_link"/><child link="one"/></joint>
    <joint name="second" type="floating"><parent link="ground_link"/><child link="two"/></joint>
    </robot>)");
  const Scene scene = readScene(YAML::Load(R"({gravity: [0, -9.81, 0],
    actuated: [first.rz, second.ry], assembly: [{name: second.y, position: -1}], closures: [
      {name: z, type: revolute, parent: {link: ground_link}, child: {link: one}},
      {name: y, type: revolute, parent: {link: one, xyz: [0, -1, 0], rpy: [-1.5707963267948966, 0, 0]},
       child: {link: two, rpy: [-1.5707963267948966, 0, 0]}}]})"));
  const double a = M_PI / 3, b = M_PI / 6, g = 9.81;
  const Eigen::Quaterniond one(Eigen::AngleAxisd(a, Eigen::Vector3d::UnitZ()));
  const Eigen::Quaterniond two = one * Eigen::AngleAxisd(b, Eigen::Vector3d::UnitY());
  Motion motion(12, 2);
  const Eigen::Vector3d hinge = one * Eigen::Vector3d(0, -1, 0);
  for (int i = 0; i < 3; ++i)
    motion.q[robot.coordinateIndex(std::string("second.") + "xyz"[i])] = hinge[i];
  motion.orientations = {one, two};
  if (robot.freeJoint(0).name == "second")
    std::swap(motion.orientations[0], motion.orientations[1]);
  Request request;
  request.determinacy = true;
  const Results results = computed(robot, scene, request, motion);
  for (const ClosureResidual& residual : results.loops.residuals)
    EXPECT_LE(residual.position, 1e-15);
  // Of the first the weights' levers along x, of the second about its axis.
  const double first =
      g * (0.5 * std::sin(a)) + g * (std::sin(a) + 0.5 * std::cos(b) * std::cos(a));
  const double second = -g * 0.5 * std::sin(b) * std::sin(a);
  for (int i = 0; i < 12; ++i) {
    const double expected = i == robot.coordinateIndex("first.rz")    ? first
                            : i == robot.coordinateIndex("second.ry") ? second
                                                                      : 0;
    EXPECT_NEAR(results.effort[i], expected, 1e-12) << robot.coordinateNames()[i];
  }
}

// RigidBodyDynamics.jl, test/urdf/planar_slider.urdf with test_urdf.jl: the axes that its slides
// take in the planes of three normals. URDF does not say which; ours are others, turned about the
// normal, and from one to the other goes the same body with the same forces.
TEST(FreeBodies, InPlanesMoveAlongTheAxesOfRigidBodyDynamics) {
  struct Plane {
    const char* normal;
    Eigen::Vector3d n, x, y;  // the published axes
  };
  const Eigen::Vector3d X = Eigen::Vector3d::UnitX(), Y = Eigen::Vector3d::UnitY(),
                        Z = Eigen::Vector3d::UnitZ();
  for (const Plane& plane :
       {Plane{"1 0 0", X, -Z, Y}, Plane{"0 1 0", Y, X, -Z}, Plane{"0 0 1", Z, X, Y}}) {
    SCOPED_TRACE(plane.normal);
    const Mechanism robot = readUrdf(
        std::string("<robot name='r'><link name='base'/><link name='slider'><inertial>"
                    "<origin xyz='0.1 0.2 0.3'/><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' "
                    "iyy='1' iyz='0' izz='1'/></inertial></link><joint name='j' type='planar'>"
                    "<parent link='base'/><child link='slider'/><axis xyz='") +
        plane.normal + "'/></joint></robot>");
    Request request;
    request.root_axes = {"j"};
    request.poses = true;
    // Our own axes: where the slides go.
    Eigen::Matrix<double, 3, 2> own;
    for (int i = 0; i < 2; ++i) {
      Motion motion(3);
      motion.q[i] = 1;
      own.col(i) = computed(robot, Scene(), request, motion).poses[0].position;
    }
    Eigen::Matrix<double, 3, 2> published;
    published << plane.x, plane.y;
    const Eigen::Matrix2d turn = own.transpose() * published;
    EXPECT_NEAR(turn.determinant(), 1, 1e-15);  // right-handed both, about the same normal
    Scene scene;
    scene.gravity = {1, 2, -9};
    const Eigen::Vector2d q(0.3, -0.7), qdd(1.1, -2.3);
    Motion motion(3);
    motion.q << turn * q, 0.4;
    motion.qdd << turn * qdd, 0.6;
    const Results results = computed(robot, scene, request, motion);
    EXPECT_LE((results.poses[0].position - published * q).norm(), 1e-15);
    // Newton and Euler for the body, at rest, turned by 0.4 about the normal.
    const Eigen::Vector3d r = Eigen::AngleAxisd(0.4, plane.n) * Eigen::Vector3d(0.1, 0.2, 0.3);
    const Eigen::Vector3d force =
        2 * (published * qdd + 0.6 * plane.n.cross(r) - Eigen::Vector3d(1, 2, -9));
    const Eigen::Vector2d effort = turn.transpose() * results.effort.head<2>();
    EXPECT_NEAR(effort[0], plane.x.dot(force), 1e-13);
    EXPECT_NEAR(effort[1], plane.y.dot(force), 1e-13);
    EXPECT_NEAR(results.effort[2], plane.n.dot(0.6 * plane.n + r.cross(force)), 1e-13);
  }
}

// How the ball of a top turns under no effort: inverse dynamics is linear in accelerations, so that
// three of them tell the acceleration that needs none.
struct Top {
  Top() : robot(top()), dynamics(robot, scene(), Request()), workspace(dynamics.makeWorkspace()) {}

  static Scene scene() { return Scene(); }
  static Mechanism top() {
    return readUrdf(R"(<robot name="top"><link name="base"/><link name="top"><inertial>
      <origin xyz="0 1 0"/><mass value="15"/><inertia ixx="0.234375" ixy="0" ixz="0" iyy="0.46875"
      iyz="0" izz="0.234375"/></inertial></link><joint name="j" type="floating">
      <parent link="base"/><child link="top"/></joint></robot>)");
  }

  Eigen::Vector3d moment(const Eigen::Quaterniond& q, const Eigen::Vector3d& w,
                         const Eigen::Vector3d& e) {
    Motion motion(6, 1);
    setFreeTurn(robot, 0, {q, w, e}, motion);
    dynamics.compute(motion, workspace);
    return workspace.results().effort.tail<3>();
  }
  Eigen::Vector3d acceleration(const Eigen::Quaterniond& q, const Eigen::Vector3d& w) {
    const Eigen::Vector3d at_rest = moment(q, w, Eigen::Vector3d::Zero());
    Eigen::Matrix3d by;
    for (int i = 0; i < 3; ++i) by.col(i) = moment(q, w, Eigen::Vector3d::Unit(i)) - at_rest;
    return by.partialPivLu().solve(-at_rest);
  }

  Mechanism robot;
  Dynamics dynamics;
  Dynamics::Workspace workspace;
};

// EXUDYN, TestModels/heavyTop.py (Terze, Mueller, Zlatar 2016): 15 kg, centre 1 m from the point,
// 150 rad/s; its Euler parameters at 0.2 s by RK4, to five digits. The point is a ball whose force
// is not asked for: slides that rest.
TEST(FreeBodies, OfExudynsHeavyTopTurnAsItDoes) {
  Top top;
  using State = Eigen::Matrix<double, 7, 1>;  // w, x, y, z; rates in body axes
  const auto slope = [&](const State& state) {
    const Eigen::Vector3d w = state.tail<3>();
    const Eigen::Quaterniond q(state[0], state[1], state[2], state[3]);
    const Eigen::Quaterniond rate = q * Eigen::Quaterniond(0, w.x(), w.y(), w.z());
    State result;
    result << rate.w() / 2, rate.vec() / 2, top.acceleration(q.normalized(), w);
    return result;
  };
  State state;
  state << 1, 0, 0, 0, 0, 150, -4.61538;
  const double h = 1e-4;
  for (int step = 0; step < 2000; ++step) {
    const State a = slope(state), b = slope(state + h / 2 * a), c = slope(state + h / 2 * b),
                d = slope(state + h * c);
    state += h / 6 * (a + 2 * b + 2 * c + d);
  }
  const Eigen::Vector4d published(-0.70828, 0.43878, 0.54573, 0.0894);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(state[i], published[i], i == 3 ? 5e-5 : 5e-6) << state.transpose();
  EXPECT_NEAR(state.head<4>().norm(), 1, 1e-6);
}

}  // namespace
}  // namespace virtual_work_dynamics
