#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "encoder_streams.h"
#include "joint_state_stream.h"
#include "motion/stream_smoother.h"
#include "virtual_work_dynamics/motion_estimator.h"

namespace virtual_work_dynamics {

/// How well motions are estimated from streams of encoders.
namespace estimated_streams {

using encoder_streams::Encoder;
using encoder_streams::Moves;
using encoder_streams::Samples;
using Law = encoder_streams::Law;

constexpr double kRise = 0.1;    // s, of accelerations
constexpr double kLearnt = 1.0;  // s after which results are judged

inline std::vector<Law> movesOf(std::size_t joints, double duration, unsigned seed) {
  std::vector<Law> laws;
  for (std::size_t i = 0; i < joints; ++i)
    laws.push_back(Moves(seed + static_cast<unsigned>(i), duration, kRise));
  return laws;
}

/// Estimates at rows of samples.
struct Estimates {
  std::vector<std::size_t> rows;
  std::vector<Motion> motions;
  std::vector<MotionCovariance> covariances;
  std::vector<StreamQuality> qualities;  // at the end

  /// Root of the mean square error of accelerations over that of the accelerations themselves.
  double error(const Samples& samples, std::size_t joint = 0, double from = kLearnt,
               double to = 1e9) const {
    double error = 0;
    double truth = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (samples.stamps[rows[k]] < from || samples.stamps[rows[k]] > to) continue;
      const double qdd = samples.truth[joint][rows[k]].qdd;
      error += std::pow(motions[k].qdd[static_cast<Eigen::Index>(joint)] - qdd, 2);
      truth += qdd * qdd;
    }
    EXPECT_GT(truth, 0);
    return std::sqrt(error / truth);
  }
};

/// Pushes rows in the order that is given, all joints in one message each.
inline Estimates estimated(const Samples& samples, const EstimatorSettings& settings,
                           std::vector<std::size_t> order = {}) {
  const std::size_t joints = samples.positions.size();
  if (order.empty()) {
    order.resize(samples.rows());
    std::iota(order.begin(), order.end(), std::size_t{0});
  }
  std::vector<std::int64_t> stamps;
  for (const double stamp : samples.stamps) stamps.push_back(std::llround(stamp * 1e9));
  estimator_test::Stream stream(std::vector<JointType>(joints, estimator_test::kR), settings);
  Estimates estimates;
  std::vector<int> coordinates(joints);
  std::iota(coordinates.begin(), coordinates.end(), 0);
  for (const std::size_t row : order) {
    std::vector<double> q;
    std::vector<double> qd;
    for (std::size_t joint = 0; joint < joints; ++joint) {
      q.push_back(samples.positions[joint][row]);
      if (!samples.velocities.empty()) qd.push_back(samples.velocities[joint][row]);
    }
    stream.push(stamps[row], coordinates, q, qd);
    while (stream.estimator.ready()) {
      const std::int64_t instant = stream.evaluate();
      const auto at = std::lower_bound(stamps.begin(), stamps.end(), instant);
      EXPECT_EQ(*at, instant);
      estimates.rows.push_back(static_cast<std::size_t>(at - stamps.begin()));
      estimates.motions.push_back(stream.motion);
      estimates.covariances.push_back(stream.covariance);
    }
  }
  for (std::size_t joint = 0; joint < joints; ++joint)
    estimates.qualities.push_back(stream.estimator.quality(static_cast<int>(joint)));
  return estimates;
}

/// The error of a fixed-lag smoother with the true noises and the best density for this stream.
inline double hindsight(const Samples& samples, const Encoder& encoder, double lag,
                        double from = kLearnt, double to = 1e9) {
  std::vector<StreamBlock> blocks;
  for (std::size_t row = 0; row < samples.rows(); ++row)
    blocks.push_back({samples.stamps[row], samples.positions[0][row],
                      samples.velocities.empty() ? std::nan("") : samples.velocities[0][row]});
  StreamModel model;
  model.position_variance = encoder.quantum * encoder.quantum / 12 + encoder.white * encoder.white;
  model.velocity_variance =
      samples.velocities.empty() ? -1 : encoder.velocity_noise * encoder.velocity_noise;
  model.stamp_variance = encoder.jitter * encoder.jitter;
  double best = std::numeric_limits<double>::infinity();
  for (double logarithm = -6; logarithm < -2; logarithm += 0.25) {
    model.density = densityFor(std::exp(logarithm), model.position_variance, 4, 1 / encoder.rate);
    double error = 0;
    double truth = 0;
    smoothStream(blocks, model, 4, 1 / encoder.rate, 0.25, lag, false,
                 [&](std::size_t row, const SmoothedSample& sample) {
                   if (samples.stamps[row] < from || samples.stamps[row] > to) return;
                   const double qdd = samples.truth[0][row].qdd;
                   error += std::pow(sample.motion[2] - qdd, 2);
                   truth += qdd * qdd;
                 });
    best = std::min(best, std::sqrt(error / truth));
  }
  return best;
}

inline Encoder encoderOf(double rate, double quantum, double velocity_noise = -1,
                         double jitter = 0) {
  Encoder encoder;
  encoder.rate = rate;
  encoder.quantum = quantum;
  encoder.velocity_noise = velocity_noise;
  encoder.jitter = jitter;
  return encoder;
}
}  // namespace estimated_streams
}  // namespace virtual_work_dynamics
