#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "loop_examples.h"
#include "moving_roots.h"
#include "newton_euler_oracle.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

Scene movingScene() {
  Scene scene;
  scene.root_moves = true;
  return scene;
}

Request groundOnly() {
  Request request;
  request.child_axes.emplace_back(kGround);
  return request;
}

// What remains of ground's wrench where nothing holds the root, over 4 (L + 2) eps S: gravity is
// turned, and what moves the root is rounded.
double residual(const Mechanism& mechanism, const Motion& motion, const Wrench& ground) {
  ErrorBound bound(mechanism, movingScene());
  bound.compute(motion);
  const double unit = 4 * kEps * (bound.depths()[0] + 2);
  return std::max(ground.force.norm() / (unit * bound.wrenches()[0].force),
                  ground.torque.norm() / (unit * bound.wrenches()[0].moment));
}

/// A body that turns freely in closed form: symmetric about its z axis, which precesses about the
/// angular momentum, while its centre of mass, beside the link's origin, falls.
class SpinningTop {
 public:
  static constexpr long double kMass = 3, kTransverse = 0.2L, kAxial = 0.05L;

  Mechanism mechanism() const {
    return readUrdf(R"(<robot name="top"><link name="top"><inertial>
      <origin xyz="0.125 -0.25 0.5"/><mass value="3"/>
      <inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.05"/></inertial></link></robot>)");
  }

  /// @param tilt of the axis against the angular momentum, which is along inertial y
  Motion at(long double t, long double tilt) const {
    using Turn = Eigen::AngleAxis<long double>;
    const long double momentum = 1.7L;
    const Vector3l L = Vector3l::UnitY();
    const long double precession = momentum / kTransverse;
    const long double spin = momentum * std::cos(tilt) / kAxial - precession * std::cos(tilt);
    const Matrix3l z_to_L = Turn(-kPi / 2, Vector3l::UnitX()).toRotationMatrix();
    const Matrix3l R = Turn(precession * t, L) * z_to_L * Turn(tilt, Vector3l::UnitX()) *
                       Turn(spin * t, Vector3l::UnitZ());
    const Vector3l axis = R.col(2);
    const Vector3l w = precession * L + spin * axis, alpha = spin * w.cross(axis);
    const Vector3l r = R * Vector3l(-0.125L, 0.25L, -0.5L);
    Motion motion(0);
    motion.root.orientation = Eigen::Quaternion<long double>(R).normalized().cast<double>();
    motion.root.angular_velocity = w.cast<double>();
    motion.root.angular_acceleration = alpha.cast<double>();
    motion.root.acceleration =
        (Vector3l(0, 0, -9.81L) + alpha.cross(r) + w.cross(w.cross(r))).cast<double>();
    return motion;
  }
};

TEST(FreeRoot, TumblesThroughEveryAttitudeWithoutForces) {
  const SpinningTop top;
  const Mechanism mechanism = top.mechanism();
  const InverseDynamics dynamics(mechanism, movingScene(), groundOnly());
  Workspace workspace = dynamics.makeWorkspace();
  LagrangeDynamics<double> lagrange(mechanism, movingScene(), groundOnly());
  double steepest = 0;
  for (const long double tilt : {0.3L, 1.2L, kPi / 2, 2.5L}) {
    for (int i = 0; i < 2000; ++i) {
      const Motion motion = top.at(0.0013L * i, tilt);
      dynamics.compute(motion, workspace);
      lagrange.compute(motion);
      ASSERT_LE(residual(mechanism, motion, workspace.childAxes()[0]), 1) << i;
      ASSERT_LE(residual(mechanism, motion, lagrange.childAxes()[0]), 2) << i;
      const Eigen::Matrix3d R = motion.root.orientation.toRotationMatrix();
      steepest = std::max(steepest, std::abs(R(2, 0)));
    }
  }
  EXPECT_GT(steepest, 1 - 1e-5);  // pitch within 0.3 degrees of 90
  // A push that the motion does not show is one.
  Motion pushed = top.at(0.1L, 1.2L);
  pushed.root.acceleration.x() += 1e-9;
  dynamics.compute(pushed, workspace);
  EXPECT_GT(residual(mechanism, pushed, workspace.childAxes()[0]), 1e3);
}

// The acceleration of a root that nothing holds, from the balance of momentum of all links.
void letFly(const Mechanism& mechanism, Motion& motion) {
  using Vector6l = Eigen::Matrix<long double, 6, 1>;
  const auto demand = [&](const Vector6l& acceleration) {
    Motion tried = motion;
    tried.root.acceleration = acceleration.head<3>().cast<double>();
    tried.root.angular_acceleration = acceleration.tail<3>().cast<double>();
    const NewtonEulerOracle::RootWrench wrench =
        NewtonEulerOracle(mechanism, movingScene(), tried).reaction(-1);
    Vector6l sum;
    sum << wrench.force, wrench.torque;
    return sum;
  };
  const Vector6l without = demand(Vector6l::Zero());
  Eigen::Matrix<long double, 6, 6> inertia;
  for (int i = 0; i < 6; ++i) inertia.col(i) = demand(Vector6l::Unit(i)) - without;
  const Vector6l acceleration = inertia.partialPivLu().solve(-without);
  motion.root.acceleration = acceleration.head<3>().cast<double>();
  motion.root.angular_acceleration = acceleration.tail<3>().cast<double>();
}

