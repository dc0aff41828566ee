// What estimators say of how well a root's motion is known, held against the truth.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "motion/free_turn_completion.h"
#include "motion/root_completion.h"
#include "motion/root_coordinates.h"
#include "motion/root_estimator.h"
#include "motion/root_imu.h"
#include "motion/root_trajectory.h"
#include "tumbling_roots.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kTimeout = 100000000;
constexpr double kLag = 0.05;
const Eigen::Vector3d kGravity(0.3, -0.2, -9.7);
// Of a table of roots nothing depends on it.
const Mechanism kNone("none", {Link()}, {});

std::int64_t stampAt(double t) {
  return std::llround(t * 1e9);
}

// Errors over the deviations that were said of them.
class Ratios {
 public:
  explicit Ratios(Eigen::Index count) : squares_(Eigen::VectorXd::Zero(count)), inside_(squares_) {}

  template <typename Error, typename Covariance>
  void add(const Error& error, const Covariance& covariance) {
    for (Eigen::Index i = 0; i < squares_.size(); ++i) {
      const double ratio = error[i] / std::sqrt(covariance(i, i));
      ASSERT_TRUE(std::isfinite(ratio)) << i;
      squares_[i] += ratio * ratio;
      if (std::abs(ratio) <= 2) inside_[i] += 1;
    }
    ++count_;
  }
  /// Deviations hold: over all numbers the errors are of their size, and nine of ten within two of
  /// them; nearly so for each by itself, as the estimator learns while the motion changes.
  void expectToHold(const std::string& what) const {
    ASSERT_GT(count_, 500);
    const double rms = std::sqrt(squares_.mean() / count_);
    EXPECT_GT(rms, 0.7) << what;
    EXPECT_LT(rms, 1.3) << what;
    EXPECT_GT(inside_.mean() / count_, 0.9) << what;
    for (Eigen::Index i = 0; i < squares_.size(); ++i) {
      EXPECT_GT(std::sqrt(squares_[i] / count_), 0.5) << what << " " << i;
      EXPECT_GT(inside_[i] / count_, 0.85) << what << " " << i;
    }
  }

 private:
  Eigen::VectorXd squares_, inside_;
  int count_ = 0;
};

Eigen::Vector3d drawn(std::mt19937& generator, double size) {
  std::normal_distribution<double> normal;
  const double x = size * normal(generator), y = size * normal(generator);
  return {x, y, size * normal(generator)};
}

Eigen::Quaterniond turnedBy(const Eigen::Quaterniond& orientation, const Eigen::Vector3d& turn) {
  return orientation * Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()));
}

// As RootCovariance has them.
Eigen::Matrix<double, 12, 1> errorOf(const RootMotion& found, const RootMotion& truth) {
  Eigen::Quaterniond turn = truth.orientation.conjugate() * found.orientation;
  if (turn.w() < 0) turn.coeffs() *= -1;
  Eigen::Matrix<double, 12, 1> error;
  error << 2 * turn.vec(), found.angular_velocity - truth.angular_velocity,
      found.angular_acceleration - truth.angular_acceleration,
      found.acceleration - truth.acceleration;
  return error;
}

Ratios followPoses(const Eigen::Vector3d& start, double rate, double noise, double twist_noise) {
  const TumblingRoot root{start, 0.6};
  RootEstimator estimator(EstimatorSettings(), kTimeout);
  std::mt19937 generator(4);
  Ratios ratios(12);
  for (int i = 0; i < 20 * rate; ++i) {
    const double t = i / rate;
    const RootMotion truth = root.at(t);
    RootPose pose;
    pose.stamp_ns = stampAt(t);
    pose.position = truth.position + drawn(generator, noise);
    pose.orientation = turnedBy(truth.orientation, drawn(generator, noise));
    if (twist_noise > 0) {
      pose.velocity = truth.velocity + drawn(generator, twist_noise);
      pose.angular_velocity = truth.angular_velocity + drawn(generator, twist_noise);
    }
    estimator.push(pose);
    if (t < 3 || i % 3 != 0) continue;
    RootMotion found;
    RootCovariance covariance;
    EXPECT_TRUE(estimator.read(stampAt(t - kLag), found, &covariance));
    ratios.add(errorOf(found, root.at(t - kLag)), covariance);
  }
  return ratios;
}

TEST(RootCovariances, PosesHoldAtEveryAttitude) {
  for (const Eigen::Vector3d& start :
       {Eigen::Vector3d(0.4, 0.2, -0.3), Eigen::Vector3d(2, -1.1, 0.5)}) {
    followPoses(start, 200, 1e-4, 0).expectToHold("poses");
    followPoses(start, 100, 1e-3, 0).expectToHold("rough poses");
    followPoses(start, 200, 1e-4, 2e-3).expectToHold("poses with twists");
  }
}

