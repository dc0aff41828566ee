#include "ros/output_topics.h"

namespace virtual_work_dynamics {

OutputTopics::OutputTopics(ros::NodeHandle private_node, const Outputs& outputs, int queue_size,
                           ros::CallbackQueueInterface& callbacks,
                           const std::function<void()>& changed) {
  const ros::SubscriberStatusCallback notify = [changed](const ros::SingleSubscriberPublisher&) {
    changed();
  };
  for (const auto& output : outputs) {
    ros::AdvertiseOptions options =
        output->options(output->topic(), static_cast<std::uint32_t>(queue_size));
    options.connect_cb = options.disconnect_cb = notify;
    options.callback_queue = &callbacks;
    publishers_.push_back(private_node.advertise(options));
    output->start(publishers_.back());
    always_.push_back(output->isAlwaysComputed());
  }
}

Audience OutputTopics::audience() const {
  Audience audience;
  for (std::size_t i = 0; i < publishers_.size(); ++i) {
    if (always_[i] || publishers_[i].getNumSubscribers() > 0) audience.push_back(i);
  }
  return audience;
}

std::vector<std::string> OutputTopics::names(const Audience& audience) const {
  std::vector<std::string> names;
  for (const std::size_t i : audience) {
    if (publishers_[i].getNumSubscribers() > 0) names.push_back(publishers_[i].getTopic());
  }
  return names;
}

void OutputTopics::publish(const ActivePlan& plan, bool trajectories) const {
  for (const ActiveOutput& output : plan.outputs) {
    if (output.of_trajectories == trajectories) output.message->publish(publishers_[output.index]);
  }
}

}  // namespace virtual_work_dynamics
