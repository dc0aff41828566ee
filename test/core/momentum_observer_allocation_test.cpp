#include <gtest/gtest.h>

#include "allocation_guard.h"
#include "random_cases.h"
#include "virtual_work_dynamics/momentum_observer.h"

namespace virtual_work_dynamics {
namespace {

TEST(MomentumObserverAllocation, StepsDoNotAllocate) {
  RandomCases cases(5);
  for (int i = 0; i < 5; ++i) {
    Case one = cases.next(8);
    one.scene.static_motion = false;
    const Load load(one.scene);
    const Eigen::VectorXd measured = Eigen::VectorXd::Ones(one.motion.q.size());
    MomentumObserver observer(one.mechanism, one.scene, 20);
    observer.step(0, one.motion, load, measured);
    const AllocationGuard guard;
    observer.step(0.001, one.motion, load, measured);
    observer.restart();
    observer.step(0.002, one.motion, load, measured);
    EXPECT_EQ(guard.allocations(), 0U);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
