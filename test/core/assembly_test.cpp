#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "closed_loops.h"
#include "dynamics/motion_start.h"
#include "four_bar.h"
#include "open_loops.h"
#include "touching_bodies.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kTolerance = 1e-9;  // of positions that two ways lead to

// The other branch, with the feet above the thighs, is half a turn away.
TEST(Assembly, OfALegIsTheNearBranchFromEverySensibleStart) {
  const Leg leg;
  int near = 0;
  for (const Scene& scene : {leg.scene, exchanged(leg.scene)}) {
    for (int left = 0; left <= 10; ++left) {
      for (int right = 0; right <= 10; ++right) {
        const Eigen::VectorXd start = Eigen::Vector4d(0, 0.15 * left, 0, -0.15 * right);
        const ClosedLoops loops(leg.mechanism, startingAt(scene, leg.mechanism, start));
        const Eigen::VectorXd closed = Eigen::Vector4d(0, Leg::closedKnee(), 0, -Leg::closedKnee());
        EXPECT_LE((loops.assembly() - closed).norm(), kTolerance) << start.transpose();
        ++near;
      }
    }
  }
  EXPECT_EQ(near, 2 * 121);
}

// Where the loops are open, the redundant conditions look independent, and so as if the motor had
// to move.
TEST(Assembly, LeavesTheMotorOfRedundantLoopsWhereItStarts) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  for (const int cranks : {2, 3, 5}) {
    const Cranks bar(cranks);
    for (int i = 0; i < 50; ++i) {
      const double angle = 1.2 + uniform(generator);
      const Eigen::VectorXd closed = bar.closed(angle);
      Eigen::VectorXd start = closed;
      for (Eigen::Index j = 1; j < start.size(); ++j) start[j] += uniform(generator);
      for (const Scene& scene : {bar.scene, exchanged(bar.scene)}) {
        const ClosedLoops loops(bar.mechanism, startingAt(scene, bar.mechanism, start));
        EXPECT_EQ(loops.assembly()[0], angle);
        EXPECT_LE((loops.assembly() - closed).norm(), kTolerance) << start.transpose();
      }
    }
  }
}

// Both ends of a four-bar are motors: one of them has to give way, and as little as it can.
TEST(Assembly, MovesMotorsThatAreTooMany) {
  FourBar::Cut cut = FourBar().cut('D');
  const Eigen::VectorXd closed = ClosedLoops(cut.mechanism, cut.scene).assembly();
  cut.scene.actuated = cut.mechanism.coordinateNames();
  Eigen::VectorXd start = closed;
  start[0] += 0.2;
  const ClosedLoops loops(cut.mechanism, startingAt(cut.scene, cut.mechanism, start));
  EXPECT_LE((loops.assembly() - start).norm(), (closed - start).norm() + kTolerance);
  EXPECT_GT((loops.assembly() - start).norm(), 1e-3);
}

// From a start that is off in all passive joints, the solution that was left or a nearer one; the
// motor stays; and it is the same one whichever way round the closure is written.
TEST(Assembly, FindsTheNearSolutionOfEveryTypeOfClosure) {
  constexpr int kLoops = 12;
  int starts = 0, near = 0;
  for (const auto& type : kConditionsOfTypes) {
    for (unsigned seed = 1; seed <= kLoops; ++seed) {
      SpatialLoop loop(type.first, type.second, seed);
      for (const double off : {0.1, 0.3, 0.5, 0.8}) {
        SCOPED_TRACE(std::to_string(type.second) + " conditions, loop " + std::to_string(seed));
        Eigen::VectorXd start = loop.closed;
        for (Eigen::Index i = 1; i < start.size(); ++i) start[i] += loop.builder.uniform(-off, off);
        const Scene scene = startingAt(loop.scene, *loop.mechanism, start);
        const ClosedLoops loops(*loop.mechanism, scene);
        const ClosedLoops other(*loop.mechanism, exchanged(scene));
        EXPECT_EQ(loops.assembly()[0], start[0]);
        EXPECT_LE((loops.assembly() - other.assembly()).norm(), 1e-6);
        ++starts;
        near += (loops.assembly() - start).norm() <= (loop.closed - start).norm() + kTolerance;
      }
    }
  }
  EXPECT_EQ(starts, 4 * kLoops * 8);
  EXPECT_GE(near, 0.99 * starts);
}

// A warning names what was assembled far from its start.
TEST(Assembly, SaysWhatEndsFarFromItsStart) {
  const Leg leg;
  const Eigen::VectorXd start = Eigen::Vector4d(0, 1.9, 0, -0.1);
  const ClosedLoopDynamics far(leg.mechanism, startingAt(leg.scene, leg.mechanism, start), {});
  const std::vector<std::string> doubts = far.assemblyDoubts();
  ASSERT_EQ(doubts.size(), 1);
  EXPECT_EQ(doubts[0].find("assembly: 'joint_2' ends 1.699 rad from its start, at 0.2014 rad"), 0u)
      << doubts[0];
  const ClosedLoopDynamics near(leg.mechanism, leg.scene, {});
  EXPECT_TRUE(near.assemblyDoubts().empty());
}

// At zero, where the scene has it, the axle of this wheel stands upright, which is nothing but a
// start that does not lead anywhere: the motion's does.
TEST(Assembly, OfAFaultyStartIsThatOfTheMotion) {
  BodiesOnAxes bodies;
  const int tilted = bodies.turn(bodies.slide(0, bodies.z()), bodies.x());
  bodies.load(bodies.turn(tilted, bodies.z()), 1, {1, 1, 1});
  const Mechanism mechanism = bodies.build();
  const Scene scene = sceneOf(R"(
rolling: [{name: w, link: link_3, axis: [0, 0, 1], radius: 0.1, slip: all, plane: {link: link_0}}]
actuated: [joint_2, joint_3]
)");
  EXPECT_THROW(Dynamics(mechanism, scene, Request()), AssemblyError);
  Motion motion(3);
  motion.q << 0.1, M_PI / 2, 0;
  for (const bool all : {true, false}) {
    MotionStart start{{}, motion, Motion()};
    start.given.coordinates = {all, true, true};
    const Scene started = startedBy(mechanism, scene, start);
    EXPECT_LE((Dynamics(mechanism, started, Request()).assembly() - motion.q).norm(), kTolerance);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
