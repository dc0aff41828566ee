#include "ros/sample_computation.h"

#include <algorithm>

#include "motion/table_row.h"
#include "virtual_work_dynamics/deviations.h"

namespace virtual_work_dynamics {

SampleComputation::SampleComputation(const Dynamics& dynamics, const Scene& scene,
                                     MotionCompleter& completer, LiveWrenches& wrenches,
                                     const SampleRecords& records, RootCourse* root)
    : static_motion_(scene.static_motion),
      completer_(completer),
      wrenches_(wrenches),
      root_(root),
      root_by_link_(completer.mechanism()),
      records_(records),
      motion_(dynamics.coordinates(), dynamics.orientations()),
      wrench_covariances_(wrenchCovariances(scene)),
      load_(scene),
      law_([this](const Motion& motion, Load& load) {
        load.wrenches = load_.wrenches;
        wrenches_.getLoad(motion, load);
      }),
      point_loads_(wrenches.size() == 0 ? 0 : ActivePlan::kPointsAtOnce, load_),
      tree_effort_(dynamics.coordinates()) {}

MotionCovariance SampleComputation::makeCovariance() const {
  MotionCovariance covariance;
  // Those of coordinates that have a drive stay zero.
  covariance.coordinates.assign(static_cast<std::size_t>(motion_.q.size()),
                                Eigen::Matrix3d::Zero());
  covariance.turns.assign(motion_.orientations.size(), TurnCovariance::Zero());
  covariance.wrenches = wrench_covariances_;
  return covariance;
}

SampleComputation::Outcome SampleComputation::compute(ActivePlan& plan, std::int64_t stamp_ns,
                                                      MotionCovariance* covariance,
                                                      const Eigen::VectorXd* noise) {
  if (static_motion_) motion_.qd.setZero();
  records_.counters.samples.add();
  if (!setRoot(stamp_ns, motion_.root, covariance)) return Outcome::kNoRoot;
  const auto start = Clock::now();
  if (noise) records_.loops.recordFit(completer_.fit(plan.fit, motion_, covariance, *noise));
  if (!completer_.complete(motion_, stamp_ns, plan.dynamics, plan.workspace)) {
    return whyIncomplete();
  }
  if (covariance) completer_.complete(*covariance);
  placeRoot(motion_);
  const Outcome outcome = computeOne(plan, stamp_ns, start, covariance, true);
  if (outcome == Outcome::kDone) completer_.took(motion_, plan.workspace.results());
  return outcome;
}

SampleComputation::Outcome SampleComputation::compute(ActivePlan& plan,
                                                      const TrajectoryMotion& trajectory,
                                                      std::size_t point) {
  takePoint(trajectory, point);
  if (trajectory.isUndriven(point)) return Outcome::kNoDrive;
  if (trajectory.isOpen(point)) return Outcome::kOpenLoop;
  if (trajectory.isRootless(point)) return Outcome::kNoRoot;
  return computeOne(plan, trajectory.stamps_ns[point], Clock::now(), nullptr);
}

SampleComputation::Outcome SampleComputation::computeSample(ActivePlan& plan,
                                                            const TrajectoryMotion& trajectory,
                                                            std::size_t sample) {
  trajectory.samples->evaluate(sample, motion_);
  if (static_motion_) motion_.qd.setZero();
  records_.counters.sampled.add();
  if (!setRoot(trajectory.samples->stampNs(sample), motion_.root)) return Outcome::kNoRoot;
  const auto start = Clock::now();
  const std::int64_t stamp_ns = trajectory.samples->stampNs(sample);
  if (!completer_.completeSample(motion_, stamp_ns, plan.dynamics, plan.workspace)) {
    return whyIncomplete();
  }
  placeRoot(motion_);
  return computeOne(plan, trajectory.samples->stampNs(sample), start, nullptr);
}

SampleComputation::Outcome SampleComputation::computeNext(ActivePlan& plan,
                                                          const TrajectoryMotion& trajectory,
                                                          std::size_t point, bool as_sample) {
  const std::size_t place = point % plan.points.capacity();
  if (place == 0) computeBlock(plan, trajectory, point);
  takePoint(trajectory, point);
  if (trajectory.isUndriven(point)) return Outcome::kNoDrive;
  if (trajectory.isOpen(point)) return Outcome::kOpenLoop;
  if (trajectory.isRootless(point)) return Outcome::kNoRoot;
  if (!motion_.finite()) return Outcome::kNotFinite;
  if (!setLoad(trajectory.stamps_ns[point])) return Outcome::kNoWrench;
  return finish(plan, trajectory.stamps_ns[point], plan.points.read(place),
                as_sample ? Of::kBoth : Of::kTrajectory);
}

SampleComputation::Outcome SampleComputation::whyIncomplete() const {
  return completer_.drives().failed() ? Outcome::kNoDrive : Outcome::kOpenLoop;
}

void SampleComputation::takePoint(const TrajectoryMotion& trajectory, std::size_t point) {
  takeRow(trajectory.table, point, motion_);
  if (static_motion_) motion_.qd.setZero();
  records_.counters.points.add();
}

void SampleComputation::computeBlock(ActivePlan& plan, const TrajectoryMotion& trajectory,
                                     std::size_t first) {
  const std::size_t count = std::min(plan.points.capacity(), trajectory.stamps_ns.size() - first);
  const auto start = Clock::now();
  for (std::size_t i = 0; i < count && !point_loads_.empty(); ++i) {
    if (wrenches_.read(trajectory.stamps_ns[first + i])) continue;
    takeRow(trajectory.table, first + i, motion_);
    wrenches_.getLoad(motion_, point_loads_[i]);
  }
  plan.points.compute(trajectory.table, first, count,
                      point_loads_.empty() ? nullptr : point_loads_.data());
  const std::chrono::nanoseconds share = (Clock::now() - start) / count;
  for (std::size_t i = 0; i < count; ++i) {
    if (!trajectory.isOpen(first + i)) records_.counters.run_times.record(share.count());
  }
}

SampleComputation::Outcome SampleComputation::computeOne(ActivePlan& plan, std::int64_t stamp_ns,
                                                         Clock::time_point start,
                                                         MotionCovariance* covariance,
                                                         bool measured) {
  if (!motion_.finite()) return Outcome::kNotFinite;
  if (!setLoad(stamp_ns, covariance)) return Outcome::kNoWrench;
  plan.dynamics.compute(motion_, load_, plan.workspace);
  const std::chrono::nanoseconds time = Clock::now() - start;
  records_.counters.run_times.record(time.count());
  return finish(plan, stamp_ns, plan.workspace.results(), Of::kSample, covariance, measured);
}

void SampleComputation::setRoots(TrajectoryMotion& trajectory) {
  if (!root_) return;
  const std::size_t points = trajectory.stamps_ns.size();
  trajectory.table.roots.assign(points, RootMotion());
  trajectory.rootless.assign(points, false);
  for (std::size_t i = 0; i < points; ++i) {
    trajectory.rootless[i] = !setRoot(trajectory.stamps_ns[i], trajectory.table.roots[i]);
    if (root_->link() == 0 || trajectory.rootless[i]) continue;
    takeRow(trajectory.table, i, motion_);
    placeRoot(motion_);
    trajectory.table.roots[i] = motion_.root;
  }
}

// Sets the motion of the root at an instant, where it moves. Returns false where it is not known.
bool SampleComputation::setRoot(std::int64_t stamp_ns, RootMotion& motion,
                                MotionCovariance* covariance) {
  if (!root_) return true;
  if (!root_->read(stamp_ns, motion, covariance ? &covariance->root : nullptr)) return false;
  if (root_->foreseen()) records_.counters.root_foreseen.add();
  if (covariance) covariance->root_link = root_->link();
  return true;
}

// Where a sensor on another link tells how the root moves, what was set is that link's motion.
void SampleComputation::placeRoot(Motion& motion) {
  if (!root_ || root_->link() == 0) return;
  root_by_link_.place(motion, root_->link());
  motion.root = root_by_link_.rootOf(motion.root);
}

// Sets the load of motion_ at an instant. Returns false where a live wrench is not known.
bool SampleComputation::setLoad(std::int64_t stamp_ns, MotionCovariance* covariance) {
  if (const auto unknown = wrenches_.read(stamp_ns)) {
    unknown_wrench_ = *unknown;
    return false;
  }
  if (wrenches_.anyHeld()) records_.counters.wrench_held.add();
  wrenches_.getLoad(motion_, load_);
  if (covariance) wrenches_.getCovariances(covariance->wrenches);
  return true;
}

SampleComputation::Outcome SampleComputation::finish(ActivePlan& plan, std::int64_t stamp_ns,
                                                     const Results& results, Of messages,
                                                     const MotionCovariance* covariance,
                                                     bool measured) {
  if (!results.finite()) return Outcome::kNotFinite;
  for (ActiveOutput& output : plan.outputs) {
    if (messages == (output.of_trajectories ? Of::kSample : Of::kTrajectory)) continue;
    output.message->fill({stamp_ns, motion_, results, covariance, &law_, measured});
  }
  records_.loops.record(results, plan);
  check(plan, results);
  return Outcome::kDone;
}

// Has a sample checked, unless its position is singular and so need not bear the load.
void SampleComputation::check(ActivePlan& plan, const Results& results) {
  if (results.singular()) return;
  if (plan.cross_check) plan.cross_check->offer(motion_, load_, results);
  if (!plan.certifier) return;
  plan.dynamics.getTreeLoad(results, load_, plan.tree_load);
  tree_effort_ = results.treeEffort(tree_effort_.size());
  // The child axes of ground's reaction are those of the root link.
  const Wrench& ground = results.child_axes[plan.ground];
  records_.certificates.record(
      plan.certifier->check(motion_, plan.tree_load, tree_effort_, ground));
}

}  // namespace virtual_work_dynamics
