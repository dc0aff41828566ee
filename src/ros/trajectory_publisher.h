#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <chrono>
#include <cstdint>

#include "ros/sample_times.h"
#include "ros/trajectory_settings.h"

namespace virtual_work_dynamics {

/// Plays a motion as sensor_msgs/JointState on `joint_states`, or as
/// trajectory_msgs/JointTrajectory on `joint_trajectory`. Paced by the steady clock with absolute
/// deadlines; when late it catches up and leaves no sample out. Stamps are the start plus whole
/// nanoseconds, whatever the pace.
class TrajectoryPublisher {
 public:
  /// Advertises the topic in the namespace of `node`.
  TrajectoryPublisher(ros::NodeHandle node, TrajectorySettings settings);

  /// Waits for subscribers, plays, and stays alive until the last message is delivered; with `loop`
  /// until ROS shuts down, which ends everything early.
  void run();

 private:
  bool waitForSubscribers() const;
  std::int64_t playStates();
  std::int64_t playTrajectories();

  TrajectorySettings settings_;
  SampleTimes samples_;
  ros::Publisher publisher_;
};

}  // namespace virtual_work_dynamics
