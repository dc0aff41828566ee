#include "ros/root_conversion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ros/root_frames.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kEps = 1e-15;

void setVector(geometry_msgs::Vector3& vector, double x, double y, double z) {
  vector.x = x;
  vector.y = y;
  vector.z = z;
}

// A quarter turn about z: x of the root is y of the inertial frame.
void setQuarterTurn(geometry_msgs::Quaternion& rotation) {
  rotation.z = rotation.w = std::sqrt(0.5);
}

nav_msgs::Odometry odometry() {
  nav_msgs::Odometry message;
  message.header.frame_id = "odom";
  message.header.stamp.fromSec(1);
  message.child_frame_id = "base";
  message.pose.pose.position.x = 3;
  setQuarterTurn(message.pose.pose.orientation);
  setVector(message.twist.twist.linear, 1, 0, 0.5);
  setVector(message.twist.twist.angular, 0, 2, 0);
  return message;
}

geometry_msgs::TransformStamped transform(const char* parent, const char* child, double stamp) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = parent;
  message.header.stamp.fromSec(stamp);
  message.child_frame_id = child;
  message.transform.translation.x = stamp;
  message.transform.rotation.w = 1;
  return message;
}

TEST(RootConversion, TwistsOfOdometryAreInAxesOfTheRoot) {
  RootConversion conversion("odom", "base");
  RootPose pose;
  const auto rejection = conversion.convert(odometry(), pose);
  ASSERT_FALSE(rejection) << rejection->text;
  EXPECT_EQ(pose.stamp_ns, 1000000000);
  EXPECT_EQ(pose.position, Eigen::Vector3d(3, 0, 0));
  EXPECT_LT((pose.orientation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), kEps);
  EXPECT_LT((pose.velocity - Eigen::Vector3d(0, 1, 0.5)).norm(), kEps);
  EXPECT_LT((pose.angular_velocity - Eigen::Vector3d(-2, 0, 0)).norm(), kEps);
}

