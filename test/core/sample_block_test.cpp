#include "tree/sample_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "plain_results.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/block.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

MotionTable tableOf(RobotBuilder& builder, int rows, int columns) {
  MotionTable table;
  table.times.resize(static_cast<std::size_t>(rows));
  for (Eigen::MatrixXd* values : {&table.positions, &table.velocities, &table.accelerations}) {
    values->resize(rows, columns);
    for (Eigen::Index i = 0; i < values->size(); ++i) values->data()[i] = builder.uniform(-2, 2);
  }
  return table;
}

template <typename Call>
std::string messageOf(const Call& call) {
  try {
    call();
  } catch (const MotionError& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(SampleBlock, IsComputeRowByRow) {
  RobotBuilder builder = chainOf(4);
  const Mechanism mechanism = builder.build();
  const MotionTable table = tableOf(builder, 23, 4);
  Request request = requestAll(mechanism);
  request.poses = request.twists = true;
  const InverseDynamics dynamics(mechanism, Scene(), request);
  Workspace expected = dynamics.makeWorkspace(), read = dynamics.makeWorkspace();
  for (const int threads : {1, 2}) {
    SampleBlock block(dynamics, 10, threads);
    for (std::size_t first = 0; first < 23; first += 10) {
      const std::size_t count = std::min<std::size_t>(10, 23 - first);
      block.compute(table, first, count);
      for (std::size_t i = 0; i < count; ++i) {
        const auto row = static_cast<Eigen::Index>(first + i);
        Motion motion;
        motion.q = table.positions.row(row);
        motion.qd = table.velocities.row(row);
        motion.qdd = table.accelerations.row(row);
        dynamics.compute(motion, expected);
        block.read(i, read);
        EXPECT_EQ(read.effort(), expected.effort());
        for (std::size_t k = 0; k < 4; ++k) {
          EXPECT_EQ(read.childAxes()[k].force, expected.childAxes()[k].force);
          EXPECT_EQ(read.childAxes()[k].torque, expected.childAxes()[k].torque);
          EXPECT_EQ(read.rootAxes()[k].force, expected.rootAxes()[k].force);
          EXPECT_EQ(read.rootAxes()[k].torque, expected.rootAxes()[k].torque);
          EXPECT_EQ(read.poses()[k].position, expected.poses()[k].position);
          EXPECT_EQ(read.poses()[k].orientation.coeffs(), expected.poses()[k].orientation.coeffs());
          EXPECT_EQ(read.twists()[k].linear, expected.twists()[k].linear);
          EXPECT_EQ(read.twists()[k].angular, expected.twists()[k].angular);
        }
      }
    }
  }
}

TEST(SampleBlock, RefusesWhatDoesNotFit) {
  RobotBuilder builder = chainOf(2);
  const Mechanism mechanism = builder.build();
  const InverseDynamics dynamics(mechanism, Scene()), other(mechanism, Scene());
  const MotionTable table = tableOf(builder, 5, 2), narrow = tableOf(builder, 5, 1);
  SampleBlock block(dynamics, 4);
  Workspace workspace = dynamics.makeWorkspace(), foreign = other.makeWorkspace();
  EXPECT_EQ(messageOf([&] { block.compute(table, 0, 5); }),
            "block: 5 rows are more than its capacity, 4");
  EXPECT_EQ(messageOf([&] { block.compute(table, 3, 3); }),
            "motion: positions are 5 x 2, needed are 6 x 2");
  EXPECT_EQ(messageOf([&] { block.compute(narrow, 0, 4); }),
            "motion: positions are 5 x 1, needed are 4 x 2");
  EXPECT_EQ(messageOf([&] { block.read(0, workspace); }), "block: there is no sample 0, it has 0");
  block.compute(table, 0, 3);
  EXPECT_EQ(messageOf([&] { block.read(3, workspace); }), "block: there is no sample 3, it has 3");
  EXPECT_EQ(messageOf([&] { block.read(0, foreign); }),
            "the workspace belongs to another InverseDynamics");
  EXPECT_THROW(SampleBlock(dynamics, 4, 0), Error);
}

// The pose of a revolute joint at -0 shows the sign of its sine.
TEST(SampleBlock, KeepsTheSignOfAZeroAngle) {
  RobotBuilder builder(9);
  builder.add(JointType::kRevolute, 0, Vector3l::UnitZ(), Matrix3l::Identity(), Vector3l::Zero());
  const Mechanism mechanism = builder.build();
  Request request;
  request.efforts = false;
  request.root_axes = {"joint_1"};
  request.poses = true;
  const InverseDynamics dynamics(mechanism, Scene(), request);
  Workspace one = dynamics.makeWorkspace(), read = dynamics.makeWorkspace();
  MotionTable table = tableOf(builder, 1, 1);
  table.positions(0, 0) = -0.0;
  Motion motion(1);
  motion.q[0] = -0.0;
  motion.qd = table.velocities.row(0);
  motion.qdd = table.accelerations.row(0);
  dynamics.compute(motion, one);
  SampleBlock block(dynamics, 1);
  block.compute(table, 0, 1);
  block.read(0, read);
  EXPECT_EQ(std::signbit(one.poses()[0].orientation.z()),
            std::signbit(read.poses()[0].orientation.z()));
}

}  // namespace
}  // namespace virtual_work_dynamics
