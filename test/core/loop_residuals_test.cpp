#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "closed_loops.h"
#include "offline_linkage.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kRounding = 1e-15;

// The linkage upright, which closes it; the wrist is 0.3 m from the pin.
class LoopResiduals : public testing::Test {
 protected:
  const ClosureResidual& relativeOf(const Motion& motion) {
    dynamics_.compute(motion);
    return dynamics_.relativeResiduals().at(0);
  }

  const Mechanism linkage_ = readUrdf(kLinkage);
  const Scene scene_ = readScene(YAML::Load(pinned("0.5") + "redundancy: {length: 0.2}\n"));
  ClosedLoops dynamics_{linkage_, scene_};
  Motion motion_{3};
};

TEST_F(LoopResiduals, LengthsAreRelativeToTheLoopsSize) {
  motion_.q << 0, 0, 1e-3;
  EXPECT_NEAR(relativeOf(motion_).position, 0.6 * std::sin(0.5e-3) / 0.2, kRounding);
  EXPECT_NEAR(dynamics_.residuals().at(0).position, 0.6 * std::sin(0.5e-3), kRounding);
}

TEST_F(LoopResiduals, RatesAreRelativeToTheMotionsLargest) {
  motion_.qd << 4, -4, 4.5;
  EXPECT_NEAR(relativeOf(motion_).velocity, 0.3 * 0.5 / 0.2 / 4.5, kRounding);
  EXPECT_NEAR(dynamics_.residuals().at(0).velocity, 0.15, kRounding);
  motion_.qd.setZero();
  motion_.qdd << 8, -8, 10;
  EXPECT_NEAR(relativeOf(motion_).acceleration, 0.3 * 2 / 0.2 / 10, kRounding);
  EXPECT_NEAR(dynamics_.residuals().at(0).acceleration, 0.6, kRounding);
}

TEST_F(LoopResiduals, FastMotionsHaveLargeAccelerations) {
  motion_.qd << 10, -10, 10;  // with the matching accelerations, except for 5 rad/s^2
  motion_.qdd << 0, 0, 5;
  EXPECT_NEAR(relativeOf(motion_).acceleration, 0.3 * 5 / 0.2 / 100, kRounding);
}

TEST_F(LoopResiduals, WhatNearlyRestsIsNotHeldAgainstItsNoise) {
  motion_.qd << 0, 0, 1e-9;
  motion_.qdd << 0, 0, 1e-8;
  EXPECT_NEAR(relativeOf(motion_).velocity, 0.3e-9 / 0.2, kRounding);
  EXPECT_NEAR(dynamics_.relativeResiduals()[0].acceleration, 0.3e-8 / 0.2, kRounding);
}

TEST_F(LoopResiduals, WhatIsNoNumberIsNotTakenForNothing) {
  motion_.qdd << 0, 0, std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(relativeOf(motion_).acceleration));
  EXPECT_EQ(dynamics_.relativeResiduals()[0].velocity, 0);
}

}  // namespace
}  // namespace virtual_work_dynamics
