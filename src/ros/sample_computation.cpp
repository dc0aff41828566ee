#include "ros/sample_computation.h"

#include <algorithm>
#include <chrono>

namespace virtual_work_dynamics {

SampleComputation::SampleComputation(Eigen::Index coordinates, bool static_motion,
                                     Counters& counters, CertificateRecord& certificates,
                                     LoopSamples* loops)
    : static_motion_(static_motion),
      counters_(counters),
      certificates_(certificates),
      loops_(loops),
      motion_(coordinates),
      tree_effort_(coordinates) {}

SampleComputation::Outcome SampleComputation::compute(ActivePlan& plan, std::int64_t stamp_ns) {
  if (static_motion_) motion_.qd.setZero();
  counters_.samples.add();
  if (loops_ == nullptr) return computeOne(plan, stamp_ns);
  const auto start = Clock::now();
  if (!loops_->completer.complete(motion_)) return Outcome::kOpenLoop;
  return computeLoops(plan, stamp_ns, start);
}

SampleComputation::Outcome SampleComputation::compute(ActivePlan& plan,
                                                      const TrajectoryMotion& trajectory,
                                                      std::size_t point) {
  takePoint(trajectory, point);
  if (loops_ != nullptr) {
    if (trajectory.open[point]) return Outcome::kOpenLoop;
    return computeLoops(plan, trajectory.stamps_ns[point], Clock::now());
  }
  return computeOne(plan, trajectory.stamps_ns[point]);
}

SampleComputation::Outcome SampleComputation::computeNext(ActivePlan& plan,
                                                          const TrajectoryMotion& trajectory,
                                                          std::size_t point) {
  if (loops_ != nullptr) return compute(plan, trajectory, point);
  ChainPlan& chain = *plan.chain;
  const std::size_t place = point % chain.points.capacity();
  if (place == 0) computeBlock(plan, trajectory, point);
  takePoint(trajectory, point);
  chain.points.read(place, chain.results);
  if (!motion_.finite()) return Outcome::kNotFinite;
  return fillMessages(plan, trajectory.stamps_ns[point]);
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
  SampleBlock& points = plan.chain->points;
  const std::size_t count = std::min(points.capacity(), trajectory.stamps_ns.size() - first);
  const auto start = Clock::now();
  points.compute(trajectory.table, first, count);
  const std::chrono::nanoseconds share = (Clock::now() - start) / count;
  for (std::size_t i = 0; i < count; ++i) counters_.run_times.record(share.count());
}

SampleComputation::Outcome SampleComputation::computeOne(ActivePlan& plan, std::int64_t stamp_ns) {
  if (!motion_.finite()) return Outcome::kNotFinite;
  const auto start = Clock::now();
  plan.chain->dynamics.compute(motion_, plan.chain->results);
  const auto end = Clock::now();
  counters_.run_times.record(
      std::chrono::duration_cast<std::chrono::nanoseconds>(end - start).count());
  return fillMessages(plan, stamp_ns);
}

SampleComputation::Outcome SampleComputation::computeLoops(ActivePlan& plan, std::int64_t stamp_ns,
                                                           Clock::time_point start) {
  if (!motion_.finite()) return Outcome::kNotFinite;
  LoopPlan& loops = *plan.loops;
  loops.compute(motion_);
  const auto end = Clock::now();
  counters_.run_times.record(
      std::chrono::duration_cast<std::chrono::nanoseconds>(end - start).count());
  if (!loops.results().finite()) return Outcome::kNotFinite;
  plan.messages.fill(stamp_ns, motion_, loops);
  loops_->record.record(loops, loops_->limits);
  checkLoops(plan);
  return Outcome::kDone;
}

SampleComputation::Outcome SampleComputation::fillMessages(ActivePlan& plan,
                                                           std::int64_t stamp_ns) {
  const Workspace& results = plan.chain->results;
  if (!results.finite()) return Outcome::kNotFinite;
  plan.messages.fill(stamp_ns, motion_, results);
  check(plan);
  return Outcome::kDone;
}

void SampleComputation::check(ActivePlan& plan) {
  const Workspace& results = plan.chain->results;
  if (plan.cross_check) {
    plan.cross_check->offer(motion_, results.effort(), results.childAxes(), results.rootAxes());
  }
  if (plan.certifier) {
    // Child axes of ground's reaction are the root link's.
    const Wrench& ground = results.childAxes()[plan.ground];
    certificates_.record(plan.certifier->check(motion_, results.effort(), ground));
  }
}

// Singular positions need not bear the load.
void SampleComputation::checkLoops(ActivePlan& plan) {
  if (plan.loops->singular()) return;
  const ClosedLoopDynamics& results = plan.loops->results();
  if (plan.cross_check) {
    plan.cross_check->offer(motion_, results.effort(), results.childAxes(), results.rootAxes(),
                            results.treeWrenches());
  }
  if (!plan.certifier) return;
  results.applyTo(*plan.certifier);
  tree_effort_ = results.effort().head(tree_effort_.size());
  const Wrench& ground = results.childAxes()[plan.ground];
  certificates_.record(plan.certifier->check(motion_, tree_effort_, ground));
}

}  // namespace virtual_work_dynamics