// @param at of the unit, from the root's origin
Ratios followImu(const Eigen::Vector3d& at) {
  const TumblingRoot root{{0.4, 0.2, -0.3}, 0.6};
  RootImu imu(EstimatorSettings(), kTimeout, kGravity);
  std::mt19937 generator(9);
  Ratios ratios(9);
  for (int i = 0; i < 20 * 200; ++i) {
    const double t = i / 200.0;
    const RootMotion truth = root.at(t);
    const Eigen::Quaterniond back = truth.orientation.conjugate();
    const Eigen::Vector3d lever = truth.orientation * at;
    ImuSample sample;
    sample.stamp_ns = stampAt(t);
    sample.at = at;
    sample.angular_velocity = back * truth.angular_velocity + drawn(generator, 2e-3);
    sample.specific_force =
        back * (truth.acceleration + truth.angular_acceleration.cross(lever) +
                truth.angular_velocity.cross(truth.angular_velocity.cross(lever)) - kGravity) +
        drawn(generator, 0.02);
    imu.push(sample);
    if (t < 3 || i % 3 != 0) continue;
    RootMotion found;
    RootCovariance covariance;
    EXPECT_TRUE(imu.read(stampAt(t - kLag), found, &covariance));
    EXPECT_TRUE(covariance.topRows<3>().isZero(0));
    const RootState truth_state(root.at(t - kLag), kGravity, false);
    Eigen::Matrix<double, 9, 1> error;
    error << found.angular_velocity - truth_state.angular_velocity,
        found.angular_acceleration - truth_state.angular_acceleration,
        found.acceleration - kGravity - truth_state.acceleration;
    ratios.add(error, covariance.bottomRightCorner<9, 9>().eval());
  }
  return ratios;
}

// Far from the origin the angular acceleration makes the most of the acceleration's deviation.
TEST(RootCovariances, AnImusHoldInTheRootsAxes) {
  followImu({0.4, -0.3, 0.2}).expectToHold("imu");
  followImu({4, -3, 2}).expectToHold("imu far from the origin");
}

// Correlations, too: by draws of the quaternion's numbers about a motion.
TEST(RootCovariances, AreThoseOfDrawnQuaternions) {
  const RootMotion motion = TumblingRoot().at(0.7);
  const RootCoordinates exact = coordinatesOf(motion);
  const Eigen::Vector4d q = exact.col(0).tail<4>();
  const Eigen::Matrix4d tangent = Eigen::Matrix4d::Identity() - q * q.transpose();
  Eigen::Matrix3d C;
  C << 1e-8, 2e-8, -3e-8, 2e-8, 1e-6, 1e-6, -3e-8, 1e-6, 1e-4;
  const Eigen::Matrix3d factor = C.llt().matrixL();
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  TurnCovariance sum = TurnCovariance::Zero();
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    // Small turns x about all axes alike, with derivatives: q + x q / 2.
    Eigen::Matrix3d x;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = normal(generator), b = normal(generator), c = normal(generator);
      x.row(axis) = (factor * Eigen::Vector3d(a, b, c)).transpose();
    }
    RootCoordinates off = exact;
    for (int level = 0; level < 3; ++level) {
      const Eigen::Vector3d turn = x.col(level);
      off.col(level).tail<4>() +=
          (Eigen::Quaterniond(0, turn.x(), turn.y(), turn.z()) * Eigen::Quaterniond(q)).coeffs() /
          2;
    }
    const Eigen::Matrix<double, 9, 1> error = errorOf(rootMotionOf(off), motion).head<9>();
    sum += error * error.transpose() / kDraws;
  }
  RootCoordinateCovariances each;
  each.fill(Eigen::Matrix3d::Zero());
  // A quarter each of what the four numbers have together: x / 2 in three directions.
  for (std::size_t i = 3; i < 7; ++i) each[i] = C * (3.0 / 16);
  EXPECT_NEAR(tangent.trace(), 3, 1e-12);
  const TurnCovariance found = turnCovarianceOf(motion, each);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const double scale = std::sqrt(found(i, i) * found(j, j));
      EXPECT_NEAR(sum(i, j), found(i, j), 6 / std::sqrt(double(kDraws)) * scale + 1e-12)
          << i << " " << j;
    }
  }
  // In body axes, by differences of the turn itself.
  FreeTurn turn{motion.orientation, motion.orientation.conjugate() * motion.angular_velocity,
                motion.orientation.conjugate() * motion.angular_acceleration};
  TurnCovariance bodies = TurnCovariance::Zero();
  const Eigen::Matrix<double, 9, 9> L = found.llt().matrixL();
  for (int i = 0; i < kDraws; ++i) {
    Eigen::Matrix<double, 9, 1> numbers;
    for (int c = 0; c < 9; ++c) numbers[c] = normal(generator);
    numbers = L * numbers;
    const Eigen::Quaterniond off = turnedBy(motion.orientation, numbers.head<3>());
    Eigen::Matrix<double, 9, 1> error;
    error << numbers.head<3>(),
        off.conjugate() * (motion.angular_velocity + numbers.segment<3>(3)) - turn.angular_velocity,
        off.conjugate() * (motion.angular_acceleration + numbers.tail<3>()) -
            turn.angular_acceleration;
    bodies += error * error.transpose() / kDraws;
  }
  const TurnCovariance in_body = inBodyAxes(turn, found);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const double scale = std::sqrt(in_body(i, i) * in_body(j, j));
      EXPECT_NEAR(bodies(i, j), in_body(i, j), 6 / std::sqrt(double(kDraws)) * scale + 1e-12)
          << i << " " << j;
    }
  }
}

