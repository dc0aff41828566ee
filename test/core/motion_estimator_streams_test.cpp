#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "encoder_streams.h"
#include "joint_state_stream.h"
#include "motion/stream_smoother.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_estimator.h"

// What encoders and drivers really send, and how well motions are estimated from it.

namespace virtual_work_dynamics {
namespace {

using encoder_streams::Encoder;
using encoder_streams::Moves;
using encoder_streams::sampled;
using encoder_streams::Samples;
using estimator_test::kMillisecond;
using estimator_test::kR;
using estimator_test::settingsOf;
using estimator_test::Stream;
using Law = encoder_streams::Law;
using State = encoder_streams::State;

constexpr double kRise = 0.1;    // s, of accelerations
constexpr double kLearnt = 1.0;  // s after which results are judged

std::vector<Law> movesOf(std::size_t joints, double duration, unsigned seed) {
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
Estimates estimated(const Samples& samples, const EstimatorSettings& settings,
                    std::vector<std::size_t> order = {}) {
  const std::size_t joints = samples.positions.size();
  if (order.empty()) {
    order.resize(samples.rows());
    std::iota(order.begin(), order.end(), std::size_t{0});
  }
  std::vector<std::int64_t> stamps;
  for (const double stamp : samples.stamps) stamps.push_back(std::llround(stamp * 1e9));
  Stream stream(std::vector<JointType>(joints, kR), settings);
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
double hindsight(const Samples& samples, const Encoder& encoder, double lag, double from = kLearnt,
                 double to = 1e9) {
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

Encoder encoderOf(double rate, double quantum, double velocity_noise = -1, double jitter = 0) {
  Encoder encoder;
  encoder.rate = rate;
  encoder.quantum = quantum;
  encoder.velocity_noise = velocity_noise;
  encoder.jitter = jitter;
  return encoder;
}

TEST(MotionEstimator, LearnsWhatItNeedsWithinASecond) {
  for (const Encoder& encoder : {encoderOf(125, 1e-4), encoderOf(1000, 1e-3), encoderOf(1000, 1e-5),
                                 encoderOf(500, 1e-4, 2e-3), encoderOf(1000, 1e-4, -1, 1e-4)})
    for (const double lag : {0.0, 0.05}) {
      SCOPED_TRACE(std::to_string(encoder.rate) + " Hz, " + std::to_string(encoder.quantum) +
                   " rad, lag " + std::to_string(lag) +
                   (encoder.velocity_noise > 0 ? ", velocities" : "") +
                   (encoder.jitter > 0 ? ", jitter" : ""));
      const Samples samples = sampled(movesOf(1, 6, 3), encoder, 6, 1);
      const double best = hindsight(samples, encoder, lag);
      const double error = estimated(samples, settingsOf(lag)).error(samples);
      EXPECT_LT(error, 1.3 * best) << best;
    }
}

TEST(MotionEstimator, FindsTheNoiseOfItsSamples) {
  Encoder encoder = encoderOf(1000, 0, 5e-3, 0);
  encoder.white = 2e-4;
  const Samples samples = sampled(movesOf(1, 5, 4), encoder, 5, 2);
  const StreamQuality quality = estimated(samples, {}).qualities[0];
  EXPECT_NEAR(quality.position_noise / encoder.white, 1, 0.15);
  EXPECT_NEAR(quality.velocity_noise / encoder.velocity_noise, 1, 0.15);
  EXPECT_LT(quality.stamp_noise, 1.5e-4);  // at 1 rad/s less than the noise of positions
  EXPECT_NEAR(quality.interval, 0.001, 1e-6);
  EXPECT_GT(quality.bandwidth, 2);
  EXPECT_LT(quality.bandwidth, 40);
  EXPECT_EQ(quality.velocity_ratio, 1);
}

TEST(MotionEstimator, KeepsToWhatIsKnown) {
  const Encoder encoder = encoderOf(1000, 1e-4, 5e-3);
  const Samples samples = sampled(movesOf(1, 3, 4), encoder, 3, 2);
  EstimatorSettings settings;
  settings.noise.position_noise = 3e-4;
  settings.noise.velocity_noise = 2e-2;
  settings.noise.stamp_noise = 2e-5;
  settings.noise.bandwidth = 11;
  const StreamQuality quality = estimated(samples, settings).qualities[0];
  EXPECT_NEAR(quality.position_noise, 3e-4, 1e-9);
  EXPECT_NEAR(quality.velocity_noise, 2e-2, 1e-7);
  EXPECT_NEAR(quality.stamp_noise, 2e-5, 1e-10);
  EXPECT_NEAR(quality.bandwidth, 11, 0.05);  // in blocks of 4 ms it is that of their interval
}

TEST(MotionEstimator, ItsCovarianceIsTrue) {
  std::size_t within = 0;
  std::size_t all = 0;
  for (const Encoder& encoder : {encoderOf(125, 1e-4), encoderOf(1000, 1e-3),
                                 encoderOf(500, 1e-4, 2e-3), encoderOf(1000, 1e-4, -1, 1e-4)}) {
    const Samples samples = sampled(movesOf(2, 6, 5), encoder, 6, 3);
    const Estimates estimates = estimated(samples, {});
    for (std::size_t joint = 0; joint < 2; ++joint) {
      std::size_t mine = 0;
      std::size_t count = 0;
      for (std::size_t k = 0; k < estimates.rows.size(); ++k) {
        const State& truth = samples.truth[joint][estimates.rows[k]];
        if (samples.stamps[estimates.rows[k]] < kLearnt) continue;
        const Eigen::Matrix3d& covariance = estimates.covariances[k].coordinates[joint];
        const double error = estimates.motions[k].qdd[static_cast<Eigen::Index>(joint)] - truth.qdd;
        mine += std::abs(error) <= 2 * std::sqrt(covariance(2, 2));
        ++count;
      }
      within += mine;
      all += count;
      EXPECT_GT(static_cast<double>(mine) / static_cast<double>(count), 0.80)
          << encoder.rate << " Hz, joint " << joint;
    }
  }
  const double part = static_cast<double>(within) / static_cast<double>(all);
  EXPECT_GT(part, 0.90);
  EXPECT_LT(part, 0.99);
}

TEST(MotionEstimator, LateSamplesTakeTheirPlace) {
  const Encoder encoder = encoderOf(1000, 1e-4);
  const Samples samples = sampled(movesOf(2, 4, 6), encoder, 4, 4);
  const Estimates in_order = estimated(samples, {});
  for (const double part : {0.05, 0.5}) {
    std::mt19937 generator(8);
    std::uniform_real_distribution<double> chance(0, 1);
    std::vector<std::size_t> order(samples.rows());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
      if (chance(generator) < part) {
        std::swap(order[i], order[i + 1]);
        ++i;
      }
    const Estimates exchanged = estimated(samples, {}, order);
    EXPECT_GE(static_cast<double>(exchanged.rows.size()),
              0.98 * static_cast<double>(in_order.rows.size()));
    EXPECT_TRUE(std::is_sorted(exchanged.rows.begin(), exchanged.rows.end()));
    for (const std::size_t joint : {0, 1})
      EXPECT_LT(exchanged.error(samples, joint), 1.1 * in_order.error(samples, joint));
  }
}

// A finger beside a 500 Hz arm: every message of the arm gives one motion, without delay.
TEST(MotionEstimator, AJointAtAnotherRateHoldsUpNoOne) {
  const Law arm = Moves(7, 5, kRise);
  const Law finger = [](double t) {
    return State{0.02 + 0.01 * std::sin(2 * t), 0.02 * std::cos(2 * t), -0.04 * std::sin(2 * t)};
  };
  for (const double rate : {0.0, 1.0, 10.0}) {
    SCOPED_TRACE(std::to_string(rate) + " Hz");
    Stream stream({kR, kR}, {});
    if (rate == 0) stream.estimator.setRest(1, 0.02);
    const int every = rate > 0 ? static_cast<int>(500 / rate) : 1000000;
    std::int64_t latest = -1;
    int motions = 0;
    for (int i = 0; i < 2500; ++i) {
      const std::int64_t time = i * 2 * kMillisecond;
      const double t = 0.002 * i;
      if (rate > 0 && i % every == 0) {
        stream.push(time, {1}, {finger(t).q});
        latest = time;
      }
      stream.push(time, {0}, {1e-4 * std::round(1e4 * arm(t).q)});
      const double age = stream.estimator.age(1);
      if (rate > 0) {
        EXPECT_NEAR(age, static_cast<double>(time - latest) * 1e-9, 1e-12);
      } else {
        EXPECT_TRUE(std::isinf(age));
      }
      if (i == 499) motions = 0;
      while (stream.estimator.ready()) {
        const std::int64_t instant = stream.evaluate();
        ++motions;
        if (i < 500) continue;
        ASSERT_EQ(instant, time - 50 * kMillisecond);
        const double at = static_cast<double>(instant) * 1e-9;
        if (rate == 10) {
          ASSERT_FALSE(stream.estimator.held(1));
          ASSERT_NEAR(stream.motion.q[1], finger(at).q, 3e-4);
          ASSERT_NEAR(stream.motion.qd[1], finger(at).qd, 5e-3);
          continue;
        }
        ASSERT_TRUE(stream.estimator.held(1)) << at;
        ASSERT_EQ(stream.motion.qd[1], 0);
        ASSERT_EQ(stream.motion.qdd[1], 0);
        ASSERT_TRUE(stream.covariance.coordinates[1].isZero(0));
        const double before = std::floor(at + 1e-9);
        ASSERT_NEAR(stream.motion.q[1], rate == 0 ? 0.02 : finger(before).q, 1e-12) << at;
      }
    }
    EXPECT_EQ(motions, 2001);
    EXPECT_FALSE(stream.estimator.held(0));
  }
}

TEST(MotionEstimator, AJointThatGoesSilentIsHeldAfterAWhile) {
  EstimatorSettings settings = settingsOf(0.02);
  settings.hold_after = 0.1;
  Stream stream({kR, kR}, settings);
  const auto q = [](double t) { return std::sin(3 * t); };
  bool was_held = false;
  for (int i = 0; i < 4000; ++i) {
    const std::int64_t time = i * kMillisecond;
    stream.push(time, {0}, {0.5 * q(0.001 * i)});
    if (i <= 2000 || i >= 2800) stream.push(time, {1}, {q(0.001 * i)});
    while (stream.estimator.ready()) {
      const double t = static_cast<double>(stream.evaluate()) * 1e-9;
      EXPECT_FALSE(stream.estimator.held(0));
      const bool held = stream.estimator.held(1);
      was_held = was_held || held;
      ASSERT_EQ(held, t > 2.1 + 1e-9 && t < 2.8 - 1e-9) << t;
      if (t < 1) continue;
      if (held) {
        ASSERT_EQ(stream.motion.q[1], q(2)) << t;
        ASSERT_EQ(stream.motion.qd[1], 0);
      } else if (t <= 2 || t > 2.85) {
        ASSERT_NEAR(stream.motion.q[1], q(t), 1e-5) << t;
        ASSERT_NEAR(stream.motion.qd[1], 3 * std::cos(3 * t), 1e-3) << t;
      }
    }
  }
  EXPECT_TRUE(was_held);
}

// Before and behind a gap the motion is as if nothing were on its other side.
TEST(MotionEstimator, AFitNeverReachesAcrossAGap) {
  for (const double behind : {0.0, 1e3}) {
    Stream stream({kR}, {});
    const auto q = [](double t) { return std::sin(3 * t); };
    int near = 0;
    for (int i = 0; i < 3000; ++i) {
      if (i > 1500 && i < 1800) continue;
      stream.push(i * kMillisecond, {0},
                  {1e-4 * std::round(1e4 * q(0.001 * i)) + (i < 1700 ? 0 : behind)});
      while (stream.estimator.ready()) {
        const double t = static_cast<double>(stream.evaluate()) * 1e-9;
        if (t < 1) continue;
        const double jump = t < 1.7 ? 0 : behind;
        ASSERT_NEAR(stream.motion.q[0] - jump, q(t), 3e-4) << t;
        if (t > 1.8 && t < 1.85) continue;  // few samples, and newest ones
        ASSERT_NEAR(stream.motion.qdd[0], -9 * std::sin(3 * t), 3) << t;
        near += std::abs(t - 1.65) < 0.2;
      }
    }
    EXPECT_GT(near, 45);
  }
}

TEST(MotionEstimator, WrongVelocitiesAreFoundAndNotUsed) {
  const Encoder encoder = encoderOf(1000, 1e-4, 0);
  const Samples right = sampled(movesOf(1, 4, 9), encoder, 4, 5);
  Samples absent = right;
  absent.velocities.clear();
  const double positions_only = estimated(absent, {}).error(absent);
  EXPECT_LT(estimated(right, {}).error(right), positions_only);
  std::mt19937 generator(6);
  std::normal_distribution<double> normal(0, 3);
  const std::vector<std::pair<std::function<double(double)>, double>> wrongs = {
      {[](double) { return 0; }, 0},
      {[](double qd) { return 57.29577951 * qd; }, 57.3},
      {[](double qd) { return 1.2 * qd; }, 1.2},
      {[&](double) { return normal(generator); }, std::nan("")}};
  for (const auto& [wrong, ratio] : wrongs) {
    Samples samples = right;
    for (double& qd : samples.velocities[0]) qd = wrong(qd);
    const Estimates estimates = estimated(samples, {});
    EXPECT_LT(estimates.error(samples), 1.2 * positions_only) << ratio;
    const StreamQuality& quality = estimates.qualities[0];
    EXPECT_LT(quality.velocity_noise, 0);
    if (std::isnan(ratio)) {
      EXPECT_GT(std::abs(quality.velocity_ratio - 1), 0.1);
    } else {
      EXPECT_NEAR(quality.velocity_ratio, ratio, 0.02 * std::max(1.0, ratio));
    }
  }
}

/// Root mean square of the errors of the accelerations that completeMotion() finds, except for an
/// eighth at either end.
double completionError(const Samples& samples) {
  const Mechanism mechanism = estimator_test::mechanismOf({JointType::kRevolute});
  const auto rows = static_cast<Eigen::Index>(samples.rows());
  MotionTable motion;
  motion.joints = mechanism.coordinateNames();
  motion.times = samples.stamps;
  motion.positions = Eigen::Map<const Eigen::VectorXd>(samples.positions[0].data(), rows);
  if (!samples.velocities.empty())
    motion.velocities = Eigen::Map<const Eigen::VectorXd>(samples.velocities[0].data(), rows);
  motion = completeMotion(mechanism, std::move(motion));
  double squares = 0;
  for (Eigen::Index row = rows / 8; row < rows * 7 / 8; ++row) {
    const State& truth = samples.truth[0][static_cast<std::size_t>(row)];
    squares += std::pow(motion.accelerations(row, 0) - truth.qdd, 2);
  }
  return std::sqrt(squares / static_cast<double>(rows * 3 / 4));
}

// Right in the mean, but so noisy that they say next to nothing.
TEST(MotionEstimatorAccuracy, NoisyVelocitiesDoNoHarm) {
  for (const int rate : {125, 1000})
    for (const double quantum : {1e-5, 1e-4}) {
      SCOPED_TRACE(std::to_string(rate) + " Hz, " + std::to_string(quantum) + " rad");
      Samples noisy = sampled(movesOf(1, 4, 9), encoderOf(rate, quantum, 0), 4, 5);
      Samples absent = noisy;
      absent.velocities.clear();
      std::mt19937 generator(6);
      std::normal_distribution<double> normal(0, 0.3);
      for (double& qd : noisy.velocities[0]) qd += normal(generator);
      EXPECT_LT(estimated(noisy, {}).error(noisy), 1.2 * estimated(absent, {}).error(absent));
      EXPECT_LT(completionError(noisy), 1.2 * completionError(absent));
    }
}

// Nothing can be learnt at rest, and what was learnt there must not blunt the first move.
TEST(MotionEstimator, AJointThatRestsForSecondsAndThenMovesIsFollowed) {
  for (const double white : {0.0, 1e-4}) {
    Encoder encoder = encoderOf(1000, 1e-4);
    encoder.white = white;
    const Law moves = Moves(11, 4, kRise);
    const State start = moves(0);
    const Law late = [&](double t) { return t < 4 ? State{start.q, 0, 0} : moves(t - 4); };
    const Samples samples = sampled({late}, encoder, 8, 6);
    const Estimates estimates = estimated(samples, {});
    const double first = hindsight(samples, encoder, 0.05, 4, 5.5);
    EXPECT_LT(estimates.error(samples, 0, 4, 5.5), 3 * first) << first;
    const double later = hindsight(samples, encoder, 0.05, 5.5, 8);
    EXPECT_LT(estimates.error(samples, 0, 5.5, 8), 1.3 * later) << later;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
