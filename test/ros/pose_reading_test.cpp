#include "ros/pose_reading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "allocation_guard.h"

namespace virtual_work_dynamics {
namespace {

TEST(PoseReading, TwistsThatAreNeverFiniteAreToldOfOnceWithoutAllocatingLater) {
  PoseReading reading;
  geometry_msgs::Twist twist;
  twist.linear.x = std::numeric_limits<double>::quiet_NaN();
  twist.angular.y = 2;
  Eigen::Vector3d linear, angular;
  reading.takeTwist(twist, linear, angular);
  EXPECT_TRUE(reading.twistLeftOut());
  EXPECT_TRUE(linear.array().isNaN().all());
  EXPECT_EQ(angular, Eigen::Vector3d(0, 2, 0));
  const std::string doubt = reading.takeDoubt();
  EXPECT_NE(doubt.find("twist.linear.x is nan: poses count"), std::string::npos) << doubt;
  {
    const AllocationGuard guard;
    reading.takeTwist(twist, linear, angular);
    EXPECT_EQ(guard.allocations(), 0U);
  }
  EXPECT_TRUE(reading.twistLeftOut());
  EXPECT_TRUE(linear.array().isNaN().all());
  EXPECT_EQ(reading.takeDoubt(), "");
}

}  // namespace
}  // namespace virtual_work_dynamics
