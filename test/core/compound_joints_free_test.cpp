#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <string>

#include "compound_cases.h"
#include "compound_oracle.h"
#include "loop_examples.h"
#include "moving_roots.h"
#include "tree/sample_block.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Of the same motion in other coordinates, relative to the largest number.
constexpr double kThreeWays = 1e-13;
constexpr double kClosedForm = 1e-13;

Results computed(const Mechanism& mechanism, const Scene& scene, const Request& request,
                 const Motion& motion) {
  const Dynamics dynamics(mechanism, scene, request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(motion, workspace);
  return workspace.results();
}

// The mechanism with a base before it on which its root floats, as a joint or as nothing else.
Mechanism onBase(const Mechanism& mechanism) {
  std::vector<Link> links(1);
  std::vector<Joint> joints(1);
  links[0].name = "world";
  joints[0].name = "float";
  joints[0].child_link = 1;
  for (Link link : mechanism.links()) {
    ++link.parent_joint;
    links.push_back(link);
  }
  for (Joint joint : mechanism.joints()) {
    ++joint.parent_link;
    ++joint.child_link;
    joints.push_back(joint);
  }
  return Mechanism("on_base", links, joints);
}

void expectClose(const Eigen::Vector3d& found, const Eigen::Vector3d& expected, double size,
                 const std::string& what) {
  EXPECT_LE((found - expected).norm(), kThreeWays * size) << what;
}

// A six-axis arm on a carrier: its root moves, it hangs on six joints, or it floats.
TEST(CompoundJoints, OfACarrierMayBeItsRootSixJointsOrAFloatingOne) {
  const LoopExample arm("six_axis_arm");
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> angle(-3, 3);
  for (int trial = 0; trial < 20; ++trial) {
    const auto three = [&] {
      const double x = angle(generator), y = angle(generator);
      return Eigen::Vector3d(x, y, angle(generator));
    };
    Scene scene;
    scene.gravity = {1, -2, -9};
    const CarrierAngles carrier{three(), three(), three()};
    const Eigen::Vector3d p = three(), v = three(), a = three();
    const Eigen::Index n = 6;
    Motion motion(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      motion.q[i] = angle(generator);
      motion.qd[i] = angle(generator);
      motion.qdd[i] = angle(generator);
    }
    const RootMotion root = carrier.root(p, v, a);
    Request request;
    request.child_axes = requestedReactions(arm.mechanism, Scene());
    request.child_axes.insert(request.child_axes.begin(), kGround);

    Scene moving = scene;
    moving.root_moves = true;
    motion.root = root;
    const Results by_root = computed(arm.mechanism, moving, request, motion);

    const CarriedMechanism carried(arm.mechanism);
    Motion of_six(n + 6);
    of_six.q << p, carrier.angles, motion.q;
    of_six.qd << v, carrier.rates, motion.qd;
    of_six.qdd << a, carrier.accelerations, motion.qdd;
    Request below = request;
    below.child_axes[0] = "carrier_roll";
    const Results by_six = computed(carried.mechanism(), scene, below, of_six);

    Scene floating = scene;
    floating.joint_types.resize(1);
    floating.joint_types[0].joint = "float";
    floating.joint_types[0].type = CompoundType::kFloating;
    const Mechanism free = withJointTypes(onBase(arm.mechanism), floating);
    Motion of_float(n + 6, 1);
    of_float.q.tail(n) = motion.q;
    of_float.qd.tail(n) = motion.qd;
    of_float.qdd.tail(n) = motion.qdd;
    of_float.q.head<3>() = p;
    of_float.qd.head<3>() = v;
    of_float.qdd.head<3>() = a;
    const Eigen::Quaterniond back = root.orientation.conjugate();
    setFreeTurn(free, 0,
                {root.orientation, back * root.angular_velocity, back * root.angular_acceleration},
                of_float);
    below.child_axes[0] = "float";
    const Results by_float = computed(free, floating, below, of_float);

    double size = 0;
    for (const Wrench& wrench : by_root.child_axes) {
      size = std::max({size, wrench.force.norm(), wrench.torque.norm()});
    }
    for (std::size_t i = 0; i < request.child_axes.size(); ++i) {
      for (const Results* other : {&by_six, &by_float}) {
        const std::string& name = request.child_axes[i];
        expectClose(other->child_axes[i].force, by_root.child_axes[i].force, size, name);
        expectClose(other->child_axes[i].torque, by_root.child_axes[i].torque, size, name);
      }
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      EXPECT_NEAR(by_six.effort[6 + i], by_root.effort[i], kThreeWays * size);
      EXPECT_NEAR(by_float.effort[6 + i], by_root.effort[i], kThreeWays * size);
    }
    // The force along the base's axes, and the moment in axes of the arm's root.
    const Eigen::Vector3d force = by_float.effort.head<3>();
    expectClose(back * force, by_root.child_axes[0].force, size, "force");
    expectClose(by_float.effort.segment<3>(3), by_root.child_axes[0].torque, size, "moment");
  }
}

constexpr char kBody[] =
    "<robot name='b'><link name='base'/><link name='body'><inertial><origin xyz='X'/>"
    "<mass value='M'/><inertia ixx='A' ixy='0' ixz='0' iyy='A' iyz='0' izz='J'/></inertial></link>"
    "<joint name='j' type='floating'><parent link='base'/><child link='body'/></joint></robot>";

Mechanism body(const std::string& mass, const std::string& com, const std::string& across,
               const std::string& axial) {
  std::string text = kBody;
  const auto put = [&](const std::string& from, const std::string& to) {
    for (std::size_t at; (at = text.find("'" + from + "'")) != std::string::npos;) {
      text.replace(at, from.size() + 2, "'" + to + "'");
    }
  };
  put("M", mass);
  put("X", com);
  put("A", across);
  put("J", axial);
  return readUrdf(text);
}

// RBDL, tests/InverseDynamicsTests.cc: a free body of 1 kg, com (1, 0, 0), I = 1, to 1e-14. The
// accelerations that these efforts make come from Newton's and Euler's equations in long double.
TEST(CompoundJoints, ThatFloatTakeTheEffortsThatMakeTheirMotion) {
  const Mechanism robot = body("1", "1 0 0", "1", "1");
  const Scene scene;
  Eigen::Matrix<long double, 6, 1> tau;
  tau << 2.1L, 2.2L, 2.3L, 1.1L, 1.2L, 1.3L;
  using Turn = Eigen::AngleAxisd;
  FreeTurn turn;
  turn.orientation = Turn(0.1, Eigen::Vector3d::UnitZ()) * Turn(0.2, Eigen::Vector3d::UnitY()) *
                     Turn(0.3, Eigen::Vector3d::UnitX());
  turn.angular_velocity = {-0.1, 0.2, -0.3};
  Motion motion(6, 1);
  motion.q.head<3>() << 1.1, 1.2, 1.3;
  motion.qd.head<3>() << 1.1, -1.2, 1.3;
  // Newton and Euler: F = m a_C less gravity, M about the origin = c x F + I e + w x (I w).
  const Matrix3l R = turn.orientation.cast<long double>().toRotationMatrix();
  const Vector3l w = turn.angular_velocity.cast<long double>(), c = Vector3l::UnitX();
  const Vector3l F = R.transpose() * tau.head<3>(), M = tau.tail<3>();
  const Vector3l e = M - c.cross(F);  // I = 1, w x w = 0
  const Vector3l a_C = F + R.transpose() * scene.gravity.cast<long double>();
  const Vector3l a = R * (a_C - e.cross(c) - w.cross(w.cross(c)));
  motion.qdd.head<3>() = a.cast<double>();
  turn.angular_acceleration = e.cast<double>();
  setFreeTurn(robot, 0, turn, motion);
  Request request;
  request.child_axes = {"j"};
  const Results results = computed(robot, Scene(), request, motion);
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(results.effort[i], static_cast<double>(tau[i]), 1e-14) << i;
  }
  LagrangeDynamics<double> lagrange(robot, Scene(), request);
  lagrange.compute(motion);
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(lagrange.effort()[i], static_cast<double>(tau[i]), 1e-14) << i;
  }
}

