#include "ros/joint_state_computation.h"

#include "ros/message_text.h"

namespace virtual_work_dynamics {

using Outcome = SampleComputation::Outcome;

JointStateComputation::JointStateComputation(const Mechanism& mechanism,
                                             const EstimatorSettings& settings,
                                             MotionEstimator& estimator, MotionCompleter& completer,
                                             SampleComputation& samples, Counters& counters,
                                             JointStateUser& user)
    : covariances_(settings.estimate),
      conversion_(mechanism, completer.lengths()),
      positions_(mechanism),
      free_joints_(mechanism, settings),
      estimator_(estimator),
      completer_(completer),
      samples_(samples),
      counters_(counters),
      user_(user),
      covariance_(samples.makeCovariance()),
      noise_(Eigen::VectorXd::Zero(samples.motion().q.size())) {}

bool JointStateComputation::take(const sensor_msgs::JointState& message) {
  JointSample sample;
  if (const auto rejection = conversion_.convert(message, sample)) {
    if (rejection->reason == DropReason::kNoKnownJoint) {
      counters_.foreign.add();
      user_.leaveForeign(rejection->text);
    } else {
      user_.dropJointState(rejection->reason, rejection->text);
    }
    return false;
  }
  if (!sample.mimic_disagreement.empty()) {
    user_.warn(sample.mimic_disagreement + "; positions of mimic joints are ignored");
  }
  if (sample.velocity_not_finite) counters_.velocity_not_finite.add();
  if (!sample.velocity_problem.empty()) {
    user_.warn(sample.velocity_problem + "; velocities that are not finite are not used");
  }
  if (!push(sample, &JointStateUser::dropJointState)) return false;
  if (const auto question = positions_.take(sample)) user_.warn(*question);
  if (efforts_) {
    efforts_->take(sample);
    if (const auto news = efforts_->news()) user_.warn(*news);
  }
  while (estimator_.ready()) evaluate();
  return true;
}

bool JointStateComputation::take(const sensor_msgs::MultiDOFJointState& message) {
  JointSample sample;
  const auto rejection = free_joints_.take(message, sample);
  const std::string doubt = free_joints_.takeDoubt();
  if (!doubt.empty()) user_.warn(doubt);
  if (rejection) {
    user_.dropFreeJoints(rejection->reason, rejection->text);
    return false;
  }
  if (!push(sample, &JointStateUser::dropFreeJoints)) return false;
  while (estimator_.ready()) evaluate();
  return true;
}

bool JointStateComputation::push(const JointSample& sample, Drop drop) {
  using Verdict = MotionEstimator::Verdict;
  const Verdict verdict =
      estimator_.push(sample.stamp_ns, sample.coordinates, sample.q, sample.qd, sample.count);
  if (verdict == Verdict::kEqualStamp) {
    (user_.*drop)(DropReason::kEqualStamp,
                  "its stamp " + stampText(sample.stamp_ns) + " was received before");
    return false;
  }
  if (verdict == Verdict::kTooLate) {
    (user_.*drop)(DropReason::kTooLate, "its stamp " + stampText(sample.stamp_ns) +
                                            " is too far behind those received before");
    return false;
  }
  if (verdict == Verdict::kReordered) counters_.reordered.add();
  if (verdict == Verdict::kAfterGap) {
    counters_.gaps.add();
    user_.noteGap();
  }
  if (verdict == Verdict::kRestartedBack) {
    counters_.restarts.add();
    free_joints_.restart(sample.stamp_ns);
    completer_.drives().beginAnew();
    if (efforts_) efforts_->restart();
    user_.noteRestart(sample.stamp_ns);
  }
  counters_.accepted_joint_states.add();
  user_.noteSeen(sample.coordinates, sample.count);
  if (completer_.saw(sample.coordinates, sample.count)) {
    estimator_.waitFor(completer_.needed());
    if (completer_.allGiven()) user_.noteAllGiven();
  }
  return true;
}

void JointStateComputation::evaluate() {
  ActivePlan& plan = user_.plan();
  // Time begins with the first instant, whether anybody listens or not.
  if (!plan.wantsSamples() && completer_.drives().begunByJointStates()) {
    estimator_.skip();
    counters_.skipped.add();
    return;
  }
  const bool fits = covariances_ && plan.fit.any() && completer_.fits();
  const bool known = covariances_ && estimator_.knowsNoise();
  MotionCovariance* covariance = known && (fits || plan.wantsCovariance()) ? &covariance_ : nullptr;
  const std::int64_t stamp_ns = estimator_.evaluate(
      samples_.motion(), completer_.measures() ? covariance : nullptr, &completer_.lengthMotion());
  completer_.drives().begin(stamp_ns);
  if (!plan.wantsSamples()) {
    counters_.skipped.add();
    return;
  }
  if (estimator_.anyHeld()) counters_.held.add();
  const auto unknown =
      free_joints_.set(stamp_ns, estimator_, completer_.needed(), samples_.motion(), covariance);
  if (unknown) {
    unknown_turn_ = *unknown;
    user_.dropSample(Outcome::kNoTurn, plan, stamp_ns);
    return;
  }
  // A joint that is held may be anywhere, and must not take the others with it.
  const bool fit = fits && !estimator_.anyHeld();
  if (fit) setNoise();
  const Outcome outcome = samples_.compute(plan, stamp_ns, covariance, fit ? &noise_ : nullptr);
  if (outcome != Outcome::kDone) {
    user_.dropSample(outcome, plan, stamp_ns);
    return;
  }
  if (const auto open = completer_.openStates()) user_.warn(*open);
  user_.publish(plan);
}

void JointStateComputation::setNoise() {
  for (Eigen::Index i = 0; i < noise_.size(); ++i) {
    noise_[i] = estimator_.quality(static_cast<int>(i)).position_noise;
  }
}

}  // namespace virtual_work_dynamics
