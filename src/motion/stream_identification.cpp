#include "motion/stream_identification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "motion/sample_blocks.h"
#include "motion/stream_start.h"

namespace virtual_work_dynamics {
namespace {

/// Blocks after a start whose innovations say more of the start than of the model.
constexpr std::size_t kUnjudged = 5;
/// Blocks of a stretch that are given to a filter to forget its start, where these are not judged:
/// twice as many as the start is fitted to at most, but no more than this part of the stretch. How
/// long it takes depends on the model, but what is judged must not, as all models are to explain
/// the same.
constexpr std::size_t kForgetting = 2 * kMostStarting;
constexpr double kForgettingPart = 0.25;
/// Time constants that make sense, in intervals: below, everything is followed.
constexpr double kShortestTime = 0.1;
constexpr double kLeastLongest = 8;
constexpr double kGridFactor = 3;
/// The search ends when all parameters are known to this logarithm: a twentieth changes estimates
/// by far less than their error.
constexpr double kTolerance = 0.05;
constexpr int kMostValues = 160;
/// What another search has to find for yet another one to be worth it (twice the logarithm of the
/// likelihood).
constexpr double kGain = 1;
/// Noise of stamps below which they are taken as true, in intervals, or in what makes as much noise
/// of the positions as is seen.
constexpr double kLeastStampNoise = 1e-4;
constexpr double kLeastStampPart = 100;
constexpr double kTiny = 1e-150;

double logarithm(double value) {
  return std::log(std::max(value, kTiny));
}

}  // namespace

/// Standard deviation of blocks' positions or velocities, from differences that leave little of a
/// smooth motion; zero where there are none.
double StreamIdentification::noiseFromDifferences(double StreamBlock::*part) const {
  constexpr double kMeanMagnitude = 0.7978845608028654;  // of a deviation, sqrt(2/pi)
  double sum = 0;
  int count = 0;
  std::array<double, kDifferenced> times{};
  std::array<double, kDifferenced> values{};
  for (std::size_t first = 0; first + kDifferenced <= blocks_.size(); ++first) {
    for (std::size_t i = 0; i < kDifferenced; ++i) {
      times[i] = blocks_[first + i].time - blocks_[first].time;
      values[i] = blocks_[first + i].*part - blocks_[first].*part;
    }
    const double difference = noiseDifference(times, values);
    if (std::isnan(difference)) continue;
    sum += std::abs(difference);
    ++count;
  }
  return count > 0 ? sum / count / kMeanMagnitude : 0;
}

/// Usual speed, root of its mean square; positive.
double StreamIdentification::speed() const {
  double squares = 0;
  for (std::size_t i = 1; i < blocks_.size(); ++i)
    squares += std::pow(blocks_[i].position - blocks_[i - 1].position, 2);
  const double step = std::sqrt(squares / static_cast<double>(blocks_.size() - 1));
  return std::max(step / interval_, kTiny);
}

/// Logarithm of a parameter that is known beforehand; NaN where it has to be found.
double StreamIdentification::fixedValue(int parameter) const {
  const double block = std::sqrt(samples_);  // noise of a block is less than that of a sample
  const double values[] = {knowledge_.time_constant, knowledge_.position_noise / block,
                           knowledge_.velocity_noise / block, knowledge_.stamp_noise / block};
  const double value = values[parameter];
  return value >= 0 ? logarithm(value) : std::numeric_limits<double>::quiet_NaN();
}

SimplexSearch::Point StreamIdentification::firstGuess(const StreamModel* guess) const {
  SimplexSearch::Point point{};
  if (guess != nullptr) {
    const double samples = samples_;
    point[kTime] = logarithm(timeConstant(*guess, knowledge_.order, interval_ / samples_));
    point[kPosition] = 0.5 * logarithm(guess->position_variance / samples);
    point[kVelocity] = guess->usesVelocities() ? 0.5 * logarithm(guess->velocity_variance / samples)
                                               : point[kPosition] - std::log(interval_);
    point[kStamp] = 0.5 * logarithm(guess->stamp_variance / samples);
    point[kStamp] = std::max(point[kStamp], logarithm(3 * least_stamp_));
  } else {
    point[kPosition] = logarithm(shown_noise_);
    const double velocity_noise = noiseFromDifferences(&StreamBlock::velocity);
    point[kVelocity] = logarithm(std::max(velocity_noise, shown_noise_ / interval_));
    point[kStamp] = logarithm(100 * least_stamp_);
    point[kTime] = logarithm(interval_);
  }
  for (int i = 0; i < 4; ++i)
    if (!std::isnan(fixedValue(i))) point[static_cast<std::size_t>(i)] = fixedValue(i);
  return point;
}

void StreamIdentification::start(const StreamKnowledge& knowledge, double interval, int samples,
                                 const StreamModel* guess) {
  knowledge_ = knowledge;
  interval_ = interval;
  samples_ = samples;
  running_ = true;
  dimensions_ = 0;
  for (int i = 0; i < 4; ++i) {
    if (!std::isnan(fixedValue(i)) || (i == kVelocity && !knowledge.use_velocities)) continue;
    searched_[static_cast<std::size_t>(dimensions_++)] = i;
  }
  shown_noise_ = std::max(noiseFromDifferences(&StreamBlock::position),
                          knowledge_.least_position / std::sqrt(samples_));
  least_stamp_ = kLeastStampNoise * std::min(interval, kLeastStampPart * shown_noise_ / speed());
  best_value_ = searched_value_ = std::numeric_limits<double>::infinity();
  searching_ = knowledge.time_constant >= 0;
  best_ = candidate_ = firstGuess(guess);
  if (searching_) {
    beginSearch(best_);
  } else {
    // Also with a guess: a motion that begins is not found from a model of rest step by step.
    grid_ = firstGuess(nullptr);
    if (guess != nullptr) grid_[kStamp] = best_[kStamp];
    grid_[kTime] = logarithm(kShortestTime * interval);
  }
  beginCandidate();
}

void StreamIdentification::beginSearch(const SimplexSearch::Point& from) {
  SimplexSearch::Point first{};
  SimplexSearch::Point steps{};
  constexpr double kSteps[] = {0.5, 0.7, -1, 2};
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions_); ++i) {
    first[i] = from[static_cast<std::size_t>(searched_[i])];
    steps[i] = kSteps[searched_[i]];
  }
  best_ = from;
  searching_ = true;
  search_.start(first, steps, dimensions_, kTolerance, kMostValues);
  candidate_ = whole(search_.asked());
}

