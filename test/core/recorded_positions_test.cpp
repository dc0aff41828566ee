#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_completion.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEncoderNoise = 1.2e-5;  // rad
constexpr double kEncoderStep = 0.005;    // s
constexpr std::size_t kEncoderRows = 800;

Mechanism oneTurningJoint() {
  std::vector<Link> links(2);
  std::vector<Joint> joints(1);
  joints[0].name = "hinge";
  joints[0].type = JointType::kRevolute;
  joints[0].parent_link = 0;
  joints[0].child_link = 1;
  joints[0].axis_K = Vector3l::UnitZ();
  joints[0].coordinate = 0;
  links[1].parent_joint = 0;
  return Mechanism("one", links, joints);
}

// Position, velocity and acceleration.
Eigen::Vector3d encoderSwing(double t) {
  const double a = 2.1 * t;
  const double b = 3.7 * t + 0.4;
  return {0.2 * std::sin(a) + 0.05 * std::sin(b), 0.42 * std::cos(a) + 0.185 * std::cos(b),
          -0.882 * std::sin(a) - 0.6845 * std::sin(b)};
}

// What an encoder with noise tells of it, with stamps that jitter, s.
MotionTable encoderRecording(double jitter, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, 1);
  MotionTable table;
  table.joints = {"hinge"};
  table.positions.resize(kEncoderRows, 1);
  for (std::size_t row = 0; row < kEncoderRows; ++row) {
    const double t = kEncoderStep * static_cast<double>(row);
    table.times.push_back(t + jitter * normal(generator));
    table.positions(static_cast<Eigen::Index>(row), 0) =
        encoderSwing(t)[0] + kEncoderNoise * normal(generator);
  }
  return table;
}

struct EncoderShare {
  double within = 0;  // part of the rows whose error is at most two deviations
  double ratio = 0;   // rms of error over deviation
};

// What results are made of, by position, velocity and acceleration: a weight that leans, a body
// that accelerates, and both with and against each other, in parts that are alike.
const std::vector<Eigen::Vector3d> kEncoderResults{{1, 0, 0},      {0, 1, 0},       {0, 0, 1},
                                                   {1, 0, 0.0005}, {1, 0, -0.0005}, {1, 0.02, 0}};

// Of each of kEncoderResults, over recordings with noise of their own.
std::vector<EncoderShare> sharesOf(const CompletionSettings& settings, double jitter) {
  constexpr int kDraws = 4;
  constexpr double kAll = kDraws * static_cast<double>(kEncoderRows);
  const Mechanism mechanism = oneTurningJoint();
  std::vector<EncoderShare> shares(kEncoderResults.size());
  for (int draw = 0; draw < kDraws; ++draw) {
    const MotionTable table = encoderRecording(jitter, static_cast<unsigned>(draw));
    const MotionTable found = completeMotion(mechanism, table, settings);
    for (std::size_t row = 0; row < kEncoderRows; ++row) {
      const auto at = static_cast<Eigen::Index>(row);
      const Eigen::Vector3d motion(found.positions(at, 0), found.velocities(at, 0),
                                   found.accelerations(at, 0));
      const Eigen::Vector3d error = motion - encoderSwing(kEncoderStep * static_cast<double>(row));
      for (std::size_t i = 0; i < shares.size(); ++i) {
        const double square = std::pow(kEncoderResults[i].dot(error), 2) /
                              kEncoderResults[i].dot(found.covariances[row] * kEncoderResults[i]);
        shares[i].within += (square <= 4 ? 1 : 0) / kAll;
        shares[i].ratio += square / kAll;
      }
    }
  }
  for (EncoderShare& share : shares) share.ratio = std::sqrt(share.ratio);
  return shares;
}

void expectThatSharesAreRight(bool kept, double jitter) {
  CompletionSettings settings;
  settings.covariances = true;
  settings.keep_positions = kept;
  const std::vector<EncoderShare> shares = sharesOf(settings, jitter);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    SCOPED_TRACE(testing::Message() << kEncoderResults[i].transpose() << ": " << shares[i].within
                                    << " within two deviations");
    EXPECT_GT(shares[i].within, 0.90);
    EXPECT_GT(shares[i].ratio, 0.7);
    EXPECT_LT(shares[i].ratio, 1.2);
  }
}

TEST(RecordedPositions, ErrAsTheirDeviationsSayBesideEstimatedRates) {
  expectThatSharesAreRight(true, 0);
  expectThatSharesAreRight(false, 0);
}

TEST(RecordedPositions, ErrAsTheirDeviationsSayAtTheTicksOfAClockWhoseStampsJitter) {
  expectThatSharesAreRight(true, 1e-4);
}

TEST(RecordedPositions, StampsThatJitterAreSaidToBesideAnEvenClock) {
  CompletionReport report;
  completeMotion(oneTurningJoint(), encoderRecording(1e-4, 1), {}, &report);
  EXPECT_TRUE(report.even_clock);
  EXPECT_NEAR(report.qualities[0].stamp_noise, 1e-4, 1e-5);
}

}  // namespace
}  // namespace virtual_work_dynamics
