// Motions: the estimator, curves and turn counters do not allocate once they are made.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "allocation_guard.h"
#include "base/run_time_histogram.h"
#include "four_bar.h"
#include "motion/root_estimator.h"
#include "motion/root_trajectory.h"
#include "motion/trajectory_curve.h"
#include "sample_robots.h"
#include "tumbling_roots.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/motion_fit.h"
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

// Long enough that noises are identified, with velocities and without, and with samples that come
// late, gaps and a restart on the way.
TEST(MotionEstimator, SamplesDoNotAllocate) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  MotionEstimator estimator(mechanism, EstimatorSettings());
  Motion motion(2);
  MotionCovariance covariance;
  covariance.coordinates.resize(2);
  const int coordinates[] = {0, 1};
  RunTimeHistogram histogram;
  int outputs = 0, reordered = 0, gaps = 0, restarts = 0;
  const AllocationGuard guard;
  for (int i = 1; i < 3000; ++i) {
    const int late = i % 7 == 0 ? 1 : i % 7 == 1 ? -1 : 0;  // exchanges two neighbours
    const int k = i + late;
    const std::int64_t stamp = (k >= 2000 ? k - 2000 : k) * 1000000LL + k % 3;
    const double t = 1e-3 * k;
    const double q[] = {std::round(1e4 * std::sin(3 * t)) * 1e-4, 1e-4 * (k % 2)};
    const double qd[] = {3 * std::cos(3 * t), 0};
    const std::int64_t after_gap = k >= 1000 && k < 2000 ? 300000000LL : 0;
    using Verdict = MotionEstimator::Verdict;
    const Verdict verdict =
        estimator.push(stamp + after_gap, coordinates, q, k < 500 ? nullptr : qd, 2);
    reordered += verdict == Verdict::kReordered;
    gaps += verdict == Verdict::kAfterGap;
    restarts += verdict == Verdict::kRestartedBack;
    while (estimator.ready()) {
      estimator.evaluate(motion, i % 2 ? nullptr : &covariance);
      ++outputs;
    }
    histogram.record(i);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(outputs, 2800);
  EXPECT_GT(reordered, 400);
  EXPECT_EQ(gaps, 1);
  EXPECT_EQ(restarts, 1);
  EXPECT_GT(estimator.quality(0).velocity_noise, 0);  // identified
}

// As above: long enough that noises are identified, with twists and without, late poses, a restart.
TEST(RootEstimator, PosesDoNotAllocate) {
  RootEstimator estimator(EstimatorSettings(), 100000000);
  const TumblingRoot root;
  int known = 0, reordered = 0, restarts = 0;
  const AllocationGuard guard;
  for (int i = 1; i < 3000; ++i) {
    const int k = i + (i % 7 == 0 ? 1 : i % 7 == 1 ? -1 : 0);  // exchanges two neighbours
    const int place = k >= 2000 ? k - 2000 : k;
    const RootMotion truth = root.at(5e-3 * place);
    RootPose pose;
    pose.stamp_ns = 5000000LL * place;
    pose.position = truth.position;
    pose.orientation = truth.orientation;
    if (k > 500) pose.velocity = truth.velocity;
    if (k > 500) pose.angular_velocity = truth.angular_velocity;
    const RootEstimator::Verdict verdict = estimator.push(pose);
    reordered += verdict == RootEstimator::Verdict::kReordered;
    restarts += verdict == RootEstimator::Verdict::kRestartedBack;
    RootMotion motion;
    known += estimator.read(pose.stamp_ns - 50000000, motion);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(known, 2900);
  EXPECT_GT(reordered, 400);
  EXPECT_EQ(restarts, 1);
  EXPECT_GT(estimator.quality(0).velocity_noise, 0);  // identified
}

TEST(RootTrajectory, ReadingDoesNotAllocate) {
  RootTrajectory trajectory(100000000);
  const TumblingRoot root;
  trajectory.take({{0, root.at(0)}, {500000000, root.at(0.5)}, {1000000000, root.at(1)}});
  RootMotion motion;
  const AllocationGuard guard;
  int known = 0;
  for (int i = -10; i < 120; ++i) known += trajectory.read(10000000LL * i, motion);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(known, 111);
}

TEST(MotionFit, FitDoesNotAllocate) {
  const FourBar four_bar;
  const FourBar::Cut cut = four_bar.cut('D');
  const Dynamics dynamics(cut.mechanism, cut.scene);
  MotionFit fit(cut.mechanism, dynamics);
  Motion motion(dynamics.coordinates());
  motion.q = dynamics.assembly();
  motion.q[0] += 1e-4;
  motion.qd.setConstant(1e-3);
  MotionCovariance covariance;
  covariance.coordinates.assign(static_cast<std::size_t>(motion.q.size()),
                                1e-4 * Eigen::Matrix3d::Identity());
  const Eigen::VectorXd noise = Eigen::VectorXd::Constant(motion.q.size(), 1e-3);
  const AllocationGuard guard;
  EXPECT_TRUE(fit.fit(motion, &covariance, noise).explained);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(fit.outcome().farthest.deviations, 0);
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
  for (int i = 0; i < 100; ++i) turns += counter.turns(i % 2 == 0 ? 3.12 : -3.12, 0.001);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(turns, 50);
}

}  // namespace
}  // namespace virtual_work_dynamics