double StreamIdentification::longestTime() const {
  return std::max(knowledge_.longest_time, kLeastLongest * interval_);
}

/// All four parameters, of those that are searched.
SimplexSearch::Point StreamIdentification::whole(const SimplexSearch::Point& searched) const {
  SimplexSearch::Point point = best_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions_); ++i)
    point[static_cast<std::size_t>(searched_[i])] = searched[i];
  return point;
}

/// The model of blocks at a point, held within what makes sense.
StreamModel StreamIdentification::modelAt(const SimplexSearch::Point& point) const {
  StreamModel model;
  const double time = std::clamp(std::exp(point[kTime]), kShortestTime * interval_, longestTime());
  const double position = std::max(
      {std::exp(point[kPosition]), knowledge_.least_position / std::sqrt(samples_), kTiny});
  model.position_variance = position * position;
  model.density = densityFor(time, model.position_variance, knowledge_.order, interval_);
  model.velocity_variance =
      knowledge_.use_velocities ? std::max(std::exp(2 * point[kVelocity]), kTiny) : -1;
  model.stamp_variance = !(point[kStamp] > logarithm(kTiny)) ? 0 : std::exp(2 * point[kStamp]);
  return model;
}

/// What leads a search back to where modelAt() does not hold it.
double StreamIdentification::penalty(const SimplexSearch::Point& point) const {
  const auto below = [](double value, double bound) { return std::max(0.0, bound - value); };
  const double shortest = logarithm(kShortestTime * interval_);
  const double longest = logarithm(longestTime());
  const double least = logarithm(knowledge_.least_position / std::sqrt(samples_));
  double distance =
      below(point[kTime], shortest) + below(longest, point[kTime]) + below(point[kPosition], least);
  if (std::isnan(fixedValue(kStamp))) distance += below(point[kStamp], logarithm(least_stamp_));
  return 10 * distance * distance;
}

