#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "motion/stream_identification.h"

namespace virtual_work_dynamics {

/// Samples of a motion whose derivative of order `order` is white noise, with noises.
struct IntegratedNoise {
  int order = 4;
  double density = 1;
  double position_noise = 0;
  double velocity_noise = -1;  // negative: no velocities
  double stamp_noise = 0;
  double first_velocity = 0;

  /// Motion by many small impulses in each interval: not how a filter predicts.
  std::vector<StreamBlock> samples(const std::vector<double>& times, unsigned seed) const {
    constexpr int kSteps = 40;
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal(0, 1);
    std::vector<double> x(static_cast<std::size_t>(order), 0.0);
    x[1] = first_velocity;
    std::vector<StreamBlock> samples;
    for (std::size_t row = 0; row < times.size(); ++row) {
      const double dt = row > 0 ? (times[row] - times[row - 1]) / kSteps : 0;
      for (int step = 0; row > 0 && step < kSteps; ++step) {
        for (std::size_t i = 0; i < x.size(); ++i) {
          double weight = 1;
          for (std::size_t k = i + 1; k < x.size(); ++k)
            x[i] += (weight *= dt / static_cast<double>(k - i)) * x[k];
        }
        x.back() += std::sqrt(density * dt) * normal(generator);
      }
      const double stamp = times[row] + stamp_noise * normal(generator);
      const double velocity =
          velocity_noise < 0 ? std::nan("") : x[1] + velocity_noise * normal(generator);
      samples.push_back({stamp, x[0] + position_noise * normal(generator), velocity});
    }
    return samples;
  }
};

inline std::vector<double> evenlySpaced(std::size_t count, double interval) {
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = static_cast<double>(i) * interval;
  return times;
}

}  // namespace virtual_work_dynamics
