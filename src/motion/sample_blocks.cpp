#include "motion/sample_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace virtual_work_dynamics {
namespace {

/// Positions are good to so many units of their last digit, at best.
constexpr double kLastDigits = std::numeric_limits<double>::epsilon() / 4;
/// Rounding of a difference of three positions, as a part of them.
constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
/// So many times larger than zero is certainly not zero.
constexpr double kCertain = 20;
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
  for (std::size_t first = 0; first + count <= samples.size(); first += count) {
    // Means of differences from the first sample keep the digits of far positions.
    StreamBlock sum{0, 0, 0};
    for (std::size_t i = first; i < first + count; ++i) {
      sum.time += samples[i].time - samples[first].time;
      sum.position += samples[i].position - samples[first].position;
      sum.velocity += samples[i].velocity;
    }
    blocks.push_back({samples[first].time + sum.time / size,
                      samples[first].position + sum.position / size, sum.velocity / size});
  }
  return blocks;
}

/// Differences of this magnitude are zero: remainders of numbers with this rounding, of which the
/// largest is divided by the smallest.
double StepFinder::noDifference() const {
  return kCertain * std::sqrt(kRounding * magnitude_ * largest_);
}

void StepFinder::take(double oldest, double middle, double newest) {
  magnitude_ = std::max({magnitude_, std::abs(oldest), std::abs(middle), std::abs(newest)});
  const double difference = std::abs((newest - middle) - (middle - oldest));
  if (difference <= kRounding * magnitude_) return;
  ++differences_;
  largest_ = std::max(largest_, difference);
  const double zero = noDifference();
  if (differences_ > 1 && divisor_ <= zero) return;  // there is none
  for (double rest = difference; rest > zero;) {
    const double smaller = rest;
    rest = divisor_ > 0 ? std::abs(divisor_ - smaller * std::round(divisor_ / smaller)) : 0;
    divisor_ = smaller;
  }
}

double StepFinder::step() const {
  const bool found = differences_ > 1 && divisor_ > kCertain * noDifference();
  return found ? divisor_ : std::numeric_limits<double>::infinity();
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