TEST(RootConversion, TwistsOfStatesAreInInertialAxes) {
  sensor_msgs::MultiDOFJointState message;
  message.header = odometry().header;
  message.joint_names = {"wheel", "base"};
  message.transforms.resize(2);
  message.transforms[1].translation.y = 4;
  setQuarterTurn(message.transforms[1].rotation);
  RootConversion conversion("odom", "base");
  RootPose pose;
  ASSERT_FALSE(conversion.convert(message, pose));
  EXPECT_EQ(pose.position, Eigen::Vector3d(0, 4, 0));
  EXPECT_TRUE(std::isnan(pose.velocity.x()));
  message.twist.resize(2);
  setVector(message.twist[1].linear, 1, 0, 0);
  setVector(message.twist[1].angular, 0, 2, 0);
  ASSERT_FALSE(conversion.convert(message, pose));
  EXPECT_EQ(pose.velocity, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(pose.angular_velocity, Eigen::Vector3d(0, 2, 0));
  message.twist.resize(1);
  EXPECT_EQ(conversion.convert(message, pose)->text, "it has 1 twists for 2 names");
}

TEST(RootConversion, BadOdometryIsNamed) {
  RootConversion conversion("odom", "base");
  const auto refused = [&](auto change) {
    nav_msgs::Odometry message = odometry();
    change(message);
    RootPose pose;
    const auto rejection = conversion.convert(message, pose);
    return rejection ? rejection->text : "accepted";
  };
  using Message = nav_msgs::Odometry;
  EXPECT_EQ(refused([](Message&) {}), "accepted");
  EXPECT_EQ(refused([](Message& m) { m.header.frame_id = "map"; }),
            "its frame 'map' is not the inertial frame 'odom'");
  EXPECT_EQ(refused([](Message& m) { m.child_frame_id = "base_footprint"; }),
            "its child_frame_id 'base_footprint' is not the root link 'base'");
  EXPECT_EQ(refused([](Message& m) { m.header.stamp = ros::Time(); }), "its stamp is zero");
  EXPECT_EQ(refused([](Message& m) { m.pose.pose.position.y = NAN; }), "its position.y is nan");
  EXPECT_EQ(refused([](Message& m) { m.pose.pose.position.y = 1e101; }),
            "its position.y is 1e+101");
  EXPECT_EQ(refused([](Message& m) { m.pose.pose.orientation.w = NAN; }),
            "its orientation.w is nan");
  EXPECT_EQ(refused([](Message& m) { m.pose.pose.orientation = geometry_msgs::Quaternion(); }),
            "its orientation has the length 0, not 1");
}

TEST(RootConversion, PosesCountWithoutTheRatesThatAreNotFinite) {
  RootConversion conversion("odom", "base");
  nav_msgs::Odometry message = odometry();
  RootPose pose;
  ASSERT_FALSE(conversion.convert(message, pose));
  EXPECT_FALSE(conversion.twistLeftOut());
  const Eigen::Vector3d velocity = pose.velocity, turn = pose.angular_velocity;
  message.twist.twist.angular.z = -INFINITY;
  ASSERT_FALSE(conversion.convert(message, pose));
  EXPECT_TRUE(conversion.twistLeftOut());
  EXPECT_EQ(pose.velocity, velocity);
  EXPECT_TRUE(pose.angular_velocity.array().isNaN().all());
  EXPECT_EQ(conversion.takeDoubt(),
            "its twist.angular.z is -inf: poses count without rates that are not finite");
  message = odometry();
  message.twist.twist.linear.x = NAN;
  ASSERT_FALSE(conversion.convert(message, pose));
  EXPECT_TRUE(conversion.twistLeftOut());
  EXPECT_TRUE(pose.velocity.array().isNaN().all());
  EXPECT_EQ(pose.angular_velocity, turn);
  EXPECT_EQ(conversion.takeDoubt(), "");
}

TEST(RootConversion, QuaternionsAreScaledAndDoubtedOnce) {
  RootConversion conversion("odom", "base");
  nav_msgs::Odometry message = odometry();
  RootPose pose;
  const auto scaled = [&](double length) {
    message = odometry();
    message.pose.pose.orientation.z *= length;
    message.pose.pose.orientation.w *= length;
    return !conversion.convert(message, pose);
  };
  EXPECT_TRUE(scaled(1 + 1e-7));  // as single precision leaves it
  EXPECT_EQ(conversion.takeDoubt(), "");
  EXPECT_TRUE(scaled(0.9995));
  EXPECT_NEAR(pose.orientation.norm(), 1, kEps);
  EXPECT_EQ(conversion.takeDoubt(),
            "the quaternion orientation has the length 0.9995; it and those like it are scaled to "
            "1");
  EXPECT_TRUE(scaled(1.0005));
  EXPECT_EQ(conversion.takeDoubt(), "");
  EXPECT_FALSE(scaled(1.0011));
  EXPECT_FALSE(scaled(0.9989));
}

TEST(RootFrames, FindTheLatestInstantThatAllFramesHave) {
  RootFrames frames("odom", "base", 0.25);
  geometry_msgs::TransformStamped found;
  EXPECT_EQ(frames.problem(), "no transform from 'odom' to 'base'");
  frames.take(transform("odom", "cart", 10), false);
  EXPECT_FALSE(frames.findNew(found));
  frames.take(transform("cart", "base", 0), true);
  ASSERT_TRUE(frames.findNew(found));
  EXPECT_EQ(frames.problem(), "");
  EXPECT_EQ(found.header.stamp.toSec(), 10);
  EXPECT_EQ(found.header.frame_id, "odom");
  EXPECT_EQ(found.child_frame_id, "base");
  EXPECT_EQ(found.transform.translation.x, 10);
  EXPECT_FALSE(frames.findNew(found));  // that was it
  frames.take(transform("base", "tool", 11), false);
  EXPECT_FALSE(frames.findNew(found));
  frames.take(transform("odom", "cart", 10.1), false);
  ASSERT_TRUE(frames.findNew(found));
  EXPECT_EQ(found.header.stamp.toSec(), 10.1);
}

// As a looped bag does it; what is static is sent once only.
TEST(RootFrames, StartAnewWhenTimeGoesBack) {
  RootFrames frames("odom", "base", 0.25);
  geometry_msgs::TransformStamped found;
  frames.take(transform("cart", "base", 0), true);
  frames.take(transform("odom", "cart", 10), false);
  ASSERT_TRUE(frames.findNew(found));
  frames.take(transform("odom", "cart", 9.9), false);  // late
  EXPECT_FALSE(frames.findNew(found));
  frames.take(transform("odom", "cart", 5), false);
  ASSERT_TRUE(frames.findNew(found));
  EXPECT_EQ(found.header.stamp.toSec(), 5);
}

// Of other frames on the topic, whose clocks may be of any kind.
TEST(RootFrames, ForgetOnlyWhatGoesBack) {
  RootFrames frames("odom", "base", 0.25);
  geometry_msgs::TransformStamped found;
  frames.take(transform("odom", "cart", 10), false);
  frames.take(transform("cart", "base", 10), false);
  ASSERT_TRUE(frames.findNew(found));
  for (int i = 0; i < 100; ++i) {
    frames.take(transform("map", "ball", i % 2 == 0 ? 100 : 5), false);
    EXPECT_FALSE(frames.findNew(found)) << i;
    EXPECT_EQ(frames.problem(), "") << i;
  }
  // What comes before the other frame has gone back, too, is known with it.
  frames.take(transform("odom", "cart", 5), false);
  EXPECT_NE(frames.problem(), "");
  frames.take(transform("cart", "base", 5), false);
  ASSERT_TRUE(frames.findNew(found));
  EXPECT_EQ(found.header.stamp.toSec(), 5);
}

// Frames that go back all the time do not hold up others that go back once.
TEST(RootFrames, FindFramesThatWentBackAmongMany) {
  RootFrames frames("odom", "base", 0.25);
  geometry_msgs::TransformStamped found;
  for (int i = 0; i < 900; ++i) {
    frames.take(transform("odom", "base", 10 + 0.01 * i), false);
    frames.take(transform("map", "ball", i % 2 == 0 ? 100 : 5), false);
  }
  int needed = 0;
  for (; needed < 900; ++needed) {
    frames.take(transform("odom", "base", 1 + 0.01 * needed), false);
    if (frames.findNew(found) && found.header.stamp.toSec() < 10) break;
  }
  EXPECT_EQ(needed, 0);
}

// Differences of such stamps do not fit into ros::Duration.
TEST(RootFrames, TakeStampsOfAllSizes) {
  RootFrames frames("odom", "base", 0.25);
  geometry_msgs::TransformStamped found;
  for (const double stamp : {3e9, 10.0, 4294967290.0, 4294967280.0, 11.0}) {
    frames.take(transform("odom", "base", stamp), false);
  }
  ASSERT_TRUE(frames.findNew(found));
  EXPECT_EQ(found.header.stamp.toSec(), 11);
}

}  // namespace
}  // namespace virtual_work_dynamics