// Drake, benchmarks/free_body: without moments, an axially symmetric body keeps its axial rate, and
// the transverse rates turn at (1 - J / I) w_z. It tumbles through every attitude.
TEST(CompoundJoints, ThatFloatFreelyNeedNoEffort) {
  const double across = 0.04, axial = 0.07, axial_rate = 3;
  const Mechanism robot = body("2", "0 0 0", "0.04", "0.07");
  const double s = (1 - axial / across) * axial_rate;
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  Request request;
  request.child_axes = {"j"};
  for (int i = 0; i < 200; ++i) {
    const double t = 0.01 * i;
    FreeTurn turn;
    const double a = normal(generator), b = normal(generator), c = normal(generator);
    turn.orientation = Eigen::Quaterniond(a, b, c, normal(generator)).normalized();
    if (i % 10 == 0) turn.orientation = Eigen::Quaterniond(std::sqrt(0.5), 0, std::sqrt(0.5), 0);
    turn.angular_velocity = {2 * std::cos(s * t), -2 * std::sin(s * t), axial_rate};
    turn.angular_acceleration = {-2 * s * std::sin(s * t), -2 * s * std::cos(s * t), 0};
    Motion motion(6, 1);
    motion.qdd.head<3>() << 0, 0, -9.81;
    setFreeTurn(robot, 0, turn, motion);
    const Results results = computed(robot, Scene(), request, motion);
    EXPECT_LE(results.effort.norm(), kClosedForm) << i;
    EXPECT_LE(results.child_axes[0].force.norm(), kClosedForm) << i;
    EXPECT_LE(results.child_axes[0].torque.norm(), kClosedForm) << i;
  }
}

