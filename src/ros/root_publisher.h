#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <optional>

#include "ros/sample_times.h"
#include "ros/trajectory_settings.h"

namespace virtual_work_dynamics {

/// Publishes how a root link moves, as messages of its RootSource in the namespace of a node, and
/// its pose on /tf, as drivers of vehicles do. Without a source it does nothing.
class RootPublisher {
 public:
  RootPublisher(ros::NodeHandle node, RootPlay play);

  /// Publishes the motion at time t, s; for joint states. tf, unless it is the source, comes at
  /// 50 Hz of the stamps at most.
  void publish(double t, const ros::Time& stamp);
  /// Publishes the whole motion, where the source is a trajectory. @param start zero: unknown
  void publish(const SampleTimes& samples, const ros::Time& start);

 private:
  void publishPose(const RootMotion& motion, const ros::Time& stamp);
  template <typename Message>
  Message begin(const ros::Time& stamp) const;

  RootPlay play_;
  ros::Publisher publisher_, tf_;
  std::optional<ros::Time> posed_;  // stamp of the newest pose on tf
};

}  // namespace virtual_work_dynamics
