#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "closed_loop_results.h"
#include "four_bar.h"
#include "loops/completion.h"
#include "robot_builder.h"
#include "slider_crank.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms: Newton's method ends at a few eps, times the condition of the linkage.
constexpr double kClosedForm = 1e-13;

TEST(LoopCompletion, FourBarFollowsItsCrank) {
  const FourBar four_bar;
  for (const char pivot : {'B', 'C', 'D'}) {
    const FourBar::Cut cut = four_bar.cut(pivot);
    ClosedLoops dynamics(cut.mechanism, cut.scene);
    Motion motion(3);
    motion.q = dynamics.assembly();
    for (double angle = 0.8; angle < 13; angle += 0.05) {
      const auto turnings = four_bar.turnings(angle, 3.1, -4.2);
      const Motion expected = cut.motion(turnings);
      motion.q[0] = angle;
      motion.qd[0] = expected.qd[0];
      motion.qdd[0] = expected.qdd[0];
      ASSERT_TRUE(dynamics.complete(motion));
      for (Eigen::Index i = 0; i < 3; ++i) {
        const double turns = std::round((motion.q[i] - expected.q[i]) / (2 * M_PI));
        EXPECT_NEAR(motion.q[i] - 2 * M_PI * turns, expected.q[i], kClosedForm * 20);
        EXPECT_NEAR(motion.qd[i], expected.qd[i], kClosedForm * 100);
        EXPECT_NEAR(motion.qdd[i], expected.qdd[i], kClosedForm * 1000);
      }
    }
  }
}

// The driven joint is the one that was cut: what is given is another coordinate.
TEST(LoopCompletion, OtherCoordinatesCanBeGiven) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('A');
  ClosedLoops dynamics(cut.mechanism, cut.scene);
  const Motion expected = cut.motion(four_bar.turnings(0.9, 3.1, -4.2));
  Motion motion = expected;
  motion.q = dynamics.assembly();
  motion.q[0] = expected.q[0];
  motion.qd.tail(2).setZero();
  motion.qdd.tail(2).setZero();
  ASSERT_TRUE(dynamics.complete(motion, {true, false, false}));
  EXPECT_LE((motion.q - expected.q).norm(), 20 * kClosedForm);
  EXPECT_LE((motion.qd - expected.qd).norm(), 100 * kClosedForm);
  EXPECT_LE((motion.qdd - expected.qdd).norm(), 1000 * kClosedForm);
}

TEST(LoopCompletion, SliderCrankEqualsItsClosedForm) {
  const SliderCrank slider_crank;
  Scene scene = slider_crank.scene("joint_1");
  ClosedLoops dynamics(slider_crank.mechanism(), scene);
  Motion motion(3);
  motion.q = dynamics.assembly();
  for (double angle = 0.5; angle < 7; angle += 0.1) {
    const Motion expected = slider_crank.motion(angle, 2.0, 0.7);
    motion.q[0] = expected.q[0];
    motion.qd[0] = expected.qd[0];
    motion.qdd[0] = expected.qdd[0];
    ASSERT_TRUE(dynamics.complete(motion));
    EXPECT_LE((motion.q - expected.q).norm(), 10 * kClosedForm);
    EXPECT_LE((motion.qd - expected.qd).norm(), 10 * kClosedForm);
    EXPECT_LE((motion.qdd - expected.qdd).norm(), 100 * kClosedForm);
  }
}

// Steps that it takes to close a four-bar whose crank was moved so far from a closed position.
int stepsFrom(double off) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('D');
  LoopKinematics kinematics(cut.mechanism, cut.scene);
  const auto groups = loopGroups(cut.mechanism, kinematics);
  LoopCompletion completion(cut.mechanism, kinematics, groups, 1e-10, 1);
  Eigen::VectorXd q = cut.motion(four_bar.turnings(1.1, 0, 0)).q;
  q[0] += off;
  EXPECT_TRUE(completion.close(kinematics, q, {true, false, false}));
  EXPECT_LE(kinematics.phi().cwiseAbs().maxCoeff(), 1e-15);
  return completion.steps();
}

// 0.1 -> 1e-5 -> 1e-15 and less: each step leaves about the cube of the one before.
TEST(LoopCompletion, ConvergesCubically) {
  EXPECT_LE(stepsFrom(0.1), 3);
  EXPECT_GE(stepsFrom(0.1), 2);
}

// From where the sample before leaves it. Without the bend it takes three steps.
TEST(LoopCompletion, BendsItsSteps) {
  for (const double off : {1e-4, 1e-3, -2e-3, 3e-3}) EXPECT_LE(stepsFrom(off), 2) << off;
}

