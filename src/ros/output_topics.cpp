#include "ros/output_topics.h"

#include <ros/advertise_options.h>

namespace virtual_work_dynamics {

OutputTopics::OutputTopics(ros::NodeHandle private_node, const std::vector<std::string>& reactions,
                           bool closed_loops, int queue_size,
                           ros::CallbackQueueInterface& callbacks,
                           const std::function<void()>& changed) {
  const ros::SubscriberStatusCallback notify = [changed](const ros::SingleSubscriberPublisher&) {
    changed();
  };
  const auto advertise = [&](auto message, const std::string& topic, bool latch = false) {
    auto options = ros::AdvertiseOptions::create<decltype(message)>(
        topic, static_cast<std::uint32_t>(queue_size), notify, notify, ros::VoidConstPtr(),
        &callbacks);
    options.latch = latch;
    return private_node.advertise(options);
  };
  effort_ = advertise(sensor_msgs::JointState(), "effort");
  trajectory_ = advertise(trajectory_msgs::JointTrajectory(), "joint_trajectory");
  if (closed_loops) {
    determinacy_ = advertise(diagnostic_msgs::DiagnosticArray(), "determinacy", true);
  }
  if (!reactions.empty()) reactions_ = advertise(sensor_msgs::MultiDOFJointState(), "reactions");
  for (const std::string& topic : reactions) {
    wrenches_.push_back(advertise(geometry_msgs::WrenchStamped(), "reaction/" + topic));
  }
}

Audience OutputTopics::audience() const {
  Audience audience;
  audience.effort = effort_.getNumSubscribers() > 0;
  audience.trajectory = trajectory_.getNumSubscribers() > 0;
  audience.determinacy = determinacy_ && determinacy_.getNumSubscribers() > 0;
  audience.reactions = reactions_ && reactions_.getNumSubscribers() > 0;
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    if (wrenches_[i].getNumSubscribers() > 0) audience.wrenches.push_back(i);
  }
  return audience;
}

std::vector<std::string> OutputTopics::names(const Audience& audience) const {
  std::vector<std::string> names;
  if (audience.effort) names.push_back(effort_.getTopic());
  if (audience.reactions) names.push_back(reactions_.getTopic());
  if (audience.trajectory) names.push_back(trajectory_.getTopic());
  if (audience.determinacy) names.push_back(determinacy_.getTopic());
  for (const std::size_t i : audience.wrenches) names.push_back(wrenches_[i].getTopic());
  return names;
}

void OutputTopics::publishSample(const ActivePlan& plan) const {
  const Audience& audience = plan.audience;
  if (audience.effort) effort_.publish(plan.messages.effort());
  if (audience.reactions) reactions_.publish(plan.messages.reactions());
  for (std::size_t i = 0; i < audience.wrenches.size(); ++i) {
    if (!plan.messages.wrenchExists(i)) continue;
    wrenches_[audience.wrenches[i]].publish(plan.messages.wrenches()[i]);
  }
}

void OutputTopics::publishDeterminacy(const diagnostic_msgs::DiagnosticArray& message) const {
  determinacy_.publish(message);
}

void OutputTopics::publishTrajectory(const trajectory_msgs::JointTrajectory& message) const {
  trajectory_.publish(message);
}

}  // namespace virtual_work_dynamics
