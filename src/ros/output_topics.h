#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <functional>
#include <string>
#include <vector>

#include "ros/active_plan.h"

namespace virtual_work_dynamics {

/// The node's publishers and who listens to them. Publishing and asking for the audience may happen
/// in different threads.
class OutputTopics {
 public:
  /// Advertises everything.
  /// @param reactions topic names of the reactions that the scene asks for; none: no reaction
  /// topics.
  /// @param closed_loops whether there is a ~determinacy, latched.
  /// @param queue_size messages each subscriber may be behind.
  /// @param callbacks queue on which `changed` is called when a subscriber comes or goes.
  OutputTopics(ros::NodeHandle private_node, const std::vector<std::string>& reactions,
               bool closed_loops, int queue_size, ros::CallbackQueueInterface& callbacks,
               const std::function<void()>& changed);

  Audience audience() const;
  /// The topics of an audience.
  std::vector<std::string> names(const Audience& audience) const;

  /// Publishes the messages of a plan to its audience, ~effort first; of closed loops, wrenches
  /// that exist.
  void publishSample(const ActivePlan& plan) const;
  void publishDeterminacy(const diagnostic_msgs::DiagnosticArray& message) const;
  void publishTrajectory(const trajectory_msgs::JointTrajectory& message) const;

 private:
  ros::Publisher effort_;
  ros::Publisher reactions_;
  ros::Publisher trajectory_;
  ros::Publisher determinacy_;
  std::vector<ros::Publisher> wrenches_;
};

}  // namespace virtual_work_dynamics
