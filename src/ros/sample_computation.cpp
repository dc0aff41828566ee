#include "ros/sample_computation.h"

#include <algorithm>
#include <chrono>

namespace virtual_work_dynamics {

using Clock = std::chrono::steady_clock;

SampleComputation::SampleComputation(Eigen::Index coordinates, bool static_motion,
                                     Counters& counters, CertificateRecord& certificates)
    : static_motion_(static_motion),
      counters_(counters),
      certificates_(certificates),
      motion_(coordinates) {}

bool SampleComputation::compute(ActivePlan& plan, std::int64_t stamp_ns) {
  if (static_motion_) motion_.qd.setZero();
  counters_.samples.add();
  return computeOne(plan, stamp_ns);
}

bool SampleComputation::compute(ActivePlan& plan, const TrajectoryMotion& trajectory,
                                std::size_t point) {
  takePoint(trajectory, point);
  return computeOne(plan, trajectory.stamps_ns[point]);
}

bool SampleComputation::computeNext(ActivePlan& plan, const TrajectoryMotion& trajectory,
                                    std::size_t point) {
  const std::size_t place = point % plan.points.capacity();
  if (place == 0) computeBlock(plan, trajectory, point);
  takePoint(trajectory, point);
  plan.points.read(place, plan.results);
  return motion_.finite() && fillMessages(plan, trajectory.stamps_ns[point]);
}

void SampleComputation::takePoint(const TrajectoryMotion& trajectory, std::size_t point) {
  const MotionTable& table = trajectory.table;
  const auto row = static_cast<Eigen::Index>(point);
  motion_.q = table.positions.row(row);
  motion_.qd = table.velocities.row(row);
  motion_.qdd = table.accelerations.row(row);
  if (static_motion_) motion_.qd.setZero();
  counters_.points.add();
}

void SampleComputation::computeBlock(ActivePlan& plan, const TrajectoryMotion& trajectory,
                                     std::size_t first) {
  const std::size_t count = std::min(plan.points.capacity(), trajectory.stamps_ns.size() - first);
  const auto start = Clock::now();
  plan.points.compute(trajectory.table, first, count);
  const std::chrono::nanoseconds share = (Clock::now() - start) / count;
  for (std::size_t i = 0; i < count; ++i) counters_.run_times.record(share.count());
}

bool SampleComputation::computeOne(ActivePlan& plan, std::int64_t stamp_ns) {
  if (!motion_.finite()) return false;
  const auto start = Clock::now();
  plan.dynamics.compute(motion_, plan.results);
  const auto end = Clock::now();
  counters_.run_times.record(
      std::chrono::duration_cast<std::chrono::nanoseconds>(end - start).count());
  return fillMessages(plan, stamp_ns);
}

bool SampleComputation::fillMessages(ActivePlan& plan, std::int64_t stamp_ns) {
  if (!plan.results.finite()) return false;
  plan.messages.fill(stamp_ns, motion_, plan.results);
  check(plan);
  return true;
}

void SampleComputation::check(ActivePlan& plan) {
  const Workspace& results = plan.results;
  if (plan.cross_check) {
    plan.cross_check->offer(motion_, results.effort(), results.childAxes(), results.rootAxes());
  }
  if (plan.certifier) {
    // Child axes of ground's reaction are the root link's.
    const Wrench& ground = results.childAxes()[plan.ground];
    certificates_.record(plan.certifier->check(motion_, results.effort(), ground));
  }
}

}  // namespace virtual_work_dynamics
