// Motions: the estimator, curves and turn counters do not allocate once they are made.
#include <gtest/gtest.h>

#include "allocation_guard.h"
#include "base/run_time_histogram.h"
#include "motion/trajectory_curve.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/spline.h"
#include "virtual_work_dynamics/unwrap.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

MotionTable threePoints() {
  MotionTable table;
  table.times = {0, 1, 2};
  table.positions.resize(3, 2);
  table.positions << 0, 0, 1, 2, 0, 1;
  return table;
}

// Between the points of a curve and outside of them.
template <typename Curve>
void expectNoAllocation(const Curve& curve) {
  Motion motion(2);
  const AllocationGuard guard;
  for (double t = -0.5; t < 2.5; t += 0.1) curve.evaluate(t, motion);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(MotionEstimator, SamplesDoNotAllocate) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  MotionEstimator estimator(mechanism, EstimatorSettings());
  Motion motion(2);
  const int coordinates[] = {0, 1};
  const double q[] = {0.1, 0.2}, qd[] = {1, 2};
  RunTimeHistogram histogram;
  int outputs = 0;
  const AllocationGuard guard;
  for (int i = 1; i < 50; ++i) {
    // Uneven stamps, so that every window is fitted anew; one restart on the way.
    const std::int64_t stamp = (i == 25 ? 1 : i) * 1000000LL + i % 3;
    estimator.push(stamp, coordinates, q, i % 2 ? qd : nullptr, 2);
    if (estimator.ready()) {
      estimator.evaluate(motion);
      ++outputs;
    }
    histogram.record(i);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(outputs, 10);
}

TEST(Spline, EvaluateDoesNotAllocate) {
  expectNoAllocation(Spline(threePoints()));
}

TEST(TrajectoryCurve, EvaluateDoesNotAllocate) {
  MotionTable table = threePoints();
  table.velocities = 2 * table.positions;
  expectNoAllocation(TrajectoryCurve(table));
}

TEST(TurnCounter, CountsWithoutAllocating) {
  const AllocationGuard guard;
  TurnCounter counter;
  double turns = 0;
  for (int i = 0; i < 100; ++i) turns += counter.turns(i % 2 == 0 ? 3 : -3, 0.001);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(turns, 50);
}

}  // namespace
}  // namespace virtual_work_dynamics
