#include "ros/root_inputs.h"

#include <ros/console.h>
#include <ros/transport_hints.h>

#include <exception>
#include <utility>

#include "base/printable.h"

namespace virtual_work_dynamics {

RootInputs::RootInputs(RootMessages& messages, Counters& counters, Drop drop)
    : messages_(messages), counters_(counters), drop_(std::move(drop)) {}

template <typename Message>
void RootInputs::listen(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue) {
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const ros::MessageEvent<const Message>&>(
      topic, queue, [this](const ros::MessageEvent<const Message>& event) { receive(event); });
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscriber_ = node.subscribe(options);
}

void RootInputs::subscribe(ros::NodeHandle node, std::uint32_t queue) {
  const RootSource source = messages_.settings().source;
  switch (source) {
    case RootSource::kNone:
      return;
    case RootSource::kOdometry:
      listen<nav_msgs::Odometry>(node, "odom", queue);
      break;
    case RootSource::kTrajectory:
      listen<trajectory_msgs::MultiDOFJointTrajectory>(node, "multi_dof_joint_trajectory", queue);
      break;
    case RootSource::kStates:
      listen<sensor_msgs::MultiDOFJointState>(node, "multi_dof_joint_states", queue);
      break;
    case RootSource::kTf:
      listen<tf2_msgs::TFMessage>(node, "/tf", queue);
      static_subscriber_ = node.subscribe("/tf_static", queue, &RootInputs::takeStatic, this);
      break;
    case RootSource::kImu:
      listen<sensor_msgs::Imu>(node, "imu", queue);
      break;
  }
  if (source == RootSource::kImu) {
    ROS_INFO("The root link %s moves as %s measures, gravity with it",
             inQuotes(messages_.link()).c_str(), subscriber_.getTopic().c_str());
    return;
  }
  ROS_INFO("The root link %s moves against %s, by %s", inQuotes(messages_.link()).c_str(),
           inQuotes(messages_.inertialFrame()).c_str(), subscriber_.getTopic().c_str());
}

// A message whose processing throws, for example for lack of memory, is dropped, too.
template <typename Message>
void RootInputs::receive(const ros::MessageEvent<const Message>& event) {
  using News = RootMessages::News;
  counters_.roots.add();
  try {
    const auto rejection = messages_.take(*event.getConstMessage(), event.getReceiptTime());
    if (rejection) drop_(subscriber_.getTopic(), rejection->reason, rejection->text);
    const std::string doubt = messages_.takeDoubt();
    if (!doubt.empty()) ROS_WARN("%s: %s", subscriber_.getTopic().c_str(), doubt.c_str());
    const News news = messages_.takeNews();
    if (news == News::kGap && gap_throttle_.open()) {
      ROS_INFO("%s: %s", subscriber_.getTopic().c_str(), messages_.gapText().c_str());
    } else if (news == News::kRestart && restart_throttle_.open()) {
      ROS_INFO("%s: %s", subscriber_.getTopic().c_str(), messages_.restartText().c_str());
    }
  } catch (const std::exception& error) {
    drop_(subscriber_.getTopic(), DropReason::kInternal, printable(error.what()));
  }
}

void RootInputs::takeStatic(const tf2_msgs::TFMessage& message) {
  try {
    messages_.takeStatic(message, [this](const Rejection& rejection) {
      drop_(static_subscriber_.getTopic(), rejection.reason, rejection.text);
    });
  } catch (const std::exception& error) {
    drop_(static_subscriber_.getTopic(), DropReason::kInternal, printable(error.what()));
  }
}

}  // namespace virtual_work_dynamics
