#include <gtest/gtest.h>

#include "pushed_mechanisms.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/lagrange_dynamics.h"

namespace virtual_work_dynamics {
namespace {

template <typename Real>
void expectEqual(const LagrangeDynamics<Real>& found, const LagrangeDynamics<Real>& expected) {
  EXPECT_EQ(found.effort(), expected.effort());
  ASSERT_FALSE(expected.childAxes().empty());
  for (std::size_t i = 0; i < expected.childAxes().size(); ++i) {
    EXPECT_EQ(found.childAxes()[i].force, expected.childAxes()[i].force);
    EXPECT_EQ(found.childAxes()[i].torque, expected.childAxes()[i].torque);
    EXPECT_EQ(found.rootAxes()[i].force, expected.rootAxes()[i].force);
    EXPECT_EQ(found.rootAxes()[i].torque, expected.rootAxes()[i].torque);
  }
}

template <typename Real>
void expectReplacedWrenches() {
  OpenChain chain;
  Load load = otherLoad(chain.scene);
  Scene other = chain.scene;
  for (std::size_t i = 0; i < load.wrenches.size(); ++i) {
    other.applied_wrenches[i].force = load.wrenches[i].force;
    other.applied_wrenches[i].torque = load.wrenches[i].torque;
  }
  LagrangeDynamics<Real> replaced(chain.mechanism, chain.scene, chain.request),
      own(chain.mechanism, chain.scene, chain.request),
      compiled(chain.mechanism, other, chain.request);
  const Motion motion = chain.robot.motion(chain.mechanism);
  own.compute(motion);
  compiled.compute(motion);
  for (int i = 0; i < 2; ++i) {
    replaced.compute(motion, load);
    EXPECT_NE(replaced.effort(), own.effort());
    expectEqual(replaced, compiled);
    replaced.compute(motion);
    expectEqual(replaced, own);
  }
  load.wrenches.pop_back();
  EXPECT_THROW(replaced.compute(motion, load), SceneError);
  EXPECT_THROW(replaced.compute(motion, Load()), SceneError);
}

TEST(LagrangeDynamics, ALoadReplacesTheAppliedWrenchesOfOneSample) {
  expectReplacedWrenches<double>();
  expectReplacedWrenches<long double>();
}

}  // namespace
}  // namespace virtual_work_dynamics
