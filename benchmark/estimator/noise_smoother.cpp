#include "estimator/noise_smoother.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/sample_blocks.h"
#include "motion/stream_identification.h"
#include "motion/stream_smoother.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kLongestGap = 1;     // s
constexpr double kLongestTime = 0.3;  // s
constexpr double kGrowth = 1.4;

double interval(const EncoderRecording& recording) {
  return 1.0 / recording.spec.rate;
}

std::vector<StreamBlock> samples(const EncoderRecording& recording, std::size_t joint) {
  const auto column = static_cast<Eigen::Index>(joint);
  std::vector<StreamBlock> samples(recording.rows());
  for (std::size_t row = 0; row < samples.size(); ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    samples[row] = {recording.times[row], recording.positions(at, column),
                    recording.spec.hasVelocities() ? recording.velocities(at, column)
                                                   : std::numeric_limits<double>::quiet_NaN()};
  }
  return samples;
}

double leastNoiseOf(const EncoderRecording& recording, std::size_t joint) {
  const auto column = recording.positions.col(static_cast<Eigen::Index>(joint));
  return leastNoise(std::vector<double>(column.data(), column.data() + column.size()));
}

/// Mean square of the residuals over the square of the share of the samples' degrees of freedom
/// that the smoother leaves.
double crossValidation(const std::vector<StreamBlock>& samples, const StreamModel& model,
                       double interval) {
  double squares = 0;
  double leverage = 0;
  const auto take = [&](std::size_t row, const SmoothedSample& sample) {
    const double residual = samples[row].position - sample.motion[0];
    squares += residual * residual;
    leverage += sample.covariance(0, 0) / model.position_variance;
  };
  smoothStream(samples, model, 3, interval, kLongestGap, HUGE_VAL, true, take);
  const double left = 1 - leverage / static_cast<double>(samples.size());
  return squares / (left * left);
}

}  // namespace

NoiseSmoother NoiseSmoother::byLikelihood(const EncoderRecording& recording, int order) {
  NoiseSmoother smoother(recording, order);
  const double step = interval(recording);
  const int size = blockSize(kBlockTime, step);
  for (std::size_t joint = 0; joint < kArmJoints; ++joint) {
    StreamKnowledge knowledge;
    knowledge.order = order;
    knowledge.least_position = leastNoiseOf(recording, joint);
    knowledge.stamp_noise = 0;
    knowledge.use_velocities = recording.spec.hasVelocities();
    knowledge.longest_gap = kLongestGap;
    StreamIdentification identification;
    identification.blocks() = averaged(samples(recording, joint), size);
    identification.start(knowledge, step * size, size, nullptr);
    identification.finish();
    smoother.models_[joint] = identification.model();
  }
  return smoother;
}

NoiseSmoother NoiseSmoother::spline(const EncoderRecording& recording) {
  NoiseSmoother smoother(recording, 3);
  const double step = interval(recording);
  for (std::size_t joint = 0; joint < kArmJoints; ++joint) {
    const std::vector<StreamBlock> rows = samples(recording, joint);
    StreamModel model;
    // Only the ratio of noise and density counts.
    model.position_variance = std::pow(leastNoiseOf(recording, joint), 2);
    double least = HUGE_VAL;
    for (double time = step / 2; time < kLongestTime; time *= kGrowth) {
      model.density = densityFor(time, model.position_variance, 3, step);
      const double value = crossValidation(rows, model, step);
      if (!(value < least)) continue;
      least = value;
      smoother.models_[joint] = model;
    }
  }
  return smoother;
}

std::vector<Motion> NoiseSmoother::motions(const std::vector<std::size_t>& rows) const {
  std::vector<Motion> motions(rows.size(), Motion(kArmJoints));
  for (std::size_t j = 0; j < kArmJoints; ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    const auto take = [&](std::size_t row, const SmoothedSample& sample) {
      const auto found = std::lower_bound(rows.begin(), rows.end(), row);
      if (found == rows.end() || *found != row) return;
      Motion& motion = motions[static_cast<std::size_t>(found - rows.begin())];
      motion.q[joint] = sample.motion[0];
      motion.qd[joint] = sample.motion[1];
      motion.qdd[joint] = sample.motion[2];
    };
    smoothStream(samples(recording_, j), models_[j], order_, interval(recording_), kLongestGap,
                 HUGE_VAL, false, take);
  }
  return motions;
}

}  // namespace virtual_work_dynamics
