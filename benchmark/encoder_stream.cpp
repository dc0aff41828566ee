#include "encoder_stream.h"

#include <cmath>
#include <cstddef>
#include <random>

namespace virtual_work_dynamics {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kPosture[kArmJoints] = {0, -1.4, 1.6, -1.8, -1.6, 0};  // rad
constexpr unsigned kSeed = 1;

/// Joints of slightly different frequencies do not stay in step.
double stretch(int joint) {
  return 1 + 0.05 * joint;
}

double readEncoder(const Encoder& encoder, double q, std::mt19937& random) {
  if (encoder.counts == 0) return q;
  const double step = 2 * kPi / (encoder.counts * encoder.gear);
  double counts = q / step;
  if (encoder.noise > 0) counts += std::normal_distribution<double>(0, encoder.noise)(random);
  return step * std::round(counts);
}

}  // namespace

double ArmMotion::highestFrequency() const {
  return frequencies.back() * stretch(kArmJoints - 1);
}

void ArmMotion::evaluate(double time, Motion& motion) const {
  // Phases that are multiples of the golden section of a turn lie apart, however many.
  constexpr double kGoldenAngle = 2 * kPi * 0.6180339887498949;
  for (int j = 0; j < kArmJoints; ++j) {
    motion.q[j] = kPosture[j];
    motion.qd[j] = 0;
    motion.qdd[j] = 0;
    for (int i = 0; i < kSines; ++i) {
      const double w = 2 * kPi * frequencies[static_cast<std::size_t>(i)] * stretch(j);
      const double angle = w * time + kGoldenAngle * (kSines * j + i);
      motion.q[j] += speed / w * std::sin(angle);
      motion.qd[j] += speed * std::cos(angle);
      motion.qdd[j] -= speed * w * std::sin(angle);
    }
  }
}

Recording record(const Stream& stream, const InverseDynamics& dynamics, int count) {
  Recording recording;
  Workspace workspace = dynamics.makeWorkspace();
  Motion motion(kArmJoints);
  std::mt19937 random(kSeed);
  std::normal_distribution<double> deviation(0, kStampDeviation);
  Eigen::VectorXd least = Eigen::VectorXd::Constant(kArmJoints, HUGE_VAL);
  Eigen::VectorXd most = -least;
  for (int k = 0; k < count; ++k) {
    const std::int64_t even = static_cast<std::int64_t>(k) * (1000000000 / stream.rate);
    Sample sample;
    sample.stamp = even;
    if (stream.stamping != Stamping::kTrue) sample.stamp += std::llround(1e9 * deviation(random));
    const std::int64_t read_at = stream.stamping == Stamping::kWrong ? even : sample.stamp;
    stream.motion->evaluate(1e-9 * static_cast<double>(read_at), motion);
    for (int j = 0; j < kArmJoints; ++j) {
      const auto at = static_cast<std::size_t>(j);
      sample.q[at] = readEncoder(*stream.encoder, motion.q[j], random);
      sample.qd[at] = motion.qd[j];
      if (stream.velocity == VelocitySource::kDifferences && k > 0) {
        const Sample& before = recording.samples.back();
        sample.qd[at] =
            (sample.q[at] - before.q[at]) * 1e9 / static_cast<double>(sample.stamp - before.stamp);
      }
    }
    recording.samples.push_back(sample);

    Truth truth;
    stream.motion->evaluate(1e-9 * static_cast<double>(sample.stamp), truth.motion);
    dynamics.compute(truth.motion, workspace);
    truth.effort = workspace.effort();
    least = least.cwiseMin(truth.effort);
    most = most.cwiseMax(truth.effort);
    recording.truth.push_back(truth);
  }
  recording.effort_range = most - least;
  return recording;
}

}  // namespace virtual_work_dynamics
