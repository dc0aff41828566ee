#include "motion/coordinate_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "motion/sample_blocks.h"
#include "motion/stream_start.h"

namespace virtual_work_dynamics {
namespace {

/// Samples kept, a power of two.
constexpr int kCapacity = 1024;
/// Samples that a late one may be put before.
constexpr int kMostLate = 64;

/// Time between samples where it is not known, s.
constexpr double kUsualInterval = 0.005;
/// Variance that a step of the positions adds to what is foreseen, in that of their rounding.
constexpr double kStepVariance = 3;
/// Time constants, and samples, after which a filter has forgotten how it was started.
constexpr double kForgotten = 5;
constexpr double kForgottenSamples = 16;

/// Factor on variances where noise or bandwidth are found: from some seconds of samples they are
/// not found exactly. Of the report's streams, errors over deviations were 1.1 times what they
/// should be, in the median; those of recordings, whose models rest on all samples, 1.0 times.
constexpr double kFoundModel = 1.21;

/// Later samples after which a sample is recorded.
constexpr int kSettled = 4;
/// Steps that jump to and fro: how long they are at least, rad or m, and by how little the position
/// before the last one differs.
constexpr double kLongJump = 0.01;
constexpr double kJumpReturn = 0.2;
/// Steps in which the digits of positions are lost, rad or m.
constexpr double kAbsurdStep = 1e9;

}  // namespace

CoordinateTrack::CoordinateTrack(const Joint& joint, const EstimatorSettings& settings)
    : turn_counter_(joint),
      lag_(settings.lag),
      max_gap_(std::llround(settings.max_gap * 1e9)),
      samples_(settings.estimate ? kCapacity : 1),
      learner_(settings.noise, max_gap_, settings.estimate) {}

void CoordinateTrack::clear() {
  turn_counter_.restart();
  samples_.clear();
  jumps_ = 0;
  far_ = 0;
  learner_.forgetRecord();
}

CoordinateTrack::Verdict CoordinateTrack::push(std::int64_t stamp, double q, double qd) {
  if (!empty() && stamp <= newest()) return insert(stamp, q, qd);
  const bool gap = !empty() && samples_.capacity() > 1 && stamp - newest() > max_gap_;
  const double turns = turn_counter_.turns(q, empty() ? 0 : secondsBetween(newest(), stamp));
  TrackSample& now = samples_.add();
  now.stamp = stamp;
  now.q = q;
  now.turns = turns;
  now.qd = qd;
  if (samples_.capacity() == 1) return gap ? Verdict::kAfterGap : Verdict::kTaken;
  if (samples_.size() > 1 && !gap) noteJump();
  const bool absurd =
      samples_.size() > 1 && !gap && !(std::abs(moved(samples_[1], now)) < kAbsurdStep);
  if (absurd) learner_.forgetRecord();
  if (samples_.size() == 1 || gap || absurd) {
    startStretch(stamp);
    begin(now);
  } else {
    samples_.lengthenStretch();
    if (far_ > 0 || newestIsFar()) {
      takeInDoubt();
    } else {
      take(now);
    }
  }
  recordSettled();
  return gap ? Verdict::kAfterGap : Verdict::kTaken;
}

/// Takes the newest sample, which belongs to the motion.
void CoordinateTrack::take(TrackSample& now) {
  noteNoise(0);
  if (startIsStale()) {
    restart(std::min(stretch(), kMostStarting));
  } else {
    follow(samples_[1], now);
    if (stretch() > kFewest) adapt(now);
  }
  if (learner_.identify(noise_.least(), interval())) useLearnt();
}

bool CoordinateTrack::newestIsFar() const {
  const TrackSample& now = samples_[0];
  const TrackSample& before = samples_[1];
  const double time = secondsBetween(before.stamp, now.stamp);
  double step = moved(before, now);
  // What a steady motion would make of it is not far.
  if (stretch() > 2)
    step -= moved(samples_[2], before) * time / secondsBetween(samples_[2].stamp, before.stamp);
  return isFar(step, time, interval(), noise_.least(), std::sqrt(model().position_variance));
}

/// Takes the newest sample while it is open whether it belongs to the motion.
void CoordinateTrack::takeInDoubt() {
  ++far_;
  TrackSample& now = samples_[0];
  now.counts = false;
  const FarFinding finding = judgeNewest();
  switch (finding.verdict) {
    case FarVerdict::kOpen:
      follow(samples_[1], now);
      return;
    case FarVerdict::kJump:
      ++begun_;
      beginAnew(far_);
      return;
    case FarVerdict::kMotion:
    case FarVerdict::kAlone:
      for (int age = 0; age < far_; ++age) samples_[age].counts = true;
      leaveOut(finding.alone);
      for (int age = far_ - 1; age > 0; --age) {
        noteNoise(age);
        follow(samples_[age + 1], samples_[age]);
      }
      far_ = 0;
      take(now);
  }
}

FarFinding CoordinateTrack::judgeNewest() const {
  std::array<double, kBeforeFar + kMostFar> times;
  std::array<double, kBeforeFar + kMostFar> positions;
  const int far = std::min(far_, kMostFar);
  const int before = std::min(stretch() - far_, kBeforeFar);
  const TrackSample& reference = samples_[far_];
  for (int i = 0; i < before + far; ++i) {
    const TrackSample& other = samples_[far_ + before - 1 - i];
    times[static_cast<std::size_t>(i)] = secondsBetween(reference.stamp, other.stamp);
    positions[static_cast<std::size_t>(i)] = moved(reference, other);
  }
  return judgeFar(times.data(), positions.data(), before, before + far, interval());
}

/// Leaves out the first samples of those in doubt, which stand alone.
void CoordinateTrack::leaveOut(int samples) {
  if (samples == 0) return;
  left_out_ += samples;
  const TrackSample& before = samples_[far_];
  const TrackSample& after = samples_[far_ - samples - 1];
  const double time = secondsBetween(before.stamp, after.stamp);
  for (int i = 1; i <= samples; ++i) {
    TrackSample& alone = samples_[far_ - i];
    alone.counts = false;
    // States count from it, and would lose their digits far away.
    alone.q = before.q + secondsBetween(before.stamp, alone.stamp) / time * moved(before, after);
    alone.turns = before.turns;
  }
}

void CoordinateTrack::startStretch(std::int64_t stamp) {
  samples_.setStretch(1);
  stretch_start_ = stamp;
  far_ = 0;
  learner_.beginStretch();
  noise_.restart();
}

/// Puts a late sample in its place, and filters those after it again.
CoordinateTrack::Verdict CoordinateTrack::insert(std::int64_t stamp, double q, double qd) {
  int age = 0;  // of the sample that it comes after
  while (age < samples_.size() && samples_[age].stamp > stamp) ++age;
  if (age < samples_.size() && samples_[age].stamp == stamp) return Verdict::kEqualStamp;
  // Before the first of a stretch there is a gap, which this sample does not fill alone.
  if (age >= std::min({samples_.size(), stretch(), kMostLate, samples_.capacity() - 1}))
    return Verdict::kTooLate;
  TrackSample& place = samples_.insert(age);
  const TrackSample& before = samples_[age + 1];
  place.stamp = stamp;
  place.q = q;
  place.turns = before.turns;
  const double forward = std::abs(moved(before, place));
  const TrackSample& after = samples_[age - 1];
  place.turns = after.turns;
  if (forward < std::abs(moved(before, place))) place.turns = before.turns;
  place.qd = qd;
  place.counts = age >= far_;
  far_ += place.counts ? 0 : 1;
  samples_.lengthenStretch();
  for (int i = age; i >= 0; --i) follow(samples_[i + 1], samples_[i]);
  if (age <= kSettled) recordSettled();
  return Verdict::kInserted;
}

double CoordinateTrack::usualInterval() const {
  return std::isfinite(interval()) ? interval() : kUsualInterval;
}

/// Takes the newest samples for the first ones of another motion, with nothing learnt.
void CoordinateTrack::beginAnew(int samples) {
  for (int age = 0; age < samples; ++age) samples_[age].counts = true;
  TrackSample& first = samples_[samples - 1];
  learner_.unlearn();
  startStretch(first.stamp);
  begin(first);
  samples_.setStretch(samples);
  for (int age = samples - 2; age >= 0; --age) noteNoise(age);
  restart(samples);
}

void CoordinateTrack::begin(TrackSample& entry) {
  if (!learner_.learnt()) learner_.assume(noise_, usualInterval());
  entry.first = true;
  entry.has_position = entry.has_velocity = false;
  // There is nothing to start from but the sample itself.
  entry.filtered =
      firstState<kOrder>(model(), usualInterval(), 1, [](int) { return std::pair(0.0, 0.0); });
  surprise_.restart();
}

/// Samples that the filter is started from, in the end.
int CoordinateTrack::startingCount() const {
  return startingSamples(model(), kOrder, interval());
}

/// Whether the newest sample tells more of the start of the stretch than was known when the filter
/// was started.
bool CoordinateTrack::startIsStale() const {
  if (!learner_.learnt())
    return stretch() <= kMostStarting || model().position_variance > 2 * started_variance_;
  const bool power_of_two = (stretch() & (stretch() - 1)) == 0;
  return power_of_two && stretch() >= kFewest && stretch() <= startingCount();
}

/// Starts the filter again so many samples ago, or with the stretch.
void CoordinateTrack::restart(int samples) {
  started_variance_ = model().position_variance;
  int oldest = std::min(std::max(samples, startingCount()), stretch()) - 1;
  while (oldest > 0 && !samples_[oldest].counts) --oldest;
  TrackSample& first = samples_[oldest];
  const int count = std::min(startingCount(), oldest + 1);
  first.filtered = firstState<kOrder>(model(), interval(), count, [&](int i) {
    const TrackSample& other = samples_[oldest - i];
    return std::pair(secondsBetween(first.stamp, other.stamp), moved(first, other));
  });
  for (int age = oldest; age-- > 0;) follow(samples_[age + 1], samples_[age]);
}

/// Takes the filter from the sample before to this one.
void CoordinateTrack::follow(const TrackSample& before, TrackSample& entry) {
  entry.first = false;
  entry.filtered = before.filtered;
  StreamState<kOrder>& state = entry.filtered;
  predict<kOrder>(secondsBetween(before.stamp, entry.stamp), model().density, state);
  state.x[0] -= moved(before, entry);
  entry.has_position = entry.counts;
  if (entry.has_position)
    entry.position = update<kOrder>(0, -state.x[0], model().variance(state.x[1]), state);
  entry.has_velocity = entry.counts && model().usesVelocities() && std::isfinite(entry.qd);
  if (entry.has_velocity)
    entry.velocity = update<kOrder>(1, entry.qd - state.x[1], model().velocity_variance, state);
}

/// Changes the model and the state after the newest sample when innovations are much larger than
/// foreseen: the joint moves faster than it did when the model was learnt, or its positions are
/// worse, or it is elsewhere.
void CoordinateTrack::adapt(TrackSample& now) {
  const StreamUpdate<kOrder>& update = now.position;
  // Of a slow joint, a step of the encoder stays in the positions for many samples: it is foreseen.
  const double foreseen = 1 / update.precision + kStepVariance * noise_.least() * noise_.least();
  const double innovation = update.scaled / update.precision / std::sqrt(foreseen);
  const StreamSurprise::Finding finding = surprise_.take(innovation);
  Eigen::Matrix4d& P = now.filtered.P;
  switch (finding.verdict) {
    case StreamSurprise::Verdict::kNothing:
      return;
    case StreamSurprise::Verdict::kJump:
      ++begun_;
      beginAnew(2);
      return;
    case StreamSurprise::Verdict::kNoisier:
      if (learner_.worsen(finding.factor)) P *= finding.factor;
      return;
    case StreamSurprise::Verdict::kQuicker:
      if (!learner_.quicken(interval())) return;
      // What so quick a motion does in one time constant, as much of it as explains the
      // innovations.
      StreamState<kOrder> noise;
      noise.P.setZero();
      addNoise<kOrder>(timeConstant(model(), kOrder, interval()), 1, noise);
      P += finding.factor * foreseen / noise.P(0, 0) * noise.P;
  }
}

/// Learns from the positions up to that of this age how finely they are resolved and, before a
/// model is learnt, how large their noise is.
void CoordinateTrack::noteNoise(int age) {
  const int came = stretch() - age;
  moves_ = moves_ || (came >= 2 && samples_[age].q != samples_[age + 1].q);
  if (came < 3 || samples_[age + 2].turns != samples_[age].turns) return;
  for (int i = 0; i < std::min(came, static_cast<int>(kDifferenced)); ++i)
    if (!samples_[age + i].counts) return;
  noise_.takeStep(samples_[age + 2].q, samples_[age + 1].q, samples_[age].q);
  if (learner_.learnt()) {
    learner_.raise(noise_.least());
    return;
  }
  if (came >= static_cast<int>(kDifferenced)) {
    std::array<double, kDifferenced> times{};
    std::array<double, kDifferenced> positions{};
    for (std::size_t i = 0; i < kDifferenced; ++i) {
      const TrackSample& other = samples_[age + static_cast<int>(i)];
      times[i] = secondsBetween(samples_[age].stamp, other.stamp);
      positions[i] = moved(samples_[age], other);
    }
    noise_.takeDifference(times, positions);
  }
  learner_.assume(noise_, usualInterval());
}

/// Learns from the latest steps whether positions jump to and fro.
void CoordinateTrack::noteJump() {
  if (samples_.size() < 3) return;
  const double step = std::abs(moved(samples_[1], samples_[0]));
  const bool jump =
      step > kLongJump && std::abs(moved(samples_[2], samples_[0])) < kJumpReturn * step;
  jumps_ = jump ? std::min(jumps_ + 1, 2 * kManyJumps) : std::max(jumps_ - 1, 0);
}

Eigen::Vector3d CoordinateTrack::evaluate(std::int64_t instant, Eigen::Matrix3d* covariance) const {
  const bool with_covariance = covariance != nullptr;
  StreamAdjoint<kOrder> adjoint;
  int age = 0;
  while (age + 1 < samples_.size() && samples_[age].stamp > instant) {
    const TrackSample& later = samples_[age];
    const TrackSample& before = samples_[age + 1];
    if (later.first) {
      // The instant is in the gap before this stretch, or before the gap.
      adjoint = StreamAdjoint<kOrder>();
    } else {
      if (later.has_velocity) adjoint.backOver(1, later.velocity, with_covariance);
      if (later.has_position) adjoint.backOver(0, later.position, with_covariance);
      adjoint.backBy(secondsBetween(std::max(before.stamp, instant), later.stamp), with_covariance);
    }
    ++age;
  }
  const TrackSample& base = samples_[age];
  StreamState<kOrder> state = base.filtered;
  if (instant > base.stamp)
    predict<kOrder>(secondsBetween(base.stamp, instant), model().density, state);
  if (with_covariance) {
    const Eigen::Matrix4d all = state.P - state.P * adjoint.Lambda * state.P;
    *covariance = (learner_.finds() ? kFoundModel : 1) * all.topLeftCorner<3, 3>();
  }
  Eigen::Vector3d motion = (state.x + state.P * adjoint.r).head<3>();
  motion[0] += base.unwrapped();
  return motion;
}

StreamQuality CoordinateTrack::quality() const {
  StreamQuality quality;
  quality.interval = std::isfinite(interval()) ? interval() : 0;
  quality.position_noise = std::sqrt(model().position_variance);
  quality.velocity_noise = model().usesVelocities() ? std::sqrt(model().velocity_variance) : -1;
  quality.stamp_noise = std::sqrt(model().stamp_variance);
  if (quality.interval > 0)
    quality.bandwidth = bandwidthOf(timeConstant(model(), kOrder, quality.interval));
  quality.velocity_ratio = learner_.velocityRatio();
  quality.jumps = begun_;
  quality.left_out = left_out_;
  return quality;
}

/// Records the sample that late ones no longer come before, as a rule.
void CoordinateTrack::recordSettled() {
  if (stretch() <= kSettled) return;
  const TrackSample& settled = samples_[kSettled];
  if (!settled.counts) return;
  learner_.record(settled.stamp, settled.unwrapped(), settled.qd, stretch(), interval());
}

/// Filters the latest samples again, under the model that was just learnt.
void CoordinateTrack::useLearnt() {
  // What later samples say of earlier ones is weighed with one model.
  StreamModel at_speed = model();
  at_speed.position_variance = model().variance(samples_[0].filtered.x[1]);
  const double time = timeConstant(at_speed, kOrder, interval());
  const double forgotten = std::max(kForgotten * time / interval(), kForgottenSamples);
  restart(static_cast<int>(std::min(lag_ / interval() + forgotten, kCapacity + 0.0)));
  surprise_.restart();
}

}  // namespace virtual_work_dynamics
