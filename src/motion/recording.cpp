#include "motion/recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "motion/sample_blocks.h"
#include "motion/sample_clock.h"
#include "motion/velocity_judge.h"

namespace virtual_work_dynamics {
namespace {

/// Blocks that models are found from: where there are more, stretches of them spread evenly.
constexpr std::size_t kMostBlocks = 16384;
constexpr std::size_t kStretch = 2048;
/// A gap is at least so many usual intervals long.
constexpr double kGapIntervals = 4;
/// Orders other than four, and by how much they must be likelier than it (twice the logarithm of
/// the likelihood). Order three is asked for more: it takes slight jumps of the acceleration for
/// the rule.
struct OtherOrder {
  int order;
  double margin;
};
constexpr OtherOrder kOtherOrders[] = {{3, 100}, {5, 10}, {6, 20}};

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

/// Standard deviation of most positions, rad or m: what a few of them do has no effect.
double usualDeviation(const std::vector<double>& times, const std::vector<double>& positions) {
  constexpr double kMedianOfNormal = 0.6745;  // of its absolute values, in deviations
  std::vector<double> differences;
  for (std::size_t first = 0; first + kDifferenced <= times.size(); ++first) {
    std::array<double, kDifferenced> t{};
    std::array<double, kDifferenced> q{};
    for (std::size_t i = 0; i < kDifferenced; ++i) {
      t[i] = times[first + i] - times[first];
      q[i] = positions[first + i] - positions[first];
    }
    differences.push_back(std::abs(noiseDifference(t, q)));
  }
  if (differences.empty()) return 0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle / kMedianOfNormal;
}

double rmsDifference(const std::vector<double>& some, const std::vector<double>& others) {
  double squares = 0;
  for (std::size_t i = 0; i < some.size(); ++i) squares += std::pow(some[i] - others[i], 2);
  return std::sqrt(squares / static_cast<double>(some.size()));
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
  for (const std::size_t row : stream.jumps) samples[row].begins = true;
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
    knowledge.time_constant = bandwidthOf(settings_.noise.bandwidth);
  knowledge.longest_gap = longest_gap_;
  knowledge.rules = IdentificationRules::ofRecordings();
  findFarPositions(stream);
  knowledge.use_velocities = settings_.noise.use_velocity && !stream.velocities.empty();
  if (!knowledge.use_velocities) return;
  const VelocityJudgement judgement =
      judgeVelocities(samples(stream, times_), interval_, knowledge.least_position);
  if (judgement.agree) return;
  stream.velocity_ratio = judgement.ratio;
  knowledge.use_velocities = false;
}

/// Finds jumps, and positions that stand alone. The latter are replaced by what their neighbours
/// say.
void Recording::findFarPositions(RecordedStream& stream) const {
  const std::vector<double>& q = stream.positions;
  const double noise = usualDeviation(times_, q);
  std::size_t begin = 0;  // of the motion
  for (std::size_t row = 1; row < q.size(); ++row) {
    const double time = times_[row] - times_[row - 1];
    if (time > longest_gap_) begin = row;
    if (begin == row) continue;
    double step = q[row] - q[row - 1];
    if (row > begin + 1)
      step -= (q[row - 1] - q[row - 2]) * time / (times_[row - 1] - times_[row - 2]);
    if (!isFar(step, time, interval_, stream.knowledge.least_position, noise)) continue;
    const FarFinding finding = judge(stream, begin, row);
    if (finding.verdict == FarVerdict::kJump) {
      stream.jumps.push_back(row);
      begin = row;
    } else if (finding.verdict == FarVerdict::kAlone) {
      leaveOut(stream, begin, row, finding.alone);
      row += static_cast<std::size_t>(finding.alone);
    }
  }
}

/// Judges a far position by as few rows after it as it takes, as MotionEstimator does.
FarFinding Recording::judge(const RecordedStream& stream, std::size_t begin,
                            std::size_t row) const {
  const std::size_t oldest = std::max(begin, row - std::min<std::size_t>(row, kBeforeFar));
  const int before = static_cast<int>(row - oldest);
  FarFinding finding;
  for (int far = 1; far <= kMostFar && finding.verdict == FarVerdict::kOpen; ++far) {
    const std::size_t newest = row + static_cast<std::size_t>(far) - 1;
    if (newest >= times_.size() ||
        (newest > row && times_[newest] - times_[newest - 1] > longest_gap_))
      break;
    finding = judgeFar(&times_[oldest], &stream.positions[oldest], before, before + far, interval_);
  }
  return finding;
}

/// Replaces `count` positions from a row on by the cubic through those beside them.
void Recording::leaveOut(RecordedStream& stream, std::size_t begin, std::size_t row,
                         int count) const {
  const std::size_t after = row + static_cast<std::size_t>(count);
  std::vector<std::size_t> beside{row - 1, after};
  if (row >= begin + 2) beside.push_back(row - 2);
  if (after + 1 < times_.size() && times_[after + 1] - times_[after] <= longest_gap_)
    beside.push_back(after + 1);
  for (std::size_t alone = row; alone < after; ++alone) {
    double position = 0;
    for (const std::size_t i : beside) {
      double weight = 1;
      for (const std::size_t k : beside)
        if (k != i) weight *= (times_[alone] - times_[k]) / (times_[i] - times_[k]);
      position += weight * (stream.positions[i] - stream.positions[row - 1]);
    }
    stream.left_out.push_back(alone);
    stream.positions[alone] = stream.positions[row - 1] + position;
    if (!stream.velocities.empty())
      stream.velocities[alone] = std::numeric_limits<double>::quiet_NaN();
  }
}

void Recording::identify(const std::function<void(std::size_t models)>& found) {
  chooseClock(found);
  for (RecordedStream& stream : streams_) {
    chooseOrder(stream);
    found(kModels - 2);  // of four orders
  }
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
void Recording::chooseClock(const std::function<void(std::size_t models)>& found) {
  double stamped = 0;
  for (RecordedStream& stream : streams_) {
    stamped += identify(stream, times_, false);
    found(1);
  }
  std::vector<double> even_times = evenTimes(times_);
  if (even_times.empty()) {
    found(streams_.size());
    return;
  }
  std::vector<RecordedStream> stamped_streams = streams_;
  double even = 0;
  for (RecordedStream& stream : streams_) {
    even += identify(stream, even_times, true);
    found(1);
  }
  even_clock_ = even < stamped;
  if (even_clock_) {
    jitter_ = rmsDifference(times_, even_times);
    times_ = std::move(even_times);
    for (RecordedStream& stream : streams_) stream.knowledge.stamp_noise = 0;
  } else {
    streams_ = std::move(stamped_streams);
  }
}

void Recording::chooseOrder(RecordedStream& stream) const {
  if (stream.knowledge.order != 4 || stream.still) return;
  RecordedStream best = stream;
  double least = identify(best, times_, even_clock_);
  for (const OtherOrder& candidate : kOtherOrders) {
    RecordedStream other = stream;
    other.knowledge.order = candidate.order;
    const double value = identify(other, times_, even_clock_) + candidate.margin;
    if (!(value < least)) continue;
    least = value;
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
  quality.stamp_noise = even_clock_ ? jitter_ : std::sqrt(model.stamp_variance);
  quality.bandwidth = bandwidthOf(timeConstant(model, chosen.knowledge.order, interval_));
  quality.velocity_ratio = chosen.velocity_ratio;
  quality.jumps = static_cast<int>(chosen.jumps.size());
  quality.left_out = static_cast<int>(chosen.left_out.size());
  return quality;
}

}  // namespace virtual_work_dynamics