// From starts of every distance, so that steps by an earlier factorization and rates refined from
// one are met; what came before leaves no trace.
TEST(LoopCompletion, RatesDoNotDependOnTheStart) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('D');
  ClosedLoops used(cut.mechanism, cut.scene);
  RobotBuilder random(5);
  for (int i = 0; i < 400; ++i) {
    const Motion expected =
        cut.motion(four_bar.turnings(random.uniform(-3, 3), random.uniform(-5, 5), 30));
    Motion motion = expected;
    const double off = std::pow(10.0, random.uniform(-16, -1));
    for (int passive : {1, 2}) motion.q[passive] += random.uniform(-off, off);
    motion.qd.tail(2).setConstant(7);
    motion.qdd.tail(2).setConstant(-7);
    Motion again = motion;
    ASSERT_TRUE(used.complete(motion));
    EXPECT_LE((motion.q - expected.q).norm(), 10 * kClosedForm) << off;
    EXPECT_LE((motion.qd - expected.qd).norm(), 100 * kClosedForm) << off;
    EXPECT_LE((motion.qdd - expected.qdd).norm(), 2000 * kClosedForm) << off;
    ClosedLoops fresh(cut.mechanism, cut.scene);
    ASSERT_TRUE(fresh.complete(again));
    EXPECT_EQ(again.q, motion.q);
    EXPECT_EQ(again.qd, motion.qd);
    EXPECT_EQ(again.qdd, motion.qdd);
  }
}

// Where conditions are almost singular a whole step can overshoot although the loop is closed to
// the rank's tolerance; half of it goes on.
TEST(LoopCompletion, ClosesAsWellNearDeadCentre) {
  constexpr double kRounding = 1e-14;
  const SliderCrank slider_crank;
  const Scene scene = slider_crank.scene("joint_3");
  ClosedLoops dynamics(slider_crank.mechanism(), scene);
  RobotBuilder random(1);
  int completed = 0;
  for (int i = 0; i < 2000; ++i) {
    Motion motion = slider_crank.motion(random.uniform(5e-6, 1e-5), 1, 0);
    for (int passive = 0; passive < 2; ++passive) motion.q[passive] += random.uniform(-1e-3, 1e-3);
    if (!dynamics.complete(motion)) continue;
    ++completed;
    dynamics.compute(motion);
    ASSERT_LE(dynamics.relativeResiduals()[0].position, kRounding) << i;
  }
  EXPECT_GE(completed, 1900);
}

TEST(LoopCompletion, SaysWhenTheLoopCannotBeClosed) {
  const SliderCrank slider_crank;
  ClosedLoops dynamics(slider_crank.mechanism(), slider_crank.scene("joint_3"));
  Motion motion(3);
  motion.q = dynamics.assembly();
  EXPECT_TRUE(dynamics.complete(motion));
  motion.q[2] = SliderCrank::kCrank + SliderCrank::kRod + 0.01;
  EXPECT_FALSE(dynamics.complete(motion));
  motion.q = dynamics.assembly();
  motion.q[1] = std::nan("");
  EXPECT_FALSE(dynamics.complete(motion));
}

// At dead centre no motion of the crank follows from the slider's.
TEST(LoopCompletion, SaysWhenTheMotionIsNotDetermined) {
  const SliderCrank slider_crank;
  ClosedLoops dynamics(slider_crank.mechanism(), slider_crank.scene("joint_3"));
  Motion motion = slider_crank.motion(0, 0, 0);
  EXPECT_FALSE(dynamics.complete(motion));
}

// Two coordinates of a linkage with one degree of freedom: the second must fit the first.
TEST(LoopCompletion, SaysWhenTheMotionIsImpossible) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('D');
  ClosedLoops dynamics(cut.mechanism, cut.scene);
  Motion motion = cut.motion(four_bar.turnings(1.1, 3, -2));
  const std::vector<bool> two{true, true, false};
  EXPECT_TRUE(dynamics.complete(motion, two));
  motion.qdd[1] += 1e-6;
  EXPECT_FALSE(dynamics.complete(motion, two));
  motion = cut.motion(four_bar.turnings(1.1, 3, -2));
  motion.qd[1] += 1e-6;
  EXPECT_FALSE(dynamics.complete(motion, two));
}

TEST(LoopCompletion, SaysWhenACoordinateIsInNoLoop) {
  const SliderCrank slider_crank(0, true);
  Scene scene = slider_crank.scene("joint_1");
  scene.actuated->push_back("joint_4");
  ClosedLoops dynamics(slider_crank.mechanism(), scene);
  Motion motion = slider_crank.motion(0.7, 2, 0, 4);
  EXPECT_TRUE(dynamics.complete(motion));
  EXPECT_FALSE(dynamics.complete(motion, {true, false, false, false}));
}

TEST(LoopCompletion, ResidualsAreThoseOfTheMotion) {
  const SliderCrank slider_crank;
  ClosedLoops dynamics(slider_crank.mechanism(), slider_crank.scene("joint_1"));
  const Motion closed = slider_crank.motion(0.6, 2, 0);
  const auto residualOf = [&](const Motion& motion) {
    dynamics.compute(motion);
    return dynamics.residuals()[0];
  };
  EXPECT_LE(residualOf(closed).position, 1e-15);
  EXPECT_LE(residualOf(closed).velocity, 1e-14);
  EXPECT_LE(residualOf(closed).acceleration, 1e-13);
  Motion motion = closed;
  motion.q[2] += 1e-3;
  EXPECT_NEAR(residualOf(motion).position, 1e-3, 1e-14);
  motion = closed;
  motion.qd[2] += 2e-3;
  EXPECT_NEAR(residualOf(motion).velocity, 2e-3, 1e-14);
  motion = closed;
  motion.qdd[2] += 3e-3;
  EXPECT_NEAR(residualOf(motion).acceleration, 3e-3, 1e-13);
}

}  // namespace
}  // namespace virtual_work_dynamics
