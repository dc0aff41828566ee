#include "virtual_work_dynamics/motion_completion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kPi = 3.14159265358979323846;

// A cubic is what the filters start from, so that only rounding is left, times the 1/dt^2 = 1e4 by
// which a second derivative magnifies it.
constexpr double kRounding = 1e-14;
constexpr double kPosition = 1e-12;
constexpr double kVelocity = 1e-11;
constexpr double kAcceleration = 1e-9;

// A chain of two: "hinge" revolute, "wheel" continuous.
Mechanism twoJoints() {
  std::vector<Link> links(3);
  std::vector<Joint> joints(2);
  const std::array<JointType, 2> types{JointType::kRevolute, JointType::kContinuous};
  const std::array<const char*, 2> names{"hinge", "wheel"};
  for (int k = 0; k < 2; ++k) {
    joints[k].name = names[k];
    joints[k].type = types[k];
    joints[k].parent_link = k;
    joints[k].child_link = k + 1;
    joints[k].axis_K = Vector3l::UnitZ();
    joints[k].coordinate = k;
    links[k + 1].parent_joint = k;
  }
  return Mechanism("two", links, joints);
}

// Unevenly spaced times from 100 s on, about 10 ms apart.
std::vector<double> unevenTimes(int rows) {
  std::vector<double> times;
  for (int i = 0; i < rows; ++i) times.push_back(100 + 0.01 * i + 0.003 * std::sin(5.0 * i));
  return times;
}

struct Cubic {
  double position(double t) const { return 0.3 - 0.7 * t + 1.1 * t * t - 0.9 * t * t * t; }
  double velocity(double t) const { return -0.7 + 2.2 * t - 2.7 * t * t; }
  double acceleration(double t) const { return 2.2 - 5.4 * t; }
};

// Both joints move by the cubic of the time after the first row, the wheel at a multiple.
MotionTable cubicMotion(const std::vector<double>& times, double wheel_factor = 2) {
  const Cubic cubic;
  MotionTable table;
  table.joints = {"hinge", "wheel"};
  table.times = times;
  const auto rows = static_cast<Eigen::Index>(times.size());
  table.positions.resize(rows, 2);
  table.velocities.resize(rows, 2);
  table.accelerations.resize(rows, 2);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = times[static_cast<std::size_t>(i)] - times.front();
    table.positions.row(i) << cubic.position(t), wheel_factor * cubic.position(t);
    table.velocities.row(i) << cubic.velocity(t), wheel_factor * cubic.velocity(t);
    table.accelerations.row(i) << cubic.acceleration(t), wheel_factor * cubic.acceleration(t);
  }
  return table;
}

MotionTable without(MotionTable table, bool velocities, bool accelerations) {
  if (velocities) table.velocities.resize(0, 0);
  if (accelerations) table.accelerations.resize(0, 0);
  return table;
}

void expectNear(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected, double tolerance) {
  ASSERT_EQ(actual.rows(), expected.rows());
  ASSERT_EQ(actual.cols(), expected.cols());
  ASSERT_TRUE(actual.allFinite());
  for (Eigen::Index column = 0; column < actual.cols(); ++column) {
    for (Eigen::Index row = 0; row < actual.rows(); ++row) {
      const double wanted = expected(row, column);
      EXPECT_LE(std::abs(actual(row, column) - wanted), tolerance * std::max(1.0, std::abs(wanted)))
          << "row " << row << ", column " << column;
    }
  }
}

std::string refusal(const MotionTable& motion) {
  try {
    completeMotion(twoJoints(), motion);
  } catch (const MotionError& error) {
    return error.what();
  }
  return "(not refused)";
}

TEST(MotionCompletion, FindsTheDerivativesOfACubicInEveryRow) {
  const MotionTable truth = cubicMotion(unevenTimes(40));
  const MotionTable completed = completeMotion(twoJoints(), without(truth, true, true));
  expectNear(completed.positions, truth.positions, kPosition);
  EXPECT_EQ(completed.times, truth.times);
  EXPECT_EQ(completed.joints, truth.joints);
  expectNear(completed.velocities, truth.velocities, kVelocity);
  expectNear(completed.accelerations, truth.accelerations, kAcceleration);
}

TEST(MotionCompletion, AJointThatStandsStillHasNoVelocity) {
  MotionTable given = without(cubicMotion(unevenTimes(40)), false, true);
  given.positions.col(0).setConstant(0.25);
  const MotionTable completed = completeMotion(twoJoints(), given);
  EXPECT_TRUE((completed.positions.col(0).array() == 0.25).all());
  EXPECT_TRUE(completed.velocities.col(0).isZero(0));
  EXPECT_TRUE(completed.accelerations.col(0).isZero(0));
  EXPECT_GT(completed.accelerations.col(1).cwiseAbs().minCoeff(), 0);
}

