#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/live_wrenches.h"
#include "ros/counters.h"
#include "ros/rejection.h"
#include "ros/wrench_conversion.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The subscriptions to the topics of live wrenches.
class WrenchInputs {
 public:
  /// Counts, and says to the user, why a message of a topic is dropped.
  using Drop =
      std::function<void(const std::string& topic, DropReason reason, const std::string& text)>;

  /// @param wrenches must outlive it, like mechanism and counters   @param timeout of `wrenches`, s
  WrenchInputs(const Mechanism& mechanism, const std::string& frame_prefix, LiveWrenches& wrenches,
               double timeout, Counters& counters, Drop drop);

  /// Subscribes to `~wrench/<topic>` of each live wrench.
  void subscribe(ros::NodeHandle private_node, const std::vector<std::string>& topics,
                 std::uint32_t queue);
  /// Why a live wrench is not known at an instant, by a topic, in one line.
  static std::string problem(const WrenchHistory& history, const std::string& topic,
                             double timeout);
  /// Why live wrench `i` is not known at an instant, in one line.
  std::string problem(std::size_t i) const;

 private:
  void receive(std::size_t i, const geometry_msgs::WrenchStamped& message);

  const double timeout_;
  const LiveWrenches& wrenches_;
  WrenchConversion conversion_;
  Counters& counters_;
  const Drop drop_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace virtual_work_dynamics