void StreamIdentification::beginCandidate() {
  candidate_model_ = modelAt(candidate_);
  next_ = 0;
  sum_ = 0;
}

template <int N>
double StreamIdentification::stepOf(StreamState<N>& state) {
  const StreamBlock& block = blocks_[next_];
  if (begins(next_)) {
    state = firstState<N>(candidate_model_, interval_, startingBlocks(), [this](int i) {
      const StreamBlock& first = blocks_[next_];
      const StreamBlock& other = blocks_[next_ + static_cast<std::size_t>(i)];
      return std::pair(other.time - first.time, other.position - first.position);
    });
    judged_from_ = firstJudged();
    return 0;
  }
  predict<N>(block.time - blocks_[next_ - 1].time, candidate_model_.density, state);
  // Positions count from the latest block, so that far turns cost no digits.
  const double moved = block.position - blocks_[next_ - 1].position;
  state.x[0] -= moved;
  StreamUpdate<N> done = update<N>(0, -state.x[0], candidate_model_.variance(state.x[1]), state);
  double value = done.normalizedSquare() - std::log(done.precision);
  if (candidate_model_.usesVelocities() && !std::isnan(block.velocity)) {
    done = update<N>(1, block.velocity - state.x[1], candidate_model_.velocity_variance, state);
    value += done.normalizedSquare() - std::log(done.precision);
  }
  return next_ < judged_from_ ? 0 : value;
}

/// The first block that is judged of the stretch that the next one begins.
std::size_t StreamIdentification::firstJudged() const {
  if (knowledge_.rules.judge_start) return next_ + kUnjudged;
  std::size_t end = next_ + 1;
  while (end < blocks_.size() && !begins(end)) ++end;
  const auto share = static_cast<std::size_t>(kForgettingPart * static_cast<double>(end - next_));
  return next_ + std::clamp(share, kUnjudged, kForgetting);
}

/// Whether a block is the first one, or the first after a gap or a jump.
bool StreamIdentification::begins(std::size_t block) const {
  return block == 0 || blocks_[block].begins ||
         blocks_[block].time - blocks_[block - 1].time > knowledge_.longest_gap;
}

/// Blocks from the next one on, without a gap, that the filter is started from.
int StreamIdentification::startingBlocks() const {
  const int most = startingSamples(candidate_model_, knowledge_.order, interval_);
  int count = 1;
  std::size_t at = next_ + 1;
  while (count < most && at < blocks_.size() && !begins(at)) {
    ++count;
    ++at;
  }
  return count;
}

double StreamIdentification::step() {
  switch (knowledge_.order) {
    case 3:
      return stepOf(state3_);
    case 5:
      return stepOf(state5_);
    case 6:
      return stepOf(state6_);
    default:
      return stepOf(state4_);
  }
}

bool StreamIdentification::advance(int steps) {
  if (!running_) return false;
  for (int i = 0; i < steps; ++i) {
    sum_ += step();
    if (++next_ < blocks_.size()) continue;
    endCandidate();
    if (!running_) return true;
    beginCandidate();
  }
  return false;
}

void StreamIdentification::finish() {
  while (running_) advance(1 << 20);
}

/// Notes the value of a candidate and chooses the next one.
void StreamIdentification::endCandidate() {
  double value = sum_ + penalty(candidate_);
  if (!std::isfinite(value)) value = std::numeric_limits<double>::max();
  if (searching_) {
    search_.tell(value);
    if (!search_.finished()) {
      candidate_ = whole(search_.asked());
      return;
    }
    best_ = whole(search_.best());
    if (knowledge_.rules.search_again && search_.bestValue() < searched_value_ - kGain) {
      searched_value_ = search_.bestValue();
      beginSearch(best_);
      return;
    }
    value_ = search_.bestValue();
    model_ = modelAt(best_);
    model_.position_variance *= samples_;
    model_.stamp_variance *= samples_;
    if (model_.usesVelocities()) model_.velocity_variance *= samples_;
    running_ = false;
    return;
  }
  if (value < best_value_) {
    best_value_ = value;
    best_ = candidate_;
  }
  if (grid_[kTime] < std::log(longestTime())) {
    candidate_ = grid_;
    grid_[kTime] += std::log(kGridFactor);
  } else {
    beginSearch(best_);
  }
}

}  // namespace virtual_work_dynamics