TEST(MotionCompletion, UsesVelocitiesForAccelerations) {
  const MotionTable truth = cubicMotion(unevenTimes(40));
  const MotionTable completed = completeMotion(twoJoints(), without(truth, false, true));
  expectNear(completed.accelerations, truth.accelerations, kAcceleration);
}

TEST(MotionCompletion, GivenAccelerationsAreKeptWhenVelocitiesAreMissing) {
  MotionTable given = without(cubicMotion(unevenTimes(12)), true, false);
  const Eigen::MatrixXd velocities = cubicMotion(unevenTimes(12)).velocities;
  given.accelerations.setConstant(7);
  const MotionTable completed = completeMotion(twoJoints(), given);
  EXPECT_EQ(completed.accelerations, given.accelerations);
  EXPECT_EQ(completed.positions, given.positions);
  expectNear(completed.velocities, velocities, kVelocity);
}

TEST(MotionCompletion, NothingIsDoneToACompleteMotion) {
  MotionTable given = cubicMotion(unevenTimes(5));
  given.times[2] = given.times[1];  // nobody asks for derivatives, so times may stand still
  const MotionTable completed = completeMotion(twoJoints(), given);
  EXPECT_EQ(completed.velocities, given.velocities);
  EXPECT_EQ(completed.accelerations, given.accelerations);
}

// A lag would show here: the third derivative of a sine turns.
TEST(MotionCompletion, ASineHasNoLag) {
  MotionTable motion;
  motion.joints = {"hinge"};
  constexpr int kRows = 400;
  constexpr double kStep = 0.01;
  motion.positions.resize(kRows, 1);
  for (int i = 0; i < kRows; ++i) {
    motion.times.push_back(kStep * i);
    motion.positions(i, 0) = std::sin(2 * kStep * i);
  }
  const MotionTable completed = completeMotion(twoJoints(), motion);
  // One sample of lag would err by dt 2^3 = 0.08.
  constexpr double kTruncation = 0.004;
  for (int i = 4; i + 4 < kRows; ++i) {
    EXPECT_NEAR(completed.velocities(i, 0), 2 * std::cos(2 * motion.times[i]), kTruncation);
    EXPECT_NEAR(completed.accelerations(i, 0), -4 * std::sin(2 * motion.times[i]), kTruncation);
  }
}

// Zero phase: a motion played backwards has the same estimates, played backwards.
TEST(MotionCompletion, PlayedBackwardsAMotionHasTheSameAccelerations) {
  MotionTable forward;
  MotionTable backward;
  forward.joints = backward.joints = {"hinge"};
  forward.times = unevenTimes(120);
  forward.positions.resize(120, 1);
  for (int i = 0; i < 120; ++i) {
    forward.positions(i, 0) = std::sin(40 * (forward.times[static_cast<std::size_t>(i)] - 100));
    backward.times.push_back(-forward.times[static_cast<std::size_t>(119 - i)]);
  }
  backward.positions = forward.positions.colwise().reverse();
  // With one model: what is found from rows after the first few depends on which these are.
  CompletionSettings settings;
  settings.noise.position_noise = 1e-6;
  settings.noise.stamp_noise = 0;
  settings.noise.bandwidth = 20;
  const MotionTable one = completeMotion(twoJoints(), forward, settings);
  const MotionTable other = completeMotion(twoJoints(), backward, settings);
  // Near an end it counts whether the filter was started there. Covariances fall by 1e10 from the
  // start on, which costs estimates their last digits.
  constexpr double kDigits = 1e-9;
  const auto inside = [](const Eigen::MatrixXd& rows) { return rows.middleRows(40, 40); };
  expectNear(inside(other.velocities.colwise().reverse()), -inside(one.velocities), kDigits);
  expectNear(inside(other.accelerations.colwise().reverse()), inside(one.accelerations), kDigits);
}

TEST(MotionCompletion, ContinuousJointsMayWrap) {
  const MotionTable truth = cubicMotion(unevenTimes(60), 40);
  MotionTable wrapped = without(truth, true, true);
  for (Eigen::Index i = 0; i < wrapped.positions.rows(); ++i) {
    wrapped.positions(i, 1) = std::remainder(wrapped.positions(i, 1), 2 * kPi);
  }
  ASSERT_GT((wrapped.positions - truth.positions).cwiseAbs().maxCoeff(), 6);
  const MotionTable completed = completeMotion(twoJoints(), wrapped);
  // Positions are the unwrapped ones from then on.
  const Eigen::MatrixXd turned = (completed.positions - truth.positions) / (2 * kPi);
  EXPECT_LT((turned.array() - std::round(turned(0, 1)) * Eigen::ArrayXXd::Ones(60, 2))
                .col(1)
                .abs()
                .maxCoeff(),
            1e-5);
  // The wheel's positions are 40 times larger, and so is their rounding.
  expectNear(completed.velocities, truth.velocities, 40 * kVelocity);
  expectNear(completed.accelerations, truth.accelerations, 40 * kAcceleration);
}

