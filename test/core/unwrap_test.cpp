#include "virtual_work_dynamics/unwrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

using Source = TurnCounter::Source;

const double kPi = std::acos(-1.0);
constexpr double kMillisecond = 1e-3;
// Wrapping and unwrapping round once each, at up to some hundred rad.
constexpr double kRounding = 1e-13;

Joint jointOf(JointType type, double lower = 0, double upper = 0) {
  Joint joint;
  joint.name = "joint";
  joint.type = type;
  joint.lower = lower;
  joint.upper = upper;
  return joint;
}

const Joint kContinuousJoint = jointOf(JointType::kContinuous);
const Joint kRevoluteJoint = jointOf(JointType::kRevolute);

/// The positions without the turns that are left out of them.
std::vector<double> unwrapped(TurnCounter counter, const std::vector<double>& positions,
                              double spacing = kMillisecond) {
  std::vector<double> result;
  for (const double q : positions) result.push_back(q + 2 * kPi * counter.turns(q, spacing));
  return result;
}

/// Samples of a motion, every 10 ms for 20 s.
std::vector<double> samples(const std::function<double(double)>& motion) {
  std::vector<double> positions;
  for (int i = 0; i <= 2000; ++i) positions.push_back(motion(0.01 * i));
  return positions;
}

/// As a driver reports positions that wraps them into -pi..pi, or into 0..2 pi.
std::vector<double> wrapped(std::vector<double> positions, bool into_positive = false) {
  for (double& q : positions) {
    q = std::remainder(q, 2 * kPi);
    if (into_positive && q < 0) q += 2 * kPi;
  }
  return positions;
}

void expectNear(const std::vector<double>& actual, const std::vector<double>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_NEAR(actual[i], expected[i], kRounding) << "position " << i;
  }
}

// --- what is unwrapped ------------------------------------------------------------------------

TEST(TurnCounter, ContinuousJointsGoTheShorterWay) {
  // Up to 3 rad from one sample to the next, forwards and backwards.
  const auto truth = samples([](double t) { return 50 * std::sin(6 * t); });
  const TurnCounter counter(kContinuousJoint);
  expectNear(unwrapped(counter, wrapped(truth)), truth);
  expectNear(unwrapped(counter, wrapped(truth, true)), truth);
}

TEST(TurnCounter, SeveralTurnsAtOnceAreTakenBack) {
  const std::vector<double> jumps{0.1, 0.2 + 6 * kPi, 0.3, 0.4 - 40 * kPi};
  expectNear(unwrapped(TurnCounter(kContinuousJoint), jumps), {0.1, 0.2, 0.3, 0.4});
}

TEST(TurnCounter, RevoluteJointsWhoseDriverWraps) {
  const auto truth = samples([](double t) { return 1 + 4 * std::sin(2 * t); });
  for (const Joint& joint : {kRevoluteJoint, jointOf(JointType::kRevolute, -2 * kPi, 2 * kPi),
                             jointOf(JointType::kRevolute, -3, 5)}) {
    expectNear(unwrapped(TurnCounter(joint), wrapped(truth), 0.01), truth);
  }
  // The first position is as it came: 1 rad both times.
  expectNear(unwrapped(TurnCounter(kRevoluteJoint), wrapped(truth, true), 0.01), truth);
  expectNear(unwrapped(TurnCounter(), wrapped(truth), 0.01), truth);
}

TEST(TurnCounter, PointsOfATrajectoryThatWraps) {
  const std::vector<double> points{3.1, -3.1, -3.0168};
  const std::vector<double> truth{3.1, 2 * kPi - 3.1, 2 * kPi - 3.0168};
  for (const Joint& joint : {kContinuousJoint, kRevoluteJoint}) {
    expectNear(unwrapped(TurnCounter(joint, Source::kPoints), points, 0.1), truth);
  }
}

TEST(TurnCounter, TurnsAreCountedNotSummedUp) {
  TurnCounter counter(kContinuousJoint);
  const double positions[] = {-2.1, 0.0, 2.1};  // of every turn
  double turns = 0;
  for (int i = 0; i < 3000000; ++i) turns = counter.turns(positions[i % 3], kMillisecond);
  EXPECT_EQ(turns, 999999);
}

TEST(TurnCounter, RestartsWithAFirstPosition) {
  TurnCounter counter(kContinuousJoint);
  counter.turns(3, kMillisecond);
  EXPECT_EQ(counter.turns(-3, kMillisecond), 1);
  counter.restart();
  EXPECT_EQ(counter.turns(-3, kMillisecond), 0);
  EXPECT_EQ(counter.turns(3, kMillisecond), -1);
}

// --- what is not ------------------------------------------------------------------------------

void expectAsItCame(const TurnCounter& counter, const std::vector<double>& positions,
                    double spacing = kMillisecond) {
  EXPECT_EQ(unwrapped(counter, positions, spacing), positions);
}

TEST(TurnCounter, OtherJumpsOfRevoluteJointsStay) {
  const TurnCounter counter(kRevoluteJoint);
  expectAsItCame(counter, {-2, 2});             // two thirds of a turn
  expectAsItCame(counter, {0, 8});              // more than a turn and a quarter
  expectAsItCame(counter, {0, 4 * kPi});        // two turns
  expectAsItCame(counter, {-3, 3, -3}, 1);      // slow enough to be the motion
  expectAsItCame(counter, {-3, 3}, 0);          // no time between them
  expectAsItCame(counter, {-3, 3}, -1);         // time goes back
  expectAsItCame(counter, {0, 3, 6.5, 0.3});    // not within one turn
  expectAsItCame(counter, {2.5, -2.5}, 0.02);   // nor does a turn make it a motion
  expectAsItCame(counter, {-3, -3.5, 2.9, 3});  // not within one turn after the jump
}

