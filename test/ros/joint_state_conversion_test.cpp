#include "ros/joint_state_conversion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kWheel[] = R"(<robot name="wheel"><link name="stand"/><link name="disc"/>
  <joint name="axle" type="continuous"><parent link="stand"/><child link="disc"/>
    <axis xyz="0 0 1"/></joint></robot>)";

sensor_msgs::JointState message(double position, double velocity) {
  sensor_msgs::JointState state;
  state.header.stamp.fromSec(1);
  state.name = {"axle"};
  state.position = {position};
  state.velocity = {velocity};
  return state;
}

// A driver's number that no robot reaches would leave noises and results that are not numbers.
TEST(JointStateConversion, PositionsBeyondAnyRobotAreDroppedByName) {
  const Mechanism robot = readUrdf(kWheel);
  JointStateConversion conversion(robot);
  JointSample sample;
  EXPECT_FALSE(conversion.convert(message(1e99, 0), sample));
  for (const double position : {1e101, -1e300}) {
    const auto rejection = conversion.convert(message(position, 0), sample);
    ASSERT_TRUE(rejection);
    EXPECT_EQ(rejection->reason, DropReason::kNotFinite);
    EXPECT_EQ(rejection->text.rfind("the position of 'axle' is ", 0), 0u) << rejection->text;
  }
}

TEST(JointStateConversion, VelocitiesBeyondAnyRobotAreNotUsed) {
  const Mechanism robot = readUrdf(kWheel);
  JointStateConversion conversion(robot);
  JointSample sample;
  ASSERT_FALSE(conversion.convert(message(0, 1e300), sample));
  EXPECT_TRUE(sample.velocity_not_finite);
  EXPECT_TRUE(std::isnan(sample.qd[0]));
  EXPECT_EQ(sample.velocity_problem, "the velocity of 'axle' is 1e+300");
}

}  // namespace
}  // namespace virtual_work_dynamics