TEST(MotionCompletion, PositionsOfACompleteMotionAreUnwrapped) {
  MotionTable motion = cubicMotion(unevenTimes(9));
  motion.positions.col(1).tail(4).array() -= 2 * kPi;
  const MotionTable completed = completeMotion(twoJoints(), motion);
  expectNear(completed.positions, cubicMotion(unevenTimes(9)).positions, kRounding);
  EXPECT_EQ(completed.velocities, motion.velocities);
}

TEST(MotionCompletion, RevoluteJointsMayGoTheLongerWay) {
  MotionTable motion = without(cubicMotion(unevenTimes(9)), true, true);
  // More than half a turn, not so suddenly that no motion would make it.
  motion.positions.col(0).tail(4).array() += 4;
  motion.positions(5, 0) -= 2.6;
  motion.positions(4, 0) += 0.6;
  const MotionTable completed = completeMotion(twoJoints(), motion);
  EXPECT_GT(completed.velocities.col(0).maxCoeff(), 10);
}

TEST(MotionCompletion, TellsHowFarItIs) {
  std::vector<double> even;
  for (int i = 0; i < 40; ++i) even.push_back(0.01 * i);
  for (const std::vector<double>& times : {even, unevenTimes(40)}) {
    CompletionSettings settings;
    std::vector<std::size_t> steps;
    std::size_t of = 0;
    settings.progress = [&](std::size_t done, std::size_t total) {
      steps.push_back(done);
      of = total;
    };
    completeMotion(twoJoints(), without(cubicMotion(times), true, true), settings);
    EXPECT_GE(steps.size(), 6u);
    EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
    EXPECT_EQ(steps.back(), of);
  }
}

TEST(MotionCompletion, ShortTablesAreFittedWithWhatTheyHave) {
  for (const int rows : {4, 5, 8, 9, 10}) {
    const MotionTable truth = cubicMotion(unevenTimes(rows));
    const MotionTable completed = completeMotion(twoJoints(), without(truth, true, true));
    expectNear(completed.accelerations, truth.accelerations, kAcceleration);
  }
  MotionTable parabola;  // 1 - t + 3 t^2 through three rows
  parabola.joints = {"hinge"};
  parabola.times = {0, 0.5, 0.7};
  parabola.positions = Eigen::Vector3d(1, 1.25, 1.77);
  const MotionTable completed = completeMotion(twoJoints(), parabola);
  expectNear(completed.velocities, Eigen::Vector3d(-1, 2, 3.2), 10 * kVelocity);
  expectNear(completed.accelerations, Eigen::Vector3d(6, 6, 6), kAcceleration);
}

TEST(MotionCompletion, RefusesTooFewRows) {
  EXPECT_EQ(refusal(without(cubicMotion(unevenTimes(1)), true, true)),
            "motion: accelerations are not given, and estimating them takes 3 rows or more, not 1");
  EXPECT_EQ(refusal(without(cubicMotion(unevenTimes(2)), false, true)),
            "motion: accelerations are not given, and estimating them takes 3 rows or more, not 2");
  EXPECT_EQ(refusal(without(cubicMotion(unevenTimes(1)), true, false)),
            "motion: velocities are not given, and estimating them takes 2 rows or more, not 1");
}

TEST(MotionCompletion, RefusesTimesThatDoNotIncrease) {
  MotionTable motion = without(cubicMotion(unevenTimes(12)), true, true);
  motion.times[7] = motion.times[6];
  EXPECT_EQ(refusal(motion), "motion: the time of row 8 is not later than that of the row before");
  motion.times[4] = motion.times[3] - 1;
  EXPECT_EQ(refusal(motion), "motion: the time of row 5 is not later than that of the row before");
  EXPECT_EQ(firstTimeThatDoesNotIncrease({0, 1, 2}), 3u);
}

TEST(MotionCompletion, RefusesValuesWhoseSquaresOverflow) {
  MotionTable motion = without(cubicMotion(unevenTimes(12)), true, true);
  motion.positions(2, 0) = 3.1e307;
  EXPECT_EQ(
      refusal(motion).rfind(
          "motion: the position of '" + motion.joints[0] + "' in row 3 is 3.1e+307, too large", 0),
      0u)
      << refusal(motion);
  motion.positions(2, 0) = 1e99;
  EXPECT_EQ(refusal(motion), "(not refused)");
  motion.times[11] = 1e300;
  EXPECT_EQ(refusal(motion),
            "motion: the time of row 12 is 1e+300, too large to estimate anything from");
}

