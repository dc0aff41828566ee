#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <functional>
#include <string>
#include <vector>

#include "ros/active_plan.h"
#include "ros/outputs.h"

namespace virtual_work_dynamics {

/// The publishers of the node's outputs and who listens to them. Publishing and asking for the
/// audience may happen in different threads.
class OutputTopics {
 public:
  /// Advertises all outputs, and publishes what latched ones say at the start.
  /// @param queue_size messages each subscriber may be behind.
  /// @param callbacks queue on which `changed` is called when a subscriber comes or goes.
  OutputTopics(ros::NodeHandle private_node, const Outputs& outputs, int queue_size,
               ros::CallbackQueueInterface& callbacks, const std::function<void()>& changed);

  /// The outputs that have subscribers now, or are always computed.
  Audience audience() const;
  /// The topics of an audience that have subscribers.
  std::vector<std::string> names(const Audience& audience) const;

  /// Publishes the messages of samples, or that of trajectories, to a plan's audience.
  void publishSample(const ActivePlan& plan) const { publish(plan, false); }
  void publishTrajectory(const ActivePlan& plan) const { publish(plan, true); }

 private:
  void publish(const ActivePlan& plan, bool trajectories) const;

  std::vector<ros::Publisher> publishers_;  // by output
  std::vector<bool> always_;                // by output: whether it is computed without subscribers
};

}  // namespace virtual_work_dynamics