MotionTable recording(double noise, const std::vector<std::string>& lacks) {
  const TumblingRoot root{{0.4, 0.2, -0.3}, 0.6};
  std::mt19937 generator(3);
  MotionTable table;
  for (int i = 0; i < 1500; ++i) {
    table.times.push_back(i / 200.0);
    RootMotion motion = root.at(table.times.back());
    motion.position += drawn(generator, noise);
    motion.orientation = turnedBy(motion.orientation, drawn(generator, noise));
    table.roots.push_back(motion);
  }
  table.roots_lack = lacks;
  return table;
}

TEST(RootCovariances, RecordingsHold) {
  const TumblingRoot root{{0.4, 0.2, -0.3}, 0.6};
  MotionTable table =
      recording(1e-4, {"velocity", "angular_velocity", "acceleration", "angular_acceleration"});
  CompletionSettings settings;
  completeRoots(kNone, table, settings);
  EXPECT_TRUE(table.root_covariances.empty());
  table = recording(1e-4, {"velocity", "angular_velocity", "acceleration", "angular_acceleration"});
  settings.covariances = true;
  completeRoots(kNone, table, settings);
  ASSERT_EQ(table.root_covariances.size(), table.times.size());
  Ratios ratios(12);
  for (std::size_t row = 100; row < 1400; ++row)
    ratios.add(errorOf(table.roots[row], root.at(table.times[row])), table.root_covariances[row]);
  ratios.expectToHold("recording");
}

TEST(RootCovariances, WhatIsGivenIsExact) {
  MotionTable table = recording(0, {"angular_velocity"});
  CompletionSettings settings;
  settings.covariances = true;
  completeRoots(kNone, table, settings);
  ASSERT_EQ(table.root_covariances.size(), table.times.size());
  const RootCovariance& covariance = table.root_covariances[700];
  EXPECT_GT(covariance(4, 4), 0);
  for (const Eigen::Index i : {0, 1, 2, 6, 7, 8, 9, 10, 11}) {
    EXPECT_TRUE(covariance.row(i).isZero(0)) << i;
    EXPECT_TRUE(covariance.col(i).isZero(0)) << i;
  }
  RootTrajectory trajectory(kTimeout);
  trajectory.take({{0, table.roots[0]}, {5000000, table.roots[1]}});
  RootMotion found;
  RootCovariance exact = RootCovariance::Constant(3);
  ASSERT_TRUE(trajectory.read(2000000, found, &exact));
  EXPECT_TRUE(exact.isZero(0));
}

TEST(RootCovariances, TurnsOfRecordingsHoldInTheirOwnAxes) {
  const MotionTable table = recording(1e-4, {});
  const TumblingRoot root{{0.4, 0.2, -0.3}, 0.6};
  FreeTurns turns;
  turns.joint = "ball";
  turns.lack = {"angular_velocity", "angular_acceleration"};
  for (const RootMotion& motion : table.roots) {
    turns.rows.emplace_back();
    turns.rows.back().orientation = motion.orientation;
  }
  CompletionSettings settings;
  settings.covariances = true;
  estimateFreeTurns(kNone, table, settings, turns);
  ASSERT_EQ(turns.covariances.size(), turns.rows.size());
  Ratios ratios(9);
  for (std::size_t row = 100; row < 1400; ++row) {
    const RootMotion truth = root.at(table.times[row]);
    const FreeTurn& found = turns.rows[row];
    Eigen::Quaterniond turn = truth.orientation.conjugate() * found.orientation;
    if (turn.w() < 0) turn.coeffs() *= -1;
    Eigen::Matrix<double, 9, 1> error;
    error << 2 * turn.vec(),
        found.angular_velocity - truth.orientation.conjugate() * truth.angular_velocity,
        found.angular_acceleration - truth.orientation.conjugate() * truth.angular_acceleration;
    ratios.add(error, turns.covariances[row]);
  }
  ratios.expectToHold("turns");
}

}  // namespace
}  // namespace virtual_work_dynamics