TEST(MotionCompletion, RefusesTablesThatDoNotFitTheRobot) {
  MotionTable motion = without(cubicMotion(unevenTimes(12)), true, true);
  motion.joints[1] = "whel";
  EXPECT_EQ(refusal(motion),
            "motion: 'whel' is not a generalized coordinate of the robot; did you mean 'wheel'?");
  motion = without(cubicMotion(unevenTimes(12)), true, true);
  motion.velocities = Eigen::MatrixXd::Zero(11, 2);
  EXPECT_EQ(refusal(motion), "motion: velocities are 11 x 2, expected 12 rows x 2 joints");
}

// Six seconds from rest to rest and a swing, in numbers of `resolution`.
CompletionReport reportOfSlowMotion(double resolution) {
  MotionTable motion;
  motion.joints = {"hinge", "wheel"};
  motion.positions.resize(601, 2);
  for (int i = 0; i <= 600; ++i) {
    const double t = 0.01 * i, s = t / 6;
    motion.times.push_back(t);
    motion.positions.row(i) << 0.9 * s * s * s * (10 - 15 * s + 6 * s * s), 0.8 * std::sin(kPi * t);
    for (Eigen::Index k = 0; k < 2; ++k)
      motion.positions(i, k) = resolution * std::round(motion.positions(i, k) / resolution);
  }
  CompletionReport report;
  completeMotion(twoJoints(), motion, {}, &report);
  return report;
}

// A smoother reaches farther than the whole of a motion that is so smooth and exact, but what it
// finds is as good nearly everywhere; where numbers are rough, a second at either end is not.
TEST(MotionCompletion, OneSidedRowsAreThoseThatAreLessExact) {
  const std::pair<double, std::size_t> kMost[] = {{1e-6, 20}, {1e-3, 220}};
  for (const auto& [resolution, most] : kMost) {
    const CompletionReport report = reportOfSlowMotion(resolution);
    EXPECT_LT(report.one_sided, most) << resolution;
    const std::vector<bool>& rows = report.one_sided_rows;
    ASSERT_EQ(rows.size(), 601U);
    EXPECT_EQ(static_cast<std::size_t>(std::count(rows.begin(), rows.end(), true)),
              report.one_sided);
    EXPECT_FALSE(rows[300]) << resolution;
    EXPECT_TRUE(rows[0] && rows[600]) << resolution;
  }
}

// A noisy swing in pieces of so many rows, with pauses.
CompletionReport reportOfBursts(int rows, int pieces) {
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0, 1e-4);
  MotionTable motion;
  motion.joints = {"hinge"};
  motion.positions.resize(static_cast<Eigen::Index>(rows) * pieces, 1);
  for (int i = 0; i < rows * pieces; ++i) {
    const double t = 3 * (i / rows) + 0.01 * (i % rows);
    motion.times.push_back(t);
    motion.positions(i, 0) = 0.3 * std::sin(2 * t) + noise(generator);
  }
  CompletionReport report;
  completeMotion(twoJoints(), motion, {}, &report);
  return report;
}

// Where nearly all rows are near an end, that in the middle is no better, and tells nothing.
TEST(MotionCompletion, OneSidedRowsMayBeNearlyAll) {
  const std::pair<int, int> kBurstsOfRows[] = {{8, 62}, {20, 25}, {40, 12}, {30, 1}};
  for (const auto& [rows, pieces] : kBurstsOfRows) {
    const CompletionReport report = reportOfBursts(rows, pieces);
    const auto all = static_cast<std::size_t>(rows * pieces);
    EXPECT_GT(report.one_sided, all * 9 / 10) << rows;
    EXPECT_EQ(report.one_sided_rows.size(), all);
  }
  const CompletionReport whole = reportOfBursts(500, 1);
  EXPECT_LT(whole.one_sided, 100U);
  EXPECT_FALSE(whole.one_sided_rows[250]);
  // With more than half of the rows inside, those in the middle are the measure.
  const CompletionReport longer = reportOfBursts(80, 6);
  EXPECT_GT(longer.one_sided, 40U);
  EXPECT_LT(longer.one_sided, 150U);
}

// Powers of such times overflow.
TEST(MotionCompletion, TimesThatAreAgesApartAreRefused) {
  MotionTable motion;
  motion.joints = {"hinge"};
  motion.times = {0, 0.5, 5.5e16};
  motion.positions.resize(3, 1);
  motion.positions << 3.1, -2.1, -3;
  try {
    completeMotion(twoJoints(), motion);
    ADD_FAILURE() << "completed";
  } catch (const MotionError& error) {
    EXPECT_STREQ(error.what(),
                 "motion: what is estimated in row 1 is not finite; times reach from 0 to "
                 "5.5e+16 s");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
