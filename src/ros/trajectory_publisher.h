#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <chrono>
#include <cstdint>

#include "ros/root_publisher.h"
#include "ros/sample_times.h"
#include "ros/trajectory_settings.h"

namespace virtual_work_dynamics {

/// Plays a motion as sensor_msgs/JointState on `joint_states`, or as
/// trajectory_msgs/JointTrajectory on `joint_trajectory`. The steady clock sets the pace with
/// absolute deadlines; a publisher that is late catches up and leaves no sample out. Stamps are the
/// start plus whole nanoseconds, whatever the pace. How a root link moves is told before the joint
/// states of the same instant, or before the trajectory.
class TrajectoryPublisher {
 public:
  /// Advertises the topic in the namespace of `node`.
  TrajectoryPublisher(ros::NodeHandle node, TrajectorySettings settings);

  /// Waits for subscribers, plays the motion, and returns after the last message was delivered, or
  /// earlier when ROS shuts down. With `loop` it plays until then.
  void run();

 private:
  bool waitForSubscribers() const;
  std::int64_t playStates();
  std::int64_t playTrajectories();

  TrajectorySettings settings_;
  SampleTimes samples_;
  ros::Publisher publisher_;
  RootPublisher root_;
};

}  // namespace virtual_work_dynamics
