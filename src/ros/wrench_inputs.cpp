#include "ros/wrench_inputs.h"

#include <ros/console.h>
#include <ros/transport_hints.h>

#include <exception>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/message_text.h"
#include "ros/private_name.h"

namespace virtual_work_dynamics {

WrenchInputs::WrenchInputs(const Mechanism& mechanism, const std::string& frame_prefix,
                           LiveWrenches& wrenches, double timeout, Counters& counters, Drop drop)
    : timeout_(timeout),
      wrenches_(wrenches),
      conversion_(mechanism, frame_prefix, wrenches),
      counters_(counters),
      drop_(std::move(drop)) {}

void WrenchInputs::subscribe(ros::NodeHandle private_node, const std::vector<std::string>& topics,
                             std::uint32_t queue) {
  for (std::size_t i = 0; i < topics.size(); ++i) {
    subscribers_.push_back(private_node.subscribe<geometry_msgs::WrenchStamped>(
        "wrench/" + topics[i], queue,
        [this, i](const geometry_msgs::WrenchStampedConstPtr& message) { receive(i, *message); },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
    ROS_INFO("The applied wrench %s is live, from %s", inQuotes(wrenches_.name(i)).c_str(),
             subscribers_.back().getTopic().c_str());
  }
}

// A message whose processing throws, for example for lack of memory, is dropped, too.
void WrenchInputs::receive(std::size_t i, const geometry_msgs::WrenchStamped& message) {
  counters_.wrenches.add();
  try {
    if (const auto rejection = conversion_.take(i, message)) {
      drop_(subscribers_[i].getTopic(), rejection->reason, rejection->text);
    }
  } catch (const std::exception& error) {
    drop_(subscribers_[i].getTopic(), DropReason::kInternal, printable(error.what()));
  }
}

std::string WrenchInputs::problem(std::size_t i) const {
  return problem(wrenches_.history(i), subscribers_[i].getTopic(), timeout_);
}

std::string WrenchInputs::problem(const WrenchHistory& history, const std::string& topic,
                                  double timeout) {
  if (history.size() == 0) return topic + " has not been received";
  return topic + " is known from stamp " + stampText(history.at(0).stamp_ns) + " to " +
         stampText(history.at(history.size() - 1).stamp_ns) + ", and " +
         privateName("wrench_timeout") + " is " + numberText(timeout) + " s";
}

}  // namespace virtual_work_dynamics
