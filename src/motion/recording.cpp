#include "motion/recording.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "motion/sample_blocks.h"
#include "motion/sample_clock.h"
#include "motion/velocity_judge.h"

namespace virtual_work_dynamics {
namespace {

/// Time from block to block that models are found from, s, unless samples come more slowly.
constexpr double kBlockTime = 0.002;
/// Blocks that models are found from: where there are more, stretches of them spread evenly.
constexpr std::size_t kMostBlocks = 16384;
constexpr std::size_t kStretch = 2048;
/// A gap is at least so many usual intervals long.
constexpr double kGapIntervals = 4;
/// By how much another order must be likelier than four (twice the logarithm of the likelihood).
/// Order three is asked for more: it takes slight jumps of the acceleration for the rule.
constexpr double kMarginOfThree = 100;
constexpr double kMarginOfFive = 10;
constexpr double kTwoPi = 6.283185307179586;

std::vector<StreamBlock> spread(std::vector<StreamBlock> blocks) {
  if (blocks.size() <= kMostBlocks) return blocks;
  std::vector<StreamBlock> chosen;
  constexpr std::size_t stretches = kMostBlocks / kStretch;
  for (std::size_t i = 0; i < stretches; ++i) {
    const std::size_t first = (blocks.size() - kStretch) * i / (stretches - 1);
    const auto begin = blocks.begin() + static_cast<std::ptrdiff_t>(first);
    chosen.insert(chosen.end(), begin, begin + kStretch);
  }
  return chosen;
}

}  // namespace

Recording::Recording(std::vector<double> times, std::vector<RecordedStream> streams,
                     const CompletionSettings& settings)
    : times_(std::move(times)),
      streams_(std::move(streams)),
      settings_(settings),
      interval_(usualInterval(times_)),
      longest_gap_(std::max(settings.max_gap, kGapIntervals * interval_)),
      block_(blockSize(kBlockTime, interval_)) {
  for (RecordedStream& stream : streams_) prepare(stream);
}

std::vector<StreamBlock> Recording::samples(const RecordedStream& stream,
                                            const std::vector<double>& times) const {
  std::vector<StreamBlock> samples(times.size());
  for (std::size_t row = 0; row < times.size(); ++row)
    samples[row] = {times[row], stream.positions[row],
                    stream.velocities.empty() ? std::numeric_limits<double>::quiet_NaN()
                                              : stream.velocities[row]};
  return samples;
}

/// Notes what is known of a stream, and whether its velocities are to be believed.
void Recording::prepare(RecordedStream& stream) const {
  const auto [least, most] = std::minmax_element(stream.positions.begin(), stream.positions.end());
  stream.still = *least == *most;
  StreamKnowledge& knowledge = stream.knowledge;
  knowledge.order = times_.size() > 3 ? 4 : 3;
  knowledge.least_position = leastNoise(stream.positions);
  knowledge.position_noise = settings_.noise.position_noise;
  knowledge.velocity_noise = settings_.noise.velocity_noise;
  knowledge.stamp_noise = settings_.noise.stamp_noise;
  if (settings_.noise.bandwidth > 0)
    knowledge.time_constant = 1 / (kTwoPi * settings_.noise.bandwidth);
  knowledge.longest_gap = longest_gap_;
  knowledge.use_velocities = settings_.noise.use_velocity && !stream.velocities.empty();
  if (!knowledge.use_velocities) return;
  const VelocityJudgement judgement =
      judgeVelocities(samples(stream, times_), interval_, knowledge.least_position);
  if (judgement.agree) return;
  stream.velocity_ratio = judgement.ratio;
  knowledge.use_velocities = false;
}

void Recording::identify() {
  chooseClock();
  for (RecordedStream& stream : streams_) chooseOrder(stream);
}

/// Finds the model of a stream for its order.
/// @returns minus twice the logarithm of the likelihood.
double Recording::identify(RecordedStream& stream, const std::vector<double>& times,
                           bool even) const {
  StreamKnowledge knowledge = stream.knowledge;
  if (even) knowledge.stamp_noise = 0;
  StreamIdentification identification;
  identification.blocks() = spread(averaged(samples(stream, times), block_));
  if (stream.still || identification.blocks().size() < StreamIdentification::kFewest) {
    stream.model = unlearnt(knowledge, interval_);
    return 0;
  }
  identification.start(knowledge, interval_ * block_, block_, nullptr);
  identification.finish();
  stream.model = identification.model();
  return identification.value();
}

/// Stamps tell the truth, or they are those of an even clock with noise: whichever makes the
/// positions of all joints together likelier.
void Recording::chooseClock() {
  double stamped = 0;
  for (RecordedStream& stream : streams_) stamped += identify(stream, times_, false);
  std::vector<double> even_times = evenTimes(times_);
  if (even_times.empty()) return;
  std::vector<RecordedStream> stamped_streams = streams_;
  double even = 0;
  for (RecordedStream& stream : streams_) even += identify(stream, even_times, true);
  even_clock_ = even < stamped;
  if (even_clock_) {
    times_ = std::move(even_times);
    for (RecordedStream& stream : streams_) stream.knowledge.stamp_noise = 0;
  } else {
    streams_ = std::move(stamped_streams);
  }
}

void Recording::chooseOrder(RecordedStream& stream) const {
  if (stream.knowledge.order != 4 || stream.still) return;
  RecordedStream best = stream;
  double best_value = identify(best, times_, even_clock_);
  const double margins[] = {kMarginOfThree, kMarginOfFive};
  const int orders[] = {3, 5};
  for (int i = 0; i < 2; ++i) {
    RecordedStream other = stream;
    other.knowledge.order = orders[i];
    const double value = identify(other, times_, even_clock_);
    if (!(value < best_value - margins[i])) continue;
    best_value = value;
    best = std::move(other);
  }
  stream = std::move(best);
}

void Recording::smooth(
    std::size_t stream, bool covariance,
    const std::function<void(std::size_t row, const SmoothedSample&)>& take) const {
  const RecordedStream& chosen = streams_[stream];
  if (chosen.still) {
    SmoothedSample sample;
    sample.motion << chosen.positions[0], 0, 0;
    sample.covariance.setZero();
    for (std::size_t row = 0; row < times_.size(); ++row) take(row, sample);
    return;
  }
  smoothStream(samples(chosen, times_), chosen.model, chosen.knowledge.order, interval_,
               longest_gap_, settings_.lag, covariance, take);
}

StreamQuality Recording::quality(std::size_t stream) const {
  const RecordedStream& chosen = streams_[stream];
  const StreamModel& model = chosen.model;
  StreamQuality quality;
  quality.interval = interval_;
  quality.position_noise = std::sqrt(model.position_variance);
  quality.velocity_noise = model.usesVelocities() ? std::sqrt(model.velocity_variance) : -1;
  quality.stamp_noise = std::sqrt(model.stamp_variance);
  quality.bandwidth = 1 / (kTwoPi * timeConstant(model, chosen.knowledge.order, interval_));
  quality.velocity_ratio = chosen.velocity_ratio;
  return quality;
}

}  // namespace virtual_work_dynamics