// Drake, multibody_plant_reaction_forces_test.cc, WeldedAndFloating: what holds a floating body of
// 4 kg against 10 m/s^2 is 40 N, and nothing of it is borne.
TEST(CompoundJoints, ThatFloatBearNothing) {
  const Mechanism robot = body("4", "0.1 0.2 0.3", "1", "1");
  Scene scene;
  scene.gravity = {0, 0, -10};
  Request request;
  request.root_axes = {"j"};
  Motion motion(6, 1);
  motion.orientations[0] = Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5);
  EXPECT_NEAR(computed(robot, scene, request, motion).effort[2], 40, 40 * kClosedForm);
  scene.include_active = false;
  const Wrench borne = computed(robot, scene, request, motion).root_axes[0];
  EXPECT_EQ(borne.force, Eigen::Vector3d::Zero());
  EXPECT_EQ(borne.torque, Eigen::Vector3d::Zero());
}

// The same motion with angles of some radians and folded into orientations.
TEST(CompoundJoints, ThatTurnFreelyMayBeTurnedOnByTheirAngles) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    CompoundCase compound(seed);
    if (compound.mechanism.orientations() == 0) continue;
    const auto count = static_cast<Eigen::Index>(compound.mechanism.orientations());
    for (Eigen::Index i = 0; i < count; ++i) {
      const int angles = compound.mechanism.anglesOf(static_cast<std::size_t>(i));
      compound.motion.q.segment<3>(angles) << 0.7, -0.9, 1.3;
    }
    Request request;
    request.child_axes = request.root_axes = {kGround};
    for (const Joint& joint : compound.described.joints()) request.root_axes.push_back(joint.name);
    const Results before = computed(compound.mechanism, compound.scene, request, compound.motion);
    Motion folded = compound.motion;
    foldFreeTurns(compound.mechanism, folded);
    ErrorBound bound(compound.mechanism, compound.scene);
    bound.compute(folded);
    const Results after = computed(compound.mechanism, compound.scene, request, folded);
    for (std::size_t i = 0; i < request.root_axes.size(); ++i) {
      const std::string& name = request.root_axes[i];
      const int joint = name == kGround ? -1 : compound.mechanism.reactionIndex(name);
      const WrenchMagnitude& size = bound.wrenches()[static_cast<std::size_t>(joint + 1)];
      EXPECT_LE((after.root_axes[i].force - before.root_axes[i].force).norm(), 1e-13 * size.force)
          << seed << " " << name;
      EXPECT_LE((after.root_axes[i].torque - before.root_axes[i].torque).norm(),
                1e-13 * (size.moment + size.force))
          << seed << " " << name;
    }
  }
}

TEST(CompoundJoints, OfBlocksHaveTheSameBits) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const CompoundCase compound(seed, seed % 5 == 0);
    if (compound.mechanism.orientations() == 0) continue;
    constexpr Eigen::Index kRows = 11;
    const Eigen::Index coordinates = compound.motion.q.size();
    const auto numbers = static_cast<Eigen::Index>(4 * compound.motion.orientations.size());
    MotionTable table;
    table.positions.resize(kRows, coordinates);
    table.velocities = table.accelerations = table.positions;
    table.orientations.resize(kRows, numbers);
    std::vector<Motion> motions;
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    for (Eigen::Index row = 0; row < kRows; ++row) {
      Motion motion = compound.motion;
      motion.q[0] += static_cast<double>(row);
      for (std::size_t i = 0; i < motion.orientations.size(); ++i) {
        const double a = normal(generator), b = normal(generator), c = normal(generator);
        motion.orientations[i] = Eigen::Quaterniond(a, b, c, normal(generator)).normalized();
        table.orientations.row(row).segment<4>(static_cast<Eigen::Index>(4 * i)) =
            motion.orientations[i].coeffs();
      }
      table.positions.row(row) = motion.q;
      table.velocities.row(row) = motion.qd;
      table.accelerations.row(row) = motion.qdd;
      motions.push_back(motion);
    }
    Request request;
    request.child_axes = {kGround};
    const InverseDynamics dynamics(compound.mechanism, compound.scene, request);
    SampleBlock block(dynamics, kRows);
    block.compute(table, 0, kRows, nullptr);
    Workspace one = dynamics.makeWorkspace(), of_block = dynamics.makeWorkspace();
    for (Eigen::Index row = 0; row < kRows; ++row) {
      dynamics.compute(motions[static_cast<std::size_t>(row)], one);
      block.read(static_cast<std::size_t>(row), of_block);
      EXPECT_EQ(one.effort(), of_block.effort()) << seed;
      EXPECT_EQ(one.childAxes()[0].torque, of_block.childAxes()[0].torque) << seed;
    }
  }
}

TEST(CompoundJoints, ThatTurnFreelyNeedOrientations) {
  const Mechanism robot = body("1", "0 0 0", "1", "1");
  const Dynamics dynamics(robot, Scene());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const auto lineOf = [&](const Motion& motion) {
    try {
      dynamics.compute(motion, workspace);
      return std::string();
    } catch (const MotionError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(lineOf(Motion(6)), "");  // all are the identity
  EXPECT_EQ(lineOf(Motion(6, 2)),
            "motion: it has 2 orientations, the mechanism has 1 joints that turn freely");
  Motion motion(6, 1);
  motion.orientations[0].w() = 1.001;
  EXPECT_EQ(lineOf(motion), "motion: an orientation has the length 1.001, not 1");
}

}  // namespace
}  // namespace virtual_work_dynamics