TEST(FreeRoot, OfATreeThatJumpsBearsNothing) {
  std::mt19937 generator(30);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RandomRobot random(seed, 31);
    const Mechanism mechanism = readUrdf(random.urdf());
    ASSERT_EQ(mechanism.joints().size(), 30U);
    Motion motion = random.motion(mechanism);
    motion.root = randomRootMotion(generator);
    letFly(mechanism, motion);
    const InverseDynamics dynamics(mechanism, movingScene(), groundOnly());
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, workspace);
    EXPECT_LE(residual(mechanism, motion, workspace.childAxes()[0]), 1) << seed;
    EXPECT_GT(workspace.effort().norm(), 1);
  }
}

/// A motion of an example's joints and of its root, and the same on six joints before the root.
struct CarriedLoops {
  template <typename F>
  CarriedLoops(const std::string& name, const F& positions, long double t, unsigned seed)
      : example(name), generator(seed), mechanism(CarriedMechanism(example.mechanism).mechanism()) {
    std::uniform_real_distribution<double> uniform(-1.3, 1.3);
    const auto vector = [&] {
      const double x = uniform(generator), y = uniform(generator);
      return Eigen::Vector3d(x, y, uniform(generator));
    };
    moving = example.scene;
    moving.root_moves = true;
    carried = example.scene;
    for (int i = 0; i < CarriedMechanism::kJoints; ++i) {
      carried.actuated->push_back(mechanism.joint(i).name);
    }
    motion = motionAt(example.mechanism, positions, t);
    const CarrierAngles angles{vector(), 2 * vector(), 4 * vector()};
    const Eigen::Vector3d p = vector(), v = vector(), a = 4 * vector();
    motion.root = angles.root(p, v, a);
    carried_motion = Motion(motion.q.size() + CarriedMechanism::kJoints);
    carried_motion.q << p, angles.angles, motion.q;
    carried_motion.qd << v, angles.rates, motion.qd;
    carried_motion.qdd << a, angles.accelerations, motion.qdd;
  }

  LoopExample example;
  std::mt19937 generator;
  Mechanism mechanism;
  Scene moving, carried;
  Motion motion, carried_motion;
};

double largestForce(const std::vector<Wrench>& wrenches) {
  double largest = 0;
  for (const Wrench& wrench : wrenches) largest = std::max(largest, wrench.force.norm());
  return largest;
}

void expectTheSameOnSixJoints(const CarriedLoops& loops) {
  Request request;
  request.child_axes = requestedReactions(loops.example.mechanism, loops.moving);
  const Dynamics moves(loops.example.mechanism, loops.moving, request);
  const Dynamics hangs(loops.mechanism, loops.carried, request);
  Dynamics::Workspace found = moves.makeWorkspace(), expected = hangs.makeWorkspace();
  moves.compute(loops.motion, found);
  hangs.compute(loops.carried_motion, expected);
  const Results &a = found.results(), &b = expected.results();
  const double unit = 1e-12 * largestForce(b.child_axes);  // moments: the loops are a metre at most
  for (std::size_t i = 0; i < request.child_axes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto j = static_cast<std::size_t>(axis);
      ASSERT_EQ(a.loops.child_axes_determined[i][j], b.loops.child_axes_determined[i][j]);
      if (a.loops.child_axes_determined[i][j]) {
        EXPECT_NEAR(a.child_axes[i].force[axis], b.child_axes[i].force[axis], unit) << i;
      }
      if (a.loops.child_axes_determined[i][j + 3]) {
        EXPECT_NEAR(a.child_axes[i].torque[axis], b.child_axes[i].torque[axis], unit) << i;
      }
    }
  }
  for (Eigen::Index i = 0; i < loops.motion.q.size(); ++i) {
    EXPECT_NEAR(a.effort[i], b.effort[i + CarriedMechanism::kJoints], unit);
  }
}

TEST(MovingLoops, AreThoseOnSixJoints) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const long double t = 0.17L * seed;
    expectTheSameOnSixJoints(CarriedLoops("four_bar", fourBarAt, t, seed));
    expectTheSameOnSixJoints(CarriedLoops("slider_crank", sliderCrankAt, t, seed));
    expectTheSameOnSixJoints(CarriedLoops("planar_3rrr", planar3rrrAt, t, seed));
  }
}

// Deviations on a root that only accelerates are those in another gravity.
TEST(MovingRoot, HasTheDeviationsOfItsJoints) {
  RandomRobot random(4, 7);
  const Mechanism mechanism = readUrdf(random.urdf());
  Motion motion = random.motion(mechanism);
  std::mt19937 generator(4);
  motion.root = randomRootMotion(generator);
  motion.root.angular_velocity.setZero();
  motion.root.angular_acceleration.setZero();
  Scene rests;
  rests.gravity =
      motion.root.orientation.conjugate() * (movingScene().gravity - motion.root.acceleration);
  const MotionCovariance covariance{std::vector<Eigen::Matrix3d>(
      mechanism.coordinates().size(), Eigen::Vector3d(1e-8, 1e-6, 1e-4).asDiagonal())};
  const auto deviationsIn = [&](const Scene& scene) {
    const Deviations deviations(mechanism, scene, Request());
    Deviations::Workspace workspace = deviations.makeWorkspace();
    deviations.computeMotion(motion, covariance, workspace);
    return Eigen::VectorXd(workspace.motion().effort);
  };
  const Eigen::VectorXd found = deviationsIn(movingScene()), expected = deviationsIn(rests);
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    EXPECT_GT(expected[i], 0);
    EXPECT_NEAR(found[i], expected[i], 1e-6 * expected[i]);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
