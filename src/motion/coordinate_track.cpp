#include "motion/coordinate_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "motion/sample_blocks.h"
#include "motion/stream_start.h"
#include "motion/velocity_judge.h"

namespace virtual_work_dynamics {
namespace {

/// Samples kept, a power of two.
constexpr int kCapacity = 1024;
/// Samples that a late one may be put before.
constexpr int kMostLate = 64;

/// Before anything is learnt, the time constant is one with which noise of the positions makes so
/// much acceleration, rad/s^2 or m/s^2, within these bounds, s and intervals.
constexpr double kFirstAcceleration = 0.1;
constexpr double kLongestFirstTime = 0.05;
constexpr double kShortestFirstIntervals = 0.5;
/// Differences that noise can be told from.
constexpr int kFewestDifferences = 6;
/// Time between samples where it is not known, s.
constexpr double kUsualInterval = 0.005;
/// A model is no stiffer than this, so that a motion that begins is not overlooked.
constexpr double kLongestTime = 1.0;  // s
/// Shortest time constant that a surprise leads to, s and intervals; less has to be learnt.
constexpr double kQuickTime = 0.004;
constexpr double kQuickIntervals = 0.5;

/// Mean square of innovations over their variance that the model cannot have foreseen, the samples
/// that the mean goes over, and the largest innovation that counts in it, so that one sample alone
/// is no surprise.
constexpr double kSurprising = 6;
constexpr double kSurpriseSamples = 6;
constexpr double kLargestInnovation = 5;
/// Innovations of which two in a row are of no motion that the model could follow.
constexpr double kJump = 1e4;
/// Part of this mean that products of successive innovations make when it is the motion that is
/// quicker; those of noise alternate.
constexpr double kOneWay = 0.3;
/// The factor by which the density of the motion then grows.
constexpr double kBoost = 10;
/// Variance that a step of the positions adds to what is foreseen, in that of their rounding.
constexpr double kStepVariance = 3;
/// Part of the time of the blocks that a time constant found from them can be.
constexpr double kLongestPart = 1.0 / 3;

/// Time constants, and samples, after which a filter has forgotten how it was started.
constexpr double kForgotten = 5;
constexpr double kForgottenSamples = 16;

/// Later samples after which a sample is recorded.
constexpr int kSettled = 4;

/// Blocks that the model is found from: their time, s, and how many of them.
constexpr double kBlockTime = 0.004;
constexpr std::size_t kBlocks = 768;
/// Intervals that their mean is taken over.
constexpr int kUsualIntervals = 64;
/// Samples before the time between them is known well enough to size the blocks.
constexpr int kIntervalSamples = 12;
/// Steps of the identification for each second that samples are apart: a part of the time that
/// depends neither on the rate nor on what is found.
constexpr double kStepsPerSecond = 40000;
constexpr double kMostSteps = 800;
/// A joint moves when it moves by so many deviations of its positions.
constexpr double kMovingSteps = 30;
/// Blocks that noise is learnt from at rest.
constexpr std::size_t kBlocksOfRest = 4 * StreamIdentification::kFewest;
/// Blocks at speed, that is with steps of so many deviations, before noise of stamps is learnt: at
/// rest it has no effect, and where a joint sets off it would explain the acceleration.
constexpr int kBlocksAtSpeed = 64;
constexpr double kStepsAtSpeed = 3;
constexpr double kTwoPi = 6.283185307179586;
/// Steps that jump to and fro: how long they are at least, rad or m, and by how little the position
/// before the last one differs.
constexpr double kLongJump = 0.01;
constexpr double kReturn = 0.2;
/// Speed that no joint has, rad/s or m/s: a step that would take it is not one of the motion.
constexpr double kAbsurdSpeed = 1e4;

double secondsBetween(std::int64_t from, std::int64_t to) {
  return static_cast<double>(to - from) * 1e-9;
}

/// Time constant before anything is learnt of the motion, s.
double firstTime(double position_noise, double interval) {
  const double time =
      std::pow(std::pow(position_noise / kFirstAcceleration, 2) * interval, 1.0 / 5);
  return std::max(std::min(time, kLongestFirstTime), kShortestFirstIntervals * interval);
}

}  // namespace

CoordinateTrack::CoordinateTrack(const Joint& joint, const EstimatorSettings& settings)
    : turn_counter_(joint),
      noise_(settings.noise),
      lag_(settings.lag),
      max_gap_(std::llround(settings.max_gap * 1e9)),
      entries_(settings.estimate ? kCapacity : 1),
      least_position_(leastNoise(steps_.step(), 0)),
      wanted_blocks_(StreamIdentification::kFewest) {
  if (!settings.estimate) return;
  blocks_.resize(kBlocks);
  identification_.reserve(kBlocks);
}

void CoordinateTrack::clear() {
  turn_counter_.restart();
  size_ = 0;
  stretch_ = 0;
  jumps_ = 0;
  forgetRecord();
}

/// Forgets the samples that the model would be found from.
void CoordinateTrack::forgetRecord() {
  summed_ = 0;
  block_count_ = 0;
  new_blocks_ = 0;
  wanted_blocks_ = StreamIdentification::kFewest;
  identification_.stop();
}

double CoordinateTrack::moved(const Entry& from, const Entry& to) {
  return (to.q - from.q) + kTwoPi * (to.turns - from.turns);
}

CoordinateTrack::Verdict CoordinateTrack::push(std::int64_t stamp, double q, double qd) {
  if (size_ > 0 && stamp <= newest()) return insert(stamp, q, qd);
  const bool gap = size_ > 0 && capacity() > 1 && stamp - newest() > max_gap_;
  const double turns = turn_counter_.turns(q, size_ > 0 ? secondsBetween(newest(), stamp) : 0);
  newest_ = (newest_ + 1) & (capacity() - 1);
  size_ = std::min(size_ + 1, capacity());
  Entry& now = entry(0);
  now.stamp = stamp;
  now.q = q;
  now.turns = turns;
  now.qd = qd;
  if (capacity() == 1) return gap ? Verdict::kAfterGap : Verdict::kTaken;
  if (size_ > 1 && !gap) noteJump();
  const bool absurd =
      size_ > 1 && !gap &&
      !(std::abs(moved(entry(1), now)) < kAbsurdSpeed * secondsBetween(entry(1).stamp, stamp));
  if (absurd) forgetRecord();
  if (size_ == 1 || gap || absurd) {
    startStretch(stamp);
    begin(now);
  } else {
    stretch_ = std::min(stretch_ + 1, capacity());
    noteInterval();
    noteStep();
    if (startIsStale()) {
      restart(std::min(stretch_, kMostStarting));
    } else {
      follow(entry(1), now, true);
      if (jumped_) beginAnew();
    }
    identify();
  }
  recordSettled();
  return gap ? Verdict::kAfterGap : Verdict::kTaken;
}

void CoordinateTrack::startStretch(std::int64_t stamp) {
  stretch_ = 1;
  stretch_start_ = stamp;
  summed_ = 0;
  differences_ = 0;
  squares_ = products_ = 0;
}

/// Puts a late sample in its place, and filters those after it again.
CoordinateTrack::Verdict CoordinateTrack::insert(std::int64_t stamp, double q, double qd) {
  int age = 0;  // of the sample that it comes after
  while (age < size_ && entry(age).stamp > stamp) ++age;
  if (age < size_ && entry(age).stamp == stamp) return Verdict::kEqualStamp;
  // Before the first of a stretch there is a gap, which this sample does not fill alone.
  if (age >= std::min({size_, stretch_, kMostLate, capacity() - 1})) return Verdict::kTooLate;
  newest_ = (newest_ + 1) & (capacity() - 1);
  size_ = std::min(size_ + 1, capacity());
  stretch_ = std::min(stretch_ + 1, capacity());
  for (int i = 0; i < age; ++i) entry(i) = entry(i + 1);
  Entry& place = entry(age);
  const Entry& before = entry(age + 1);
  place.stamp = stamp;
  place.q = q;
  place.turns = before.turns;
  const double forward = std::abs(moved(before, place));
  const Entry& after = entry(age - 1);
  place.turns = after.turns;
  if (forward < std::abs(moved(before, place))) place.turns = before.turns;
  place.qd = qd;
  noteInterval();
  for (int i = age; i >= 0; --i) follow(entry(i + 1), entry(i), false);
  if (age <= kSettled) recordSettled();
  return Verdict::kInserted;
}

double CoordinateTrack::usualInterval() const {
  return std::isfinite(interval_) ? interval_ : kUsualInterval;
}

/// The model before anything is learnt.
StreamModel CoordinateTrack::firstModel() const {
  StreamKnowledge knowledge;
  knowledge.least_position = least_position_;
  knowledge.position_noise = noise_.position_noise;
  if (knowledge.position_noise < 0) knowledge.position_noise = shownNoise();
  knowledge.stamp_noise = noise_.stamp_noise;
  knowledge.use_velocities = false;
  const double interval = usualInterval();
  const double noise = std::max(knowledge.position_noise, least_position_);
  knowledge.time_constant =
      noise_.bandwidth > 0 ? 1 / (kTwoPi * noise_.bandwidth) : firstTime(noise, interval);
  return unlearnt(knowledge, interval);
}

/// Takes the two newest samples for the first ones of another motion, with nothing learnt.
void CoordinateTrack::beginAnew() {
  jumped_ = false;
  learnt_ = false;
  forgetRecord();
  startStretch(entry(1).stamp);
  begin(entry(1));
  stretch_ = 2;
  restart(2);
}

void CoordinateTrack::begin(Entry& entry) {
  if (!learnt_) model_ = firstModel();
  entry.first = true;
  entry.has_velocity = false;
  entry.filtered = startAlone();
  expectNothing();
}

/// The state at a first sample, with nothing to start from but itself.
StreamState<CoordinateTrack::kOrder> CoordinateTrack::startAlone() const {
  return firstState<kOrder>(model_, usualInterval(), 1, [](int) { return std::pair(0.0, 0.0); });
}

/// Samples that the filter is started from, in the end.
int CoordinateTrack::startingCount() const {
  return startingSamples(model_, kOrder, interval_);
}

/// Whether the newest sample tells more of the start of the stretch than was known when the filter
/// was started.
bool CoordinateTrack::startIsStale() const {
  if (!learnt_)
    return stretch_ <= kMostStarting || model_.position_variance > 2 * started_variance_;
  const bool power_of_two = (stretch_ & (stretch_ - 1)) == 0;
  return power_of_two && stretch_ >= kFewest && stretch_ <= startingCount();
}

/// Starts the filter again so many samples ago, or with the stretch.
void CoordinateTrack::restart(int samples) {
  started_variance_ = model_.position_variance;
  const int oldest = std::min(std::max(samples, startingCount()), stretch_) - 1;
  Entry& first = entry(oldest);
  const int count = std::min(startingCount(), oldest + 1);
  first.filtered = firstState<kOrder>(model_, interval_, count, [&](int i) {
    const Entry& other = entry(oldest - i);
    return std::pair(secondsBetween(first.stamp, other.stamp), moved(first, other));
  });
  for (int age = oldest; age-- > 0;) follow(entry(age + 1), entry(age), false);
}

/// Takes the filter from the sample before to this one. @param judge whether the innovation may
/// change the model.
void CoordinateTrack::follow(const Entry& before, Entry& entry, bool judge) {
  entry.first = false;
  entry.filtered = before.filtered;
  StreamState<kOrder>& state = entry.filtered;
  predict<kOrder>(secondsBetween(before.stamp, entry.stamp), model_.density, state);
  state.x[0] -= moved(before, entry);
  entry.position = update<kOrder>(0, -state.x[0], model_.variance(state.x[1]), state);
  entry.has_velocity = model_.usesVelocities() && std::isfinite(entry.qd);
  if (entry.has_velocity)
    entry.velocity = update<kOrder>(1, entry.qd - state.x[1], model_.velocity_variance, state);
  if (judge && stretch_ > kFewest) adapt(entry.position, state);
}

/// Changes the model when innovations are much larger than it foresees: the joint moves faster than
/// it did when the model was learnt, or its positions are worse.
void CoordinateTrack::adapt(const StreamUpdate<kOrder>& update, StreamState<kOrder>& state) {
  // A step of a slow joint's positions is one of the encoder's, and stays for many samples.
  const double foreseen = 1 / update.precision + kStepVariance * least_position_ * least_position_;
  const double innovation = update.scaled / update.precision / std::sqrt(foreseen);
  const auto limited = [](double value) {
    return std::clamp(value, -kLargestInnovation, kLargestInnovation);
  };
  const double square = limited(innovation) * limited(innovation);
  const double product = limited(innovation) * limited(previous_innovation_);
  // What two samples in a row say is no outlier.
  const bool same_side = innovation * previous_innovation_ > 0;
  const double seen_twice =
      same_side ? std::min(std::abs(innovation), std::abs(previous_innovation_)) : 0;
  surprise_ += (square - surprise_) / kSurpriseSamples;
  one_way_ += (product - one_way_) / kSurpriseSamples;
  previous_innovation_ = innovation;
  jumped_ = seen_twice > kJump;
  if (jumped_ || surprise_ < kSurprising) return;
  const double surprise = surprise_;
  const bool quicker = one_way_ > kOneWay * surprise;
  expectNothing();
  if (quicker) {
    if (noise_.bandwidth > 0) return;
    const double quickest = std::max(kQuickTime, kQuickIntervals * interval_);
    const double most = densityFor(quickest, model_.position_variance, kOrder, interval_);
    model_.density = std::max(model_.density, std::min(kBoost * model_.density, most));
    // What so quick a motion does in one time constant, as much of it as explains the innovations.
    const double explained = std::max(surprise, seen_twice * seen_twice);
    const double time = timeConstant(model_, kOrder, interval_);
    StreamState<kOrder> noise;
    noise.P.setZero();
    addNoise<kOrder>(time, 1, noise);
    state.P += explained * foreseen / noise.P(0, 0) * noise.P;
  } else {
    if (noise_.position_noise >= 0) return;
    model_.position_variance *= surprise;
    model_.density *= surprise;
    state.P *= surprise;
  }
  wanted_blocks_ = std::min(wanted_blocks_, StreamIdentification::kFewest);
}

/// Forgets the surprises so far.
void CoordinateTrack::expectNothing() {
  surprise_ = 1;
  one_way_ = 0;
  previous_innovation_ = 0;
}

/// The mean of the latest intervals; samples that came late are counted, too.
void CoordinateTrack::noteInterval() {
  const int intervals = std::min(stretch_ - 1, kUsualIntervals);
  interval_ = secondsBetween(entry(intervals).stamp, newest()) / intervals;
}

/// Learns from the latest positions how finely they are resolved.
void CoordinateTrack::noteStep() {
  if (stretch_ < 3 || entry(2).turns != entry(0).turns) return;
  steps_.take(entry(2).q, entry(1).q, entry(0).q);
  least_position_ = leastNoise(steps_.step(), entry(0).q);
  if (learnt_) {
    model_.position_variance =
        std::max(model_.position_variance, least_position_ * least_position_);
    return;
  }
  noteNoise();
  model_ = firstModel();
}

/// Learns from the latest positions how large their noise is, from differences of fourth order:
/// products of those that follow each other are negative in the mean where noise is white, and as
/// large as the squares where the motion makes them.
void CoordinateTrack::noteNoise() {
  if (stretch_ < static_cast<int>(kDifferenced)) return;
  std::array<double, kDifferenced> times{};
  std::array<double, kDifferenced> positions{};
  for (std::size_t i = 0; i < kDifferenced; ++i) {
    const Entry& other = entry(static_cast<int>(i));
    times[i] = secondsBetween(entry(0).stamp, other.stamp);
    positions[i] = moved(entry(0), other);
  }
  const double difference = noiseDifference(times, positions);
  if (differences_ > 0) {
    squares_ += (difference * difference - squares_) / differences_;
    products_ += (difference * difference_ - products_) / differences_;
  }
  difference_ = difference;
  ++differences_;
}

/// Standard deviation of positions that the differences show; zero where there are too few.
double CoordinateTrack::shownNoise() const {
  constexpr double kCorrelation = -56.0 / 70;  // of differences of white noise, evenly spaced
  constexpr double kOfMotion = 70;             // square of a difference that is not scaled
  // A model cannot follow what the motion does between samples that are far apart.
  if (differences_ > 1 && products_ > squares_ / 2) return std::sqrt(kOfMotion * squares_);
  if (differences_ < kFewestDifferences) return 0;
  return std::sqrt(std::max(0.0, (squares_ - products_) / (1 - kCorrelation)));
}

/// Learns from the latest steps whether positions jump to and fro.
void CoordinateTrack::noteJump() {
  if (size_ < 3) return;
  const double step = std::abs(moved(entry(1), entry(0)));
  const bool jump = step > kLongJump && std::abs(moved(entry(2), entry(0))) < kReturn * step;
  jumps_ = jump ? std::min(jumps_ + 1, 2 * kManyJumps) : std::max(jumps_ - 1, 0);
}

bool CoordinateTrack::nextInstant(std::int64_t after, std::int64_t lag,
                                  std::int64_t& instant) const {
  bool found = false;
  for (int age = 0; age < size_; ++age) {
    const std::int64_t stamp = entry(age).stamp;
    if (stamp <= after) break;
    if (newest() - stamp < lag && age + 1 < capacity()) continue;
    instant = stamp;
    found = true;
  }
  return found;
}

/// Age of the latest sample up to an instant; that of the oldest one if all are later.
int CoordinateTrack::ageAt(std::int64_t instant) const {
  int later = -1;
  int age = size_ - 1;
  while (age - later > 1) {
    const int middle = later + (age - later) / 2;
    if (entry(middle).stamp > instant) {
      later = middle;
    } else {
      age = middle;
    }
  }
  return age;
}

bool CoordinateTrack::covers(std::int64_t instant, std::int64_t longest) const {
  const int base = ageAt(instant);
  int newest = base;
  while (newest > 0 && !entry(newest - 1).first && base - newest < kFewest) --newest;
  if (newest == base && instant - entry(base).stamp > longest) return false;
  int oldest = base;
  while (oldest + 1 < size_ && !entry(oldest).first && oldest - newest < kFewest) ++oldest;
  return oldest - newest + 1 >= kFewest;
}

double CoordinateTrack::unwrappedPosition() const {
  return entry(0).q + kTwoPi * entry(0).turns;
}

double CoordinateTrack::positionBefore(std::int64_t instant) const {
  const Entry& before = entry(ageAt(instant));
  return before.q + kTwoPi * before.turns;
}

Eigen::Vector3d CoordinateTrack::evaluate(std::int64_t instant, Eigen::Matrix3d* covariance) const {
  const bool with_covariance = covariance != nullptr;
  StreamAdjoint<kOrder> adjoint;
  int age = 0;
  while (age + 1 < size_ && entry(age).stamp > instant) {
    const Entry& later = entry(age);
    const Entry& before = entry(age + 1);
    if (later.first) {
      // The instant is in the gap before this stretch, or before the gap.
      adjoint = StreamAdjoint<kOrder>();
    } else {
      if (later.has_velocity) adjoint.backOver(1, later.velocity, with_covariance);
      adjoint.backOver(0, later.position, with_covariance);
      adjoint.backBy(secondsBetween(std::max(before.stamp, instant), later.stamp), with_covariance);
    }
    ++age;
  }
  const Entry& base = entry(age);
  StreamState<kOrder> state = base.filtered;
  if (instant > base.stamp)
    predict<kOrder>(secondsBetween(base.stamp, instant), model_.density, state);
  if (with_covariance) {
    const Eigen::Matrix4d all = state.P - state.P * adjoint.Lambda * state.P;
    *covariance = all.topLeftCorner<3, 3>();
  }
  Eigen::Vector3d motion = (state.x + state.P * adjoint.r).head<3>();
  motion[0] += base.q + kTwoPi * base.turns;
  return motion;
}

StreamQuality CoordinateTrack::quality() const {
  StreamQuality quality;
  quality.interval = std::isfinite(interval_) ? interval_ : 0;
  quality.position_noise = std::sqrt(model_.position_variance);
  quality.velocity_noise = model_.usesVelocities() ? std::sqrt(model_.velocity_variance) : -1;
  quality.stamp_noise = std::sqrt(model_.stamp_variance);
  if (quality.interval > 0)
    quality.bandwidth = 1 / (kTwoPi * timeConstant(model_, kOrder, quality.interval));
  quality.velocity_ratio = velocity_ratio_;
  return quality;
}

/// Records the sample that late ones no longer come before, as a rule.
void CoordinateTrack::recordSettled() {
  if (stretch_ <= kSettled) return;
  const Entry& settled = entry(kSettled);
  record(settled.stamp, settled.q + kTwoPi * settled.turns, settled.qd);
}

/// Adds a sample to the block that is being filled.
void CoordinateTrack::record(std::int64_t stamp, double q, double qd) {
  if (block_size_ == 0) {
    if (stretch_ < kIntervalSamples) return;
    block_size_ = blockSize(kBlockTime, interval_);
    block_interval_ = interval_;
    record_start_ = stamp;
  }
  // Another rate: the blocks would be of another length.
  if (interval_ > 1.5 * block_interval_ || interval_ < block_interval_ / 1.5) {
    block_size_ = 0;
    block_count_ = new_blocks_ = 0;
    summed_ = 0;
    return;
  }
  if (summed_ == 0) {
    block_start_ = stamp;
    block_position_ = q;
    sum_ = {0, 0, 0};
  }
  sum_.time += secondsBetween(block_start_, stamp);
  sum_.position += q - block_position_;
  sum_.velocity += qd;
  if (++summed_ < block_size_) return;
  blocks_[next_block_] = {secondsBetween(record_start_, block_start_) + sum_.time / block_size_,
                          block_position_ + sum_.position / block_size_,
                          sum_.velocity / block_size_};
  next_block_ = (next_block_ + 1) % blocks_.size();
  block_count_ = std::min(block_count_ + 1, blocks_.size());
  ++new_blocks_;
  summed_ = 0;
}

/// Goes on with finding the model by as much as is due with one sample.
void CoordinateTrack::identify() {
  if (identification_.running()) {
    const double steps = std::min(kStepsPerSecond * interval_, kMostSteps);
    if (identification_.advance(1 + static_cast<int>(steps))) useIdentified();
  } else if (new_blocks_ >= wanted_blocks_ && block_count_ >= StreamIdentification::kFewest) {
    startIdentification();
  }
}

void CoordinateTrack::startIdentification() {
  std::vector<StreamBlock>& blocks = identification_.blocks();
  blocks.clear();
  const std::size_t oldest = (next_block_ + blocks_.size() - block_count_) % blocks_.size();
  for (std::size_t i = 0; i < block_count_; ++i)
    blocks.push_back(blocks_[(oldest + i) % blocks_.size()]);
  new_blocks_ = 0;
  wanted_blocks_ = std::min(std::max(block_count_, StreamIdentification::kFewest), kBlocks / 2);
  const double deviation = std::max(least_position_, std::sqrt(model_.position_variance));
  double least = blocks[0].position;
  double most = least;
  int at_speed = 0;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    least = std::min(least, blocks[i].position);
    most = std::max(most, blocks[i].position);
    const double step = std::abs(blocks[i].position - blocks[i - 1].position);
    at_speed += step > kStepsAtSpeed * deviation ? 1 : 0;
  }
  if (most == least) {
    // There is nothing to learn; a motion that begins shall not wait behind the rest.
    block_count_ = std::min(block_count_, StreamIdentification::kFewest);
    wanted_blocks_ = StreamIdentification::kFewest / 2;
    return;
  }
  const double interval = block_interval_ * block_size_;
  const VelocityJudgement judgement = judgeVelocities(blocks, interval, least_position_);
  if (judgement.moved) {
    velocities_proven_ = judgement.agree;
    velocity_ratio_ = judgement.agree ? 1 : judgement.ratio;
  }
  StreamKnowledge knowledge;
  knowledge.order = kOrder;
  knowledge.least_position = least_position_;
  knowledge.position_noise = noise_.position_noise;
  knowledge.velocity_noise = noise_.velocity_noise;
  knowledge.stamp_noise = noise_.stamp_noise;
  if (noise_.stamp_noise < 0 && at_speed < kBlocksAtSpeed) {
    knowledge.stamp_noise = learnt_ ? std::sqrt(model_.stamp_variance) : 0;
    wanted_blocks_ = StreamIdentification::kFewest;
  }
  knowledge.use_velocities = noise_.use_velocity && velocities_proven_;
  knowledge.longest_time =
      std::min(kLongestTime, kLongestPart * interval * static_cast<double>(blocks.size()));
  knowledge.longest_gap = std::max(static_cast<double>(max_gap_) * 1e-9, 2.5 * interval);
  if (noise_.bandwidth > 0) {
    knowledge.time_constant = 1 / (kTwoPi * noise_.bandwidth);
  } else if (most - least < kMovingSteps * deviation) {
    // At rest noise can be learnt, but not how fast the joint will move; nor shall that wait behind
    // the rest.
    const double first = firstTime(std::sqrt(model_.position_variance), interval_);
    knowledge.time_constant = std::max(timeConstant(model_, kOrder, interval_), first);
    block_count_ = std::min(block_count_, kBlocksOfRest);
    blocks.erase(blocks.begin(), blocks.end() - static_cast<std::ptrdiff_t>(block_count_));
    wanted_blocks_ = StreamIdentification::kFewest;
  }
  identification_.start(knowledge, interval, block_size_, learnt_ ? &model_ : nullptr);
}

void CoordinateTrack::useIdentified() {
  model_ = identification_.model();
  // What later samples say of earlier ones is weighed with one model.
  StreamModel at_speed = model_;
  at_speed.position_variance = model_.variance(entry(0).filtered.x[1]);
  const double time = timeConstant(at_speed, kOrder, interval_);
  const double forgotten = std::max(kForgotten * time / interval_, kForgottenSamples);
  restart(static_cast<int>(std::min(lag_ / interval_ + forgotten, kCapacity + 0.0)));
  learnt_ = true;
  expectNothing();
}

}  // namespace virtual_work_dynamics
