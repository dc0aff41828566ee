#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <cstdint>
#include <functional>
#include <string>

#include "ros/root_messages.h"
#include "ros/throttle.h"

namespace virtual_work_dynamics {

/// The subscription to the messages that tell how the root link moves.
class RootInputs {
 public:
  /// Counts, and says to the user, why a message of a topic is dropped.
  using Drop =
      std::function<void(const std::string& topic, DropReason reason, const std::string& text)>;

  /// @param messages that take what comes; must outlive it, like counters
  RootInputs(RootMessages& messages, Counters& counters, Drop drop);

  /// Without a source, nothing is subscribed to.
  void subscribe(ros::NodeHandle node, std::uint32_t queue);

  /// Why the motion of the root is not known at an instant, in one line.
  std::string problem() const { return messages_.problem(subscriber_.getTopic()); }

 private:
  template <typename Message>
  void listen(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue);
  template <typename Message>
  void receive(const ros::MessageEvent<const Message>& event);
  void takeStatic(const tf2_msgs::TFMessage& message);

  RootMessages& messages_;
  Counters& counters_;
  const Drop drop_;
  Throttle restart_throttle_, gap_throttle_;
  ros::Subscriber subscriber_, static_subscriber_;
};

}  // namespace virtual_work_dynamics
