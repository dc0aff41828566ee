#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "bounded_wrenches.h"
#include "moving_roots.h"
#include "newton_euler_oracle.h"
#include "plain_results.h"
#include "random_motions.h"
#include "random_wrenches.h"
#include "sample_robots.h"
#include "tree/sample_block.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/error_bound.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr int kRobots = 40;

Scene movingScene(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Scene scene;
  scene.root_moves = true;
  scene.gravity = {3 * normal(generator), 3 * normal(generator), -9.81};
  return scene;
}

/// A random tree, a scene in which its root moves, and a motion of both.
struct Moving {
  explicit Moving(unsigned seed, bool is_static = false)
      : random(seed, 3 + static_cast<int>(seed % 12)),
        mechanism(readUrdf(random.urdf())),
        generator(seed),
        scene(movingScene(generator)),
        motion(random.motion(mechanism)) {
    scene.static_motion = is_static;
    motion.root = randomRootMotion(generator);
    addAppliedWrenches(random, static_cast<int>(mechanism.links().size()), scene);
  }

  RandomRobot random;
  Mechanism mechanism;
  std::mt19937 generator;
  Scene scene;
  Motion motion;
};

double distance(const Wrench& found, const NewtonEulerOracle::RootWrench& expected,
                const WrenchMagnitude& unit) {
  const double force =
      static_cast<double>((found.force.cast<long double>() - expected.force).norm());
  const double torque =
      static_cast<double>((found.torque.cast<long double>() - expected.torque).norm());
  return std::max(unit.force > 0 ? force / unit.force : force,
                  unit.moment > 0 ? torque / unit.moment : torque);
}

// The largest error over 4 L eps S; one step more than L, which turns gravity into root axes.
double errorOf(const Moving& moving) {
  const InverseDynamics dynamics(moving.mechanism, moving.scene,
                                 requestEveryJoint(moving.mechanism));
  Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(moving.motion, workspace);
  ErrorBound bound(moving.mechanism, moving.scene);
  bound.compute(moving.motion);
  const NewtonEulerOracle oracle(moving.mechanism, moving.scene, moving.motion);
  double worst = 0;
  for (std::size_t i = 0; i < moving.mechanism.links().size(); ++i) {
    const double unit = 4 * kEps * (bound.depths()[i] + 1);
    const WrenchMagnitude magnitude{unit * bound.wrenches()[i].force,
                                    unit * bound.wrenches()[i].moment};
    const int joint = static_cast<int>(i) - 1;
    worst =
        std::max(worst, distance(workspace.childAxes()[i], oracle.childReaction(joint), magnitude));
    worst = std::max(worst, distance(workspace.rootAxes()[i], oracle.reaction(joint), magnitude));
  }
  const std::vector<long double> efforts = oracle.efforts();
  for (std::size_t i = 0; i < efforts.size(); ++i) {
    const double unit = 4 * kEps * (bound.effortDepths()[i] + 1) * bound.efforts()[i];
    const double error = static_cast<double>(std::abs(
        efforts[i] - static_cast<long double>(workspace.effort()[static_cast<Eigen::Index>(i)])));
    worst = std::max(worst, unit > 0 ? error / unit : error);
  }
  return worst;
}

TEST(MovingRoot, IsThatOfNewtonAndEuler) {
  double worst = 0;
  for (unsigned seed = 1; seed <= kRobots; ++seed) {
    for (const bool is_static : {false, true}) {
      const double error = errorOf(Moving(seed, is_static));
      EXPECT_LE(error, 1) << "seed " << seed << (is_static ? ", static" : "");
      worst = std::max(worst, error);
    }
  }
  RecordProperty("worst", std::to_string(worst));
}

TEST(MovingRoot, OfLagrangesEquationsIsTheSame) {
  for (unsigned seed = 1; seed <= kRobots; ++seed) {
    const Moving moving(seed, seed % 5 == 0);
    const Request request = requestEveryJoint(moving.mechanism);
    const InverseDynamics dynamics(moving.mechanism, moving.scene, request);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(moving.motion, workspace);
    LagrangeDynamics<double> lagrange(moving.mechanism, moving.scene, request);
    lagrange.compute(moving.motion);
    ErrorBound bound(moving.mechanism, moving.scene);
    bound.compute(moving.motion);
    expectTheSame(workspace.childAxes(), lagrange.childAxes(), 1e-13, bound);
    expectTheSame(workspace.rootAxes(), lagrange.rootAxes(), 1e-13, bound);
    for (Eigen::Index i = 0; i < workspace.effort().size(); ++i) {
      EXPECT_NEAR(workspace.effort()[i], lagrange.effort()[i],
                  1e-13 * bound.efforts()[static_cast<std::size_t>(i)])
          << seed;
    }
  }
}

TEST(MovingRoot, IsCertified) {
  for (unsigned seed = 1; seed <= kRobots; ++seed) {
    Moving moving(seed, seed % 5 == 0);
    const Request request = Certifier::extended({});
    const InverseDynamics dynamics(moving.mechanism, moving.scene, request);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(moving.motion, workspace);
    Certifier certifier(moving.mechanism, moving.scene);
    const Wrench ground = workspace.childAxes()[Certifier::groundIndex(request)];
    const auto largest = [&] {
      return certifier.check(moving.motion, workspace.effort(), ground).largest();
    };
    EXPECT_LE(largest(), 1e-14) << seed;
    if (moving.scene.static_motion) continue;
    // What belongs to another motion of the root is not.
    moving.motion.root.angular_acceleration.x() += 1e-3;
    EXPECT_GE(largest(), 1e-9) << seed;
  }
}

