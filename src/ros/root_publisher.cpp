#include "ros/root_publisher.h"

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <utility>

#include "ros/message_copies.h"

namespace virtual_work_dynamics {
namespace {

// As many messages as TrajectoryPublisher keeps of joint states.
constexpr std::uint32_t kRootQueue = 10000;
constexpr double kShownPeriod = 0.02;  // s

void copyTransform(const RootMotion& from, geometry_msgs::Transform& to) {
  Pose pose;
  pose.position = from.position;
  pose.orientation = from.orientation;
  copyPose(pose, to);
}

geometry_msgs::Twist twist(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  geometry_msgs::Twist message;
  copyVector(linear, message.linear);
  copyVector(angular, message.angular);
  return message;
}

trajectory_msgs::MultiDOFJointTrajectoryPoint pointOf(const RootMotion& motion) {
  trajectory_msgs::MultiDOFJointTrajectoryPoint point;
  point.transforms.resize(1);
  copyTransform(motion, point.transforms[0]);
  point.velocities = {twist(motion.velocity, motion.angular_velocity)};
  point.accelerations = {twist(motion.acceleration, motion.angular_acceleration)};
  return point;
}

}  // namespace

RootPublisher::RootPublisher(ros::NodeHandle node, RootPlay play) : play_(std::move(play)) {
  switch (play_.source) {
    case RootSource::kNone:
      return;
    case RootSource::kOdometry:
      publisher_ = node.advertise<nav_msgs::Odometry>("odom", kRootQueue);
      break;
    case RootSource::kTrajectory:
      publisher_ = node.advertise<trajectory_msgs::MultiDOFJointTrajectory>(
          "multi_dof_joint_trajectory", kRootQueue);
      break;
    case RootSource::kStates:
      publisher_ =
          node.advertise<sensor_msgs::MultiDOFJointState>("multi_dof_joint_states", kRootQueue);
      break;
    case RootSource::kTf:
      break;
    case RootSource::kImu:
      publisher_ = node.advertise<sensor_msgs::Imu>("imu", kRootQueue);
      break;
  }
  tf_ = node.advertise<tf2_msgs::TFMessage>("/tf", kRootQueue);
}

template <typename Message>
Message RootPublisher::begin(const ros::Time& stamp) const {
  Message message;
  message.header.stamp = stamp;
  message.header.frame_id = play_.inertial_frame;
  return message;
}

void RootPublisher::publish(double t, const ros::Time& stamp) {
  if (play_.source == RootSource::kNone) return;
  const RootMotion motion = play_.law->at(t);
  const Eigen::Quaterniond to_link = motion.orientation.conjugate();
  if (play_.source == RootSource::kOdometry) {
    auto message = begin<nav_msgs::Odometry>(stamp);
    message.child_frame_id = play_.link;
    copyVector(motion.position, message.pose.pose.position);
    geometry_msgs::Transform transform;
    copyTransform(motion, transform);
    message.pose.pose.orientation = transform.rotation;
    message.twist.twist = twist(to_link * motion.velocity, to_link * motion.angular_velocity);
    publisher_.publish(message);
  } else if (play_.source == RootSource::kTrajectory) {
    auto message = begin<trajectory_msgs::MultiDOFJointTrajectory>(stamp);
    message.joint_names = {play_.link};
    message.points = {pointOf(motion)};
    publisher_.publish(message);
  } else if (play_.source == RootSource::kStates) {
    auto message = begin<sensor_msgs::MultiDOFJointState>(stamp);
    message.joint_names = {play_.link};
    message.transforms.resize(1);
    copyTransform(motion, message.transforms[0]);
    message.twist = {twist(motion.velocity, motion.angular_velocity)};
    publisher_.publish(message);
  } else if (play_.source == RootSource::kImu) {
    auto message = begin<sensor_msgs::Imu>(stamp);
    message.header.frame_id = play_.link;
    message.orientation_covariance[0] = -1;  // not known, as of a bare gyroscope
    copyVector(Eigen::Vector3d(to_link * motion.angular_velocity), message.angular_velocity);
    copyVector(Eigen::Vector3d(to_link * (motion.acceleration - play_.gravity)),
               message.linear_acceleration);
    publisher_.publish(message);
  }
  publishPose(motion, stamp);
}

void RootPublisher::publishPose(const RootMotion& motion, const ros::Time& stamp) {
  const bool due = !posed_ || (stamp - *posed_).toSec() >= kShownPeriod;
  if (play_.source != RootSource::kTf && !due) return;
  posed_ = stamp;
  tf2_msgs::TFMessage message;
  message.transforms = {begin<geometry_msgs::TransformStamped>(stamp)};
  message.transforms[0].child_frame_id = play_.link;
  copyTransform(motion, message.transforms[0].transform);
  tf_.publish(message);
}

void RootPublisher::publish(const SampleTimes& samples, const ros::Time& start) {
  if (play_.source == RootSource::kNone) return;
  auto message = begin<trajectory_msgs::MultiDOFJointTrajectory>(start);
  message.joint_names = {play_.link};
  for (std::int64_t k = 0; k <= samples.last(); ++k) {
    message.points.push_back(pointOf(play_.law->at(samples.time(k))));
    message.points.back().time_from_start.fromNSec(samples.offset(k));
  }
  publisher_.publish(message);
}

}  // namespace virtual_work_dynamics
