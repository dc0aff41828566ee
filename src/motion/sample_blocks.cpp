#include "motion/sample_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace virtual_work_dynamics {
namespace {

/// Positions are good to so many units of their last digit, at best.
constexpr double kLastDigits = std::numeric_limits<double>::epsilon() / 4;
/// Rounding of a difference of three positions, as a part of them.
constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
/// What is so many times larger than its error is not zero.
constexpr double kCertain = 10;
/// Of so many differences of a step, one at least has another sign than the one before; a jump of
/// the positions makes two such changes.
constexpr int kAlternating = 4;
constexpr int kFewestAlternations = 4;
/// Steps up to this length are an encoder's, rad or m; longer ones have to be seen more often.
constexpr double kLargestUsualStep = 0.01;
constexpr double kLeast = 1e-12;  // rad or m: less than any encoder resolves
/// Time constant of a model that follows its samples, in intervals.
constexpr double kFollowing = 0.2;

}  // namespace

int blockSize(double block_time, double interval) {
  return std::max(1, static_cast<int>(std::lround(std::min(block_time / interval, 1e6))));
}

std::vector<StreamBlock> averaged(const std::vector<StreamBlock>& samples, int size) {
  if (size == 1) return samples;
  const auto count = static_cast<std::size_t>(size);
  std::vector<StreamBlock> blocks;
  blocks.reserve(samples.size() / count);
  bool begins = false;
  std::size_t first = 0;
  while (first + count <= samples.size()) {
    begins = begins || samples[first].begins;
    std::size_t next = first + 1;
    while (next < first + count && !samples[next].begins) ++next;
    if (next < first + count) {
      first = next;  // no block goes across the beginning of another motion
      continue;
    }
    // Means of differences from the first sample keep the digits of far positions.
    StreamBlock sum{0, 0, 0};
    for (std::size_t i = first; i < next; ++i) {
      sum.time += samples[i].time - samples[first].time;
      sum.position += samples[i].position - samples[first].position;
      sum.velocity += samples[i].velocity;
    }
    blocks.push_back({samples[first].time + sum.time / size,
                      samples[first].position + sum.position / size, sum.velocity / size, begins});
    begins = false;
    first = next;
  }
  return blocks;
}

/// Euclid's algorithm for numbers with errors: a remainder that its error may have made is zero.
StepFinder::Inexact StepFinder::commonDivisor(Inexact larger, Inexact smaller) {
  for (;;) {
    if (larger.value < smaller.value) std::swap(larger, smaller);
    const double quotient = std::round(larger.value / smaller.value);
    const Inexact rest{std::abs(larger.value - quotient * smaller.value),
                       larger.error + quotient * smaller.error};
    if (rest.value <= kCertain * rest.error) {
      const Inexact part{larger.value / quotient, larger.error / quotient};
      return part.error < smaller.error ? part : smaller;
    }
    larger = smaller;
    smaller = rest;
  }
}

void StepFinder::take(double oldest, double middle, double newest) {
  const double rounding =
      kRounding * std::max({std::abs(oldest), std::abs(middle), std::abs(newest)});
  const double difference = (newest - middle) - (middle - oldest);
  const bool zero = std::abs(difference) <= kCertain * rounding;
  if (!zero) {
    ++differences_;
    alternations_ += difference * previous_ < 0 ? 1 : 0;
    const Inexact now{std::abs(difference), rounding};
    divisor_ = differences_ > 1 ? commonDivisor(divisor_, now) : now;
  }
  previous_ = zero ? 0 : difference;
}

double StepFinder::step() const {
  const int fewest = divisor_.value <= kLargestUsualStep ? 1 : kFewestAlternations;
  const bool found = alternations_ >= fewest && kAlternating * alternations_ >= differences_ &&
                     divisor_.value > kCertain * kCertain * divisor_.error;
  return found ? divisor_.value : std::numeric_limits<double>::infinity();
}

double noiseDifference(const std::array<double, kDifferenced>& times,
                       const std::array<double, kDifferenced>& positions) {
  // Newton's divided difference, as a sum over the positions.
  double difference = 0;
  double squares = 0;
  for (std::size_t i = 0; i < kDifferenced; ++i) {
    double product = 1;
    for (std::size_t k = 0; k < kDifferenced; ++k)
      if (k != i) product *= times[i] - times[k];
    difference += positions[i] / product;
    squares += 1 / (product * product);
  }
  return difference / std::sqrt(squares);
}

double leastNoise(double step, double position) {
  const double rounding = std::isfinite(step) ? step / std::sqrt(12) : 0;
  return std::max({rounding, kLastDigits * std::abs(position), kLeast});
}

double leastNoise(const std::vector<double>& positions) {
  StepFinder finder;
  double most = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (i > 1) finder.take(positions[i - 2], positions[i - 1], positions[i]);
    most = std::max(most, std::abs(positions[i]));
  }
  return leastNoise(finder.step(), most);
}

StreamModel unlearnt(const StreamKnowledge& knowledge, double interval) {
  const double noise = knowledge.position_noise >= 0
                           ? std::max(knowledge.position_noise, knowledge.least_position)
                           : knowledge.least_position;
  const double time_constant =
      knowledge.time_constant >= 0 ? knowledge.time_constant : kFollowing * interval;
  StreamModel model;
  model.position_variance = noise * noise;
  model.density = densityFor(time_constant, model.position_variance, knowledge.order, interval);
  model.stamp_variance =
      knowledge.stamp_noise > 0 ? knowledge.stamp_noise * knowledge.stamp_noise : 0;
  model.velocity_variance = -1;
  if (!knowledge.use_velocities) return model;
  const double velocity_noise =
      knowledge.velocity_noise >= 0 ? knowledge.velocity_noise : noise / interval;
  model.velocity_variance = std::max(velocity_noise * velocity_noise, 1e-300);
  return model;
}

}  // namespace virtual_work_dynamics
