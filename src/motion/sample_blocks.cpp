#include "motion/sample_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace virtual_work_dynamics {
namespace {

/// Positions are good to so many units of their last digit, at best.
constexpr double kLastDigits = std::numeric_limits<double>::epsilon() / 4;
/// Rounding of one position, as a part of it: files print twelve digits or more.
constexpr double kRounding = 1e-12;
constexpr double kLeast = 1e-18;  // rad or m: less than any encoder or number resolves near zero
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

double leastStep(const double* positions) {
  constexpr int kCount = kStepPositions;
  double differences[kCount];
  double most = 0;
  for (int i = 0; i < kCount; ++i) {
    differences[i] = positions[i] - positions[0];
    most = std::max(most, std::abs(positions[i]));
  }
  double least = std::numeric_limits<double>::infinity();
  for (int order = 1; order < kCount; ++order) {
    for (int i = 0; i + order < kCount; ++i) differences[i] = differences[i + 1] - differences[i];
    if (order == 1) continue;
    const double rounding = kRounding * most * (1 << order);
    for (int i = 0; i + order < kCount; ++i)
      if (std::abs(differences[i]) > rounding) least = std::min(least, std::abs(differences[i]));
  }
  return least;
}

double leastNoise(double step, double position) {
  const double rounding = std::isfinite(step) ? step / std::sqrt(12) : 0;
  return std::max({rounding, kLastDigits * std::abs(position), kLeast});
}

double leastNoise(const std::vector<double>& positions) {
  double step = std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (i + kStepPositions <= positions.size())
      step = std::min(step, leastStep(positions.data() + i));
    most = std::max(most, std::abs(positions[i]));
  }
  return leastNoise(step, most);
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
