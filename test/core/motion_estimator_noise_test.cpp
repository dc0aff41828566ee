#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "encoder_streams.h"
#include "estimated_streams.h"
#include "joint_state_stream.h"
#include "virtual_work_dynamics/motion_completion.h"
#include "virtual_work_dynamics/motion_estimator.h"

// What noise does to estimates of motions, and what is learnt of it.

namespace virtual_work_dynamics {
namespace {

using encoder_streams::Encoder;
using encoder_streams::Moves;
using encoder_streams::sampled;
using encoder_streams::Samples;
using estimated_streams::encoderOf;
using estimated_streams::estimated;
using estimated_streams::Estimates;
using estimated_streams::hindsight;
using estimated_streams::kLearnt;
using estimated_streams::kRise;
using estimated_streams::movesOf;
using estimator_test::settingsOf;
using Law = encoder_streams::Law;
using State = encoder_streams::State;

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

// Covariances of the first samples say little: of five of them a motion of fourth order tells no
// noise at all.
TEST(MotionEstimator, KnowsItsNoiseOnceSamplesHaveShownIt) {
  using estimator_test::kMillisecond;
  using estimator_test::kR;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1e-4);
  const auto push = [&](estimator_test::Stream& stream, int from, int to) {
    for (int i = from; i < to; ++i) {
      const double q = std::sin(0.01 * i) + normal(random);
      stream.push(i * 10 * kMillisecond, {0, 1}, {q, 0.3});
    }
  };
  estimator_test::Stream found({kR, kR}, settingsOf(0.05));
  push(found, 0, 1);
  EXPECT_TRUE(found.estimator.knowsNoise());  // nothing has moved
  push(found, 1, 5);
  EXPECT_FALSE(found.estimator.knowsNoise());
  push(found, 5, 100);
  EXPECT_TRUE(found.estimator.knowsNoise());  // nor does the second joint ever

  EstimatorSettings settings = settingsOf(0.05);
  settings.noise.position_noise = 1e-4;
  settings.noise.bandwidth = 5;
  estimator_test::Stream given({kR, kR}, settings);
  push(given, 0, 5);
  EXPECT_TRUE(given.estimator.knowsNoise());
}

}  // namespace
}  // namespace virtual_work_dynamics
