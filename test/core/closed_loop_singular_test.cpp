#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "closed_loop_results.h"
#include "four_bar.h"
#include "slider_crank.h"

namespace virtual_work_dynamics {
namespace {

// Relative to the largest force at an ordinary position.
constexpr double kTolerance = 1e-12;

bool allDetermined(const Determined& determined) {
  for (const bool flag : determined) {
    if (!flag) return false;
  }
  return true;
}

// The crank turns at constant speed and is balanced: the rod bears nothing, and the slider's motor
// what its mass demands. At dead centre the motor can push as hard as it likes.
TEST(ClosedLoopDynamics, SliderThroughDeadCentre) {
  const SliderCrank slider_crank(0, true);
  const Mechanism mechanism = slider_crank.mechanism();
  Scene scene = slider_crank.scene("joint_3");
  scene.actuated->push_back("joint_4");
  ClosedLoopResults results(mechanism, scene);
  ClosedLoops& dynamics = results.dynamics;
  const double rate = 3, largest = SliderCrank::kSlider * SliderCrank::kCrank * rate * rate;
  for (const double angle : {-0.1, -1e-3, 0.0, 1e-3, 0.1}) {
    Motion motion = slider_crank.motion(angle, rate, 0, 4);
    motion.qdd[3] = 1.5;
    dynamics.compute(motion);
    ASSERT_TRUE(dynamics.finite());
    const double alone = SliderCrank::kSlider * motion.qdd[2];
    const bool dead = angle == 0;
    EXPECT_EQ(dynamics.determinacy().rank, dead ? 3 : 4);
    EXPECT_EQ(dynamics.determinacy().free_motions, dead ? 1 : 0);
    EXPECT_EQ(dynamics.effortDetermined(), (std::vector<bool>{true, true, !dead, true}));
    EXPECT_EQ(results.rootDetermined("pin")[0], !dead);
    EXPECT_EQ(results.rootDetermined("joint_1")[0], !dead);
    EXPECT_TRUE(results.rootDetermined("pin")[1]);
    EXPECT_TRUE(allDetermined(results.rootDetermined("joint_4")));
    EXPECT_NEAR(results.root("pin").force.y(), 0,
                kTolerance * largest / std::abs(dead ? 1 : angle));
    if (!dead) {
      EXPECT_NEAR(dynamics.effort()[2], alone, kTolerance * largest / std::abs(angle));
      EXPECT_GE(dynamics.determinacy().condition, 0.3 / std::abs(angle));
    }
    // A result that is not determined is of the order of the load at most.
    EXPECT_LE(std::abs(dynamics.effort()[2]), 2 * largest);
    EXPECT_LE(results.root("pin").force.norm(), 2 * largest);
  }
}

// A rod with weight wants a torque of the crank that nothing gives at dead centre; on the way there
// forces grow as one over the angle.
TEST(ClosedLoopDynamics, LoadThatDeadCentreCannotBearFlagsWhatItReaches) {
  const SliderCrank slider_crank(1.5, true);
  Scene scene = slider_crank.scene("joint_3");
  scene.actuated->push_back("joint_4");
  scene.gravity << 0, -9.81, 0;
  ClosedLoopResults results(slider_crank.mechanism(), scene);
  ClosedLoops& dynamics = results.dynamics;
  dynamics.compute(slider_crank.motion(1e-3, 0, 0, 4));
  EXPECT_TRUE(dynamics.effortDetermined()[2]);
  const double near = dynamics.effort()[2];
  dynamics.compute(slider_crank.motion(1e-4, 0, 0, 4));
  EXPECT_NEAR(dynamics.effort()[2] / near, 10, 0.01);
  dynamics.compute(slider_crank.motion(0, 0, 0, 4));
  ASSERT_TRUE(dynamics.finite());
  EXPECT_EQ(dynamics.effortDetermined(), (std::vector<bool>{false, false, false, true}));
  EXPECT_FALSE(results.rootDetermined("pin")[0]);
  EXPECT_FALSE(results.rootDetermined("pin")[1]);
  EXPECT_FALSE(results.rootDetermined("joint_1")[1]);
  EXPECT_TRUE(allDetermined(results.rootDetermined("joint_4")));
  // The torques at crank and rod are met as well as one force across both can meet them.
  const double r = SliderCrank::kCrank, l = SliderCrank::kRod, weight = 1.5 * 9.81;
  const double best = weight * ((r + l) * (r + 0.4) + l * 0.4) / ((r + l) * (r + l) + l * l);
  EXPECT_NEAR(results.root("pin").force.y(), -best, kTolerance * weight);
  EXPECT_LE(std::abs(dynamics.effort()[2]), kTolerance * weight);
}

FourBar parallelogram() {
  FourBar four_bar;
  four_bar.lengths = {0.3L, 0.8L, 0.3L, 0.8L};
  return four_bar;
}

// The coupler stays parallel to ground.
FourBar::Turnings parallel(double angle, double rate) {
  return {{{angle, rate, 0}, {0, 0, 0}, {angle, rate, 0}}};
}

void expectFreeBodies(const ClosedLoopResults& results, const FourBar& four_bar,
                      const FourBar::Turnings& turnings) {
  const FourBar::Forces forces = four_bar.freeBodies(turnings);
  const double angle = std::abs(std::sin(static_cast<double>(turnings[0].angle)));
  double largest = 0;
  for (const auto& force : forces.on_body) {
    largest = std::max(largest, static_cast<double>(force.second.norm()));
  }
  const auto& D = forces.on_body.at('D');
  const auto turning = turnings[FourBar::kRocker].angle;
  const Wrench& wrench = results.child("D");
  EXPECT_NEAR(wrench.force.x(), static_cast<double>(D.dot(FourBar::along(turning))),
              kTolerance * largest / angle);
  EXPECT_NEAR(wrench.force.y(), static_cast<double>(D.dot(FourBar::normal(turning))),
              kTolerance * largest / angle);
  EXPECT_NEAR(results.dynamics.effort()[0], static_cast<double>(forces.torque),
              kTolerance * largest / angle);
}

TEST(ClosedLoopDynamics, ParallelogramThroughItsChangePoint) {
  const FourBar four_bar = parallelogram();
  FourBar::Cut cut = four_bar.cut('D');
  cut.scene.assembly = {{"A", 1.0}, {"B", -1.0}, {"C", 1.0}};
  ClosedLoopResults results(cut.mechanism, cut.scene);
  for (const double angle : {-0.2, -1e-3, 1e-3, 0.2}) {
    results.dynamics.compute(cut.motion(parallel(angle, 2)));
    EXPECT_EQ(results.dynamics.determinacy().rank, 3);
    EXPECT_EQ(results.dynamics.determinacy().free_motions, 0);
    EXPECT_EQ(results.dynamics.determinacy().redundant_constraints, 3);
    EXPECT_TRUE(results.dynamics.effortDetermined()[0]);
    expectFreeBodies(results, four_bar, parallel(angle, 2));
  }
  results.dynamics.compute(cut.motion(parallel(0, 2)));
  ASSERT_TRUE(results.dynamics.finite());
  EXPECT_EQ(results.dynamics.determinacy().rank, 2);
  EXPECT_EQ(results.dynamics.determinacy().free_motions, 1);
  EXPECT_EQ(results.dynamics.determinacy().redundant_constraints, 4);
  EXPECT_GT(results.dynamics.determinacy().gap, 1e10);
  EXPECT_FALSE(results.rootDetermined("D")[0]);
  EXPECT_LE(results.root("D").force.norm(), 100);
}

// Null vectors are known to rounding errors times the condition, which at last are larger than what
// is taken for open at ordinary positions. Flags change with the rank and not before.
TEST(ClosedLoopDynamics, FlagsStayUntilTheRankDrops) {
  const FourBar four_bar = parallelogram();
  FourBar::Cut cut = four_bar.cut('D');
  cut.scene.assembly = {{"A", 1.0}, {"B", -1.0}, {"C", 1.0}};
  ClosedLoopResults results(cut.mechanism, cut.scene);
  const ClosedLoops& dynamics = results.dynamics;
  results.dynamics.compute(cut.motion(parallel(0.2L, 2)));
  const auto child_axes = dynamics.childAxesDetermined();
  const auto root_axes = dynamics.rootAxesDetermined();
  for (double angle = 0.1; angle > 1e-9; angle /= 1.7) {
    results.dynamics.compute(cut.motion(parallel(angle, 2)));
    ASSERT_EQ(dynamics.determinacy().rank, 3) << angle;
    EXPECT_EQ(dynamics.childAxesDetermined(), child_axes) << angle;
    EXPECT_EQ(dynamics.rootAxesDetermined(), root_axes) << angle;
    EXPECT_TRUE(dynamics.effortDetermined()[0]) << angle;
  }
}

// A singular assembly is let pass when its neighbours are not: the change point itself.
TEST(ClosedLoopDynamics, SingularAssemblyIsLetPass) {
  const FourBar four_bar = parallelogram();
  FourBar::Cut cut = four_bar.cut('D');
  cut.scene.assembly.clear();
  const ClosedLoopResults results(cut.mechanism, cut.scene);
  EXPECT_EQ(results.dynamics.assembly(), Eigen::VectorXd::Zero(3));
}

}  // namespace
}  // namespace virtual_work_dynamics
