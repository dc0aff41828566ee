#include "estimator/encoder_stream.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace virtual_work_dynamics {
namespace {

constexpr unsigned kMotionSeed = 18;
constexpr unsigned kNoiseSeed = 10;
constexpr double kLeastStep = 1e-6;  // s between stamps, which never go back
constexpr double kLoudNoise = 0.3;   // rad/s, of VelocityKind::kNoisy
constexpr double kTooLargeBy = 1.2;
constexpr double kDegree = 57.29577951308232;

double readVelocity(const StreamSpec& spec, double truth, double deviate) {
  switch (spec.velocity) {
    case VelocityKind::kZero:
      return 0;
    case VelocityKind::kDegrees:
      return kDegree * (truth + spec.velocityNoise() * deviate);
    case VelocityKind::kTooLarge:
      return kTooLargeBy * truth + spec.velocityNoise() * deviate;
    case VelocityKind::kNoisy:
      return truth + kLoudNoise * deviate;
    default:
      return truth + spec.velocityNoise() * deviate;
  }
}

}  // namespace

double StreamSpec::positionNoise() const {
  return quantum * std::sqrt(1.0 / 12 + white * white);
}

StreamSpec StreamSpec::even() const {
  StreamSpec spec = *this;
  spec.jitter = spec.uneven = spec.dropped = 0;
  return spec;
}

std::string StreamSpec::name() const {
  char text[160];
  std::snprintf(text, sizeof text, "%s %d Hz %g rad %s jitter %g ms", group.c_str(), rate, quantum,
                hasVelocities() ? "with velocities" : "positions only", 1e3 * jitter);
  return text;
}

EncoderRecording record(const StreamSpec& spec) {
  EncoderRecording recording{
      spec, ArmMotion(spec.motion, spec.seconds, spec.still, kMotionSeed), {}, {}, {}, {}};
  std::mt19937 random(kNoiseSeed);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const int count = static_cast<int>(spec.seconds * spec.rate);
  recording.positions.resize(count, kArmJoints);
  recording.velocities.resize(spec.hasVelocities() ? count : 0, kArmJoints);
  Motion motion(kArmJoints);
  Eigen::Index row = 0;
  for (int k = 0; k < count; ++k) {
    if (spec.dropped > 0 && uniform(random) < spec.dropped) continue;
    double time = static_cast<double>(k) / spec.rate;
    if (spec.uneven > 0) time += spec.uneven / spec.rate * (uniform(random) - 0.5);
    double stamp = time + (spec.jitter > 0 ? spec.jitter * normal(random) : 0);
    if (row > 0) stamp = std::max(stamp, recording.stamps.back() + kLeastStep);
    recording.times.push_back(time);
    recording.stamps.push_back(stamp);
    recording.motion.evaluate(time, motion);
    for (int j = 0; j < kArmJoints; ++j) {
      const double q = motion.q[j] + spec.white * spec.quantum * normal(random);
      recording.positions(row, j) = spec.quantum * std::round(q / spec.quantum);
      const double deviate = normal(random);
      if (spec.hasVelocities())
        recording.velocities(row, j) = readVelocity(spec, motion.qd[j], deviate);
    }
    ++row;
  }
  recording.positions.conservativeResize(row, kArmJoints);
  if (spec.hasVelocities()) {
    recording.velocities.conservativeResize(row, kArmJoints);
  } else {
    recording.velocities.resize(0, 0);
  }
  return recording;
}

std::vector<std::size_t> rowsBetween(const EncoderRecording& recording, double from, double to,
                                     std::size_t count) {
  const auto& times = recording.times;
  const auto first =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), from) - times.begin());
  const auto last =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), to) - times.begin());
  const std::size_t step = std::max<std::size_t>(1, (last - first) / count);
  std::vector<std::size_t> rows;
  for (std::size_t row = first; row < last; row += step) rows.push_back(row);
  return rows;
}

}  // namespace virtual_work_dynamics