TEST(TurnCounter, TurnsThatLeadOutOfTheLimitsStay) {
  expectAsItCame(TurnCounter(jointOf(JointType::kRevolute, -2.9, 2.9)), {2.85, -2.85, 2.85}, 0.05);
  const auto jump = [](double lower, double upper) {
    return unwrapped(TurnCounter(jointOf(JointType::kRevolute, lower, upper)), {2.85, -2.85},
                     0.05)[1];
  };
  EXPECT_EQ(jump(-3, 3.2), -2.85);
  EXPECT_EQ(jump(-3, 3.5), 2 * kPi - 2.85);
  const auto jump_down = [](double lower) {
    return unwrapped(TurnCounter(jointOf(JointType::kRevolute, lower, 3)), {-2.85, 2.85}, 0.05)[1];
  };
  EXPECT_EQ(jump_down(-3.2), 2.85);
  EXPECT_EQ(jump_down(-3.5), 2.85 - 2 * kPi);
  // Limits that are left already say nothing.
  EXPECT_EQ(jump(-3, 2.5), 2 * kPi - 2.85);
}

TEST(TurnCounter, PointsOfATrajectoryMayBeATurnApart) {
  const TurnCounter counter(kContinuousJoint, Source::kPoints);
  expectAsItCame(counter, {0, 2 * kPi, 2 * kPi, 0}, 10);
  expectAsItCame(counter, {0, 4}, 0.1);
  expectAsItCame(counter, {0, 4, 8, 12}, 1);
}

TEST(TurnCounter, JointsWithoutTurnsStay) {
  for (const JointType type : {JointType::kPrismatic, JointType::kFixed}) {
    expectAsItCame(TurnCounter(jointOf(type)), {3.1, -3.1, 3.1});
  }
}

TEST(TurnCounter, JumpsThatADoubleDoesNotResolveStay) {
  expectAsItCame(TurnCounter(kContinuousJoint), {0, 1e12, 1e300, -1e300});
  // Nor do they keep turns that were counted before.
  EXPECT_EQ(unwrapped(TurnCounter(kContinuousJoint), {3, -3, 1e12})[2], 1e12);
}

// --- tables -----------------------------------------------------------------------------------

/// A wheel, a slide that takes whole turns for metres, and a gear that the wheel drives.
Mechanism wheelAndSlide() {
  std::vector<Link> links(4);
  std::vector<Joint> joints(3);
  const JointType types[] = {JointType::kContinuous, JointType::kPrismatic, JointType::kContinuous};
  const char* names[] = {"wheel", "slide", "gear"};
  for (int k = 0; k < 3; ++k) {
    joints[k] = jointOf(types[k]);
    joints[k].name = names[k];
    joints[k].parent_link = k;
    joints[k].child_link = k + 1;
    joints[k].coordinate = k % 2;
    joints[k].mimics = k == 2;
    links[k + 1].parent_joint = k;
  }
  return Mechanism("wheel and slide", links, joints);
}

MotionTable jumpingTable() {
  MotionTable table;
  table.joints = {"slide", "gear", "wheel", "lamp"};
  table.times = {0, 0.01, 0.02};
  table.positions.resize(3, 4);
  table.positions << 3, 3, 3, 3, -3, -3, -3, -3, 3, 3, 3, 3;
  table.velocities = Eigen::MatrixXd::Constant(3, 4, 7);
  return table;
}

TEST(UnwrapPositions, TakesTheJointsOfTheMechanismByName) {
  const MotionTable given = jumpingTable();
  MotionTable table = given;
  unwrapPositions(wheelAndSlide(), table);
  for (const Eigen::Index column : {0, 1, 3}) {
    EXPECT_EQ(table.positions.col(column), given.positions.col(column)) << column;
  }
  EXPECT_EQ(table.positions.col(2), Eigen::Vector3d(3, 2 * kPi - 3, 3));
  EXPECT_EQ(table.velocities, given.velocities);
  EXPECT_EQ(table.times, given.times);
}

TEST(UnwrapPositions, WithoutADescriptionTakesWhatIsEvident) {
  MotionTable table = jumpingTable();
  unwrapPositions(table);
  EXPECT_EQ(table.positions.col(3), Eigen::Vector3d(3, 2 * kPi - 3, 3));
  table = jumpingTable();
  table.times = {0, 1, 2};
  unwrapPositions(table);
  EXPECT_EQ(table.positions, jumpingTable().positions);
}

TEST(UnwrapPositions, TakesTheTimesOfTheTable) {
  MotionTable table = jumpingTable();
  unwrapPositions(wheelAndSlide(), table, Source::kPoints);
  EXPECT_EQ(table.positions(1, 2), 2 * kPi - 3);
  table = jumpingTable();
  table.times = {0, 1, 2};
  unwrapPositions(wheelAndSlide(), table, Source::kPoints);
  EXPECT_EQ(table.positions, jumpingTable().positions);
}

TEST(UnwrapPositions, RefusesShapesThatDisagree) {
  MotionTable table = jumpingTable();
  table.times.pop_back();
  try {
    unwrapPositions(wheelAndSlide(), table);
    ADD_FAILURE() << "not refused";
  } catch (const MotionError& error) {
    EXPECT_STREQ(error.what(), "motion: positions are 3 x 4, expected 2 rows x 4 joints");
  }
  MotionTable none;
  unwrapPositions(none);
  EXPECT_EQ(none.positions.size(), 0);
}

}  // namespace
}  // namespace virtual_work_dynamics