TEST(MovingRoot, OfBlocksHasTheSameBits) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Moving moving(seed, seed % 4 == 0);
    const auto coordinates = moving.motion.q.size();
    if (coordinates == 0) continue;
    MotionTable table;
    constexpr Eigen::Index kRows = 19;
    table.positions.resize(kRows, coordinates);
    table.velocities = table.accelerations = table.positions;
    std::vector<Motion> motions;
    for (Eigen::Index row = 0; row < kRows; ++row) {
      Motion motion = moving.random.motion(moving.mechanism);
      motion.root = randomRootMotion(moving.generator);
      table.positions.row(row) = motion.q;
      table.velocities.row(row) = motion.qd;
      table.accelerations.row(row) = motion.qdd;
      table.roots.push_back(motion.root);
      motions.push_back(motion);
    }
    for (const InstructionSet set : supportedInstructionSets()) {
      const InverseDynamics dynamics(moving.mechanism, moving.scene,
                                     requestEveryJoint(moving.mechanism), set);
      Workspace one = dynamics.makeWorkspace(), many = dynamics.makeWorkspace();
      SampleBlock block(dynamics, kRows);
      block.compute(table, 0, kRows);
      for (std::size_t row = 0; row < motions.size(); ++row) {
        dynamics.compute(motions[row], one);
        block.read(row, many);
        EXPECT_EQ(numbersOf(one.results()), numbersOf(many.results())) << seed << ", row " << row;
      }
      table.roots.pop_back();
      EXPECT_THROW(block.compute(table, 0, kRows), MotionError);
      table.roots.push_back(motions.back().root);
    }
  }
}

// Turning the root and turning gravity the other way is the same to everything that is on the root;
// so are an acceleration of its origin and less gravity.
TEST(MovingRoot, TiltedIsThatOfTiltedGravity) {
  for (unsigned seed = 1; seed <= kRobots; ++seed) {
    Moving moving(seed);
    RootMotion& root = moving.motion.root;
    root.angular_velocity.setZero();
    root.angular_acceleration.setZero();
    Scene resting = moving.scene;
    resting.root_moves = false;
    resting.gravity = root.orientation.conjugate() * (moving.scene.gravity - root.acceleration);
    const Request request = requestEveryJoint(moving.mechanism);
    const InverseDynamics moves(moving.mechanism, moving.scene, request);
    const InverseDynamics rests(moving.mechanism, resting, request);
    Workspace a = moves.makeWorkspace(), b = rests.makeWorkspace();
    moves.compute(moving.motion, a);
    rests.compute(moving.motion, b);
    ErrorBound bound(moving.mechanism, moving.scene);
    bound.compute(moving.motion);
    expectTheSame(a.childAxes(), b.childAxes(), 1e-14, bound);
  }
}

// A tree whose root moves, and the same tree on six joints without mass that make that motion.
TEST(MovingRoot, IsThatOfSixJointsBeforeIt) {
  for (unsigned seed = 1; seed <= kRobots; ++seed) {
    Moving moving(seed);
    std::uniform_real_distribution<double> uniform(-1.4, 1.4);
    const auto vector = [&] {
      const double x = uniform(moving.generator), y = uniform(moving.generator);
      return Eigen::Vector3d(x, y, uniform(moving.generator));
    };
    const CarrierAngles carrier{vector(), 2 * vector(), 4 * vector()};
    const Eigen::Vector3d p = vector(), v = vector(), a = 4 * vector();
    moving.motion.root = carrier.root(p, v, a);

    const Mechanism carried = CarriedMechanism(moving.mechanism).mechanism();
    // Root axes of the other tree are inertial ones: wrenches are in the axes of their links.
    for (AppliedWrench& wrench : moving.scene.applied_wrenches) wrench.axes = Axes::kLink;
    Scene scene = moving.scene;
    scene.root_moves = false;
    Motion motion(moving.motion.q.size() + CarriedMechanism::kJoints);
    motion.q << p, carrier.angles, moving.motion.q;
    motion.qd << v, carrier.rates, moving.motion.qd;
    motion.qdd << a, carrier.accelerations, moving.motion.qdd;

    Request request, of_carried;
    request.child_axes.emplace_back(kGround);
    of_carried.child_axes.emplace_back("carrier_roll");
    for (const Joint& joint : moving.mechanism.joints()) {
      request.child_axes.push_back(joint.name);
      of_carried.child_axes.push_back(joint.name);
    }
    const InverseDynamics moves(moving.mechanism, moving.scene, request);
    const InverseDynamics hangs(carried, scene, of_carried);
    Workspace found = moves.makeWorkspace(), expected = hangs.makeWorkspace();
    moves.compute(moving.motion, found);
    hangs.compute(motion, expected);
    ErrorBound bound(moving.mechanism, moving.scene);
    bound.compute(moving.motion);
    expectTheSame(found.childAxes(), expected.childAxes(), 1e-13, bound);
    for (Eigen::Index i = 0; i < found.effort().size(); ++i) {
      EXPECT_NEAR(found.effort()[i], expected.effort()[i + CarriedMechanism::kJoints],
                  1e-13 * bound.efforts()[static_cast<std::size_t>(i)])
          << seed;
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
