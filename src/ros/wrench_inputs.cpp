#include "ros/wrench_inputs.h"

#include <ros/console.h>
#include <ros/transport_hints.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/message_text.h"
#include "ros/private_name.h"

namespace virtual_work_dynamics {

namespace {

// How often messages that wait are looked at, and how long tf has to begin to tell: what is static
// comes once, when the subscription is set up.
constexpr double kLook = 0.05;  // s
constexpr double kBegins = 2;   // s
constexpr std::size_t kMostWaiting = 4096;

// The inertial frame, where the pose of the root in it is known.
std::string posedIn(const RootSettings& root) {
  const bool posed = root.source != RootSource::kNone && root.source != RootSource::kImu;
  return posed ? root.inertial_frame : "";
}

}  // namespace

WrenchInputs::WrenchInputs(const Mechanism& mechanism, const std::string& frame_prefix,
                           LiveWrenches& wrenches, double timeout, const RootSettings& root,
                           double max_gap, Counters& counters, Drop drop)
    : mechanism_(mechanism),
      frame_prefix_(frame_prefix),
      timeout_(timeout),
      max_gap_(max_gap),
      root_(root),
      wrenches_(wrenches),
      conversion_(mechanism, frame_prefix, wrenches),
      counters_(counters),
      drop_(std::move(drop)) {}

void WrenchInputs::subscribe(ros::NodeHandle private_node, const std::vector<std::string>& topics,
                             std::uint32_t queue) {
  for (std::size_t i = 0; i < topics.size(); ++i) {
    subscribers_.push_back(private_node.subscribe<geometry_msgs::WrenchStamped>(
        "wrench/" + topics[i], queue,
        [this, i](const geometry_msgs::WrenchStampedConstPtr& message) { receive(i, message); },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
    ROS_INFO("The applied wrench %s is live, from %s", inQuotes(wrenches_.name(i)).c_str(),
             subscribers_.back().getTopic().c_str());
  }
}

void WrenchInputs::receive(std::size_t i, const Message& message) {
  counters_.wrenches.add();
  guard(i, [&]() -> std::optional<Rejection> {
    const bool foreign = !message->header.frame_id.empty() && !message->header.stamp.isZero() &&
                         !conversion_.knowsFrame(i, *message);
    if (foreign && root_.source == RootSource::kImu &&
        message->header.frame_id == root_.inertial_frame) {
      return Rejection{DropReason::kUnknownFrame,
                       "its frame " + inQuotes(root_.inertial_frame) +
                           " is the inertial one, and an IMU does not tell where the root link is "
                           "in it"};
    }
    if (!foreign && !waits(i)) return conversion_.take(i, *message);
    wait(i, message);
    return std::nullopt;
  });
}

// A message whose processing throws, for example for lack of memory, is dropped, too.
void WrenchInputs::guard(std::size_t i, const std::function<std::optional<Rejection>()>& take) {
  try {
    if (const auto rejection = take()) {
      drop_(subscribers_[i].getTopic(), rejection->reason, rejection->text);
    }
  } catch (const std::exception& error) {
    drop_(subscribers_[i].getTopic(), DropReason::kInternal, printable(error.what()));
  }
}

// Whether messages of a wrench wait, so that others have to queue up behind them.
bool WrenchInputs::waits(std::size_t i) const {
  return std::any_of(waiting_.begin(), waiting_.end(),
                     [i](const Waiting& waiting) { return waiting.i == i; });
}

void WrenchInputs::wait(std::size_t i, const Message& message) {
  if (!foreign_) listenToTf();
  const auto patience = [](double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  };
  const Clock::time_point until =
      std::max(Clock::now() + patience(timeout_), foreign_since_ + patience(kBegins));
  if (waiting_.size() == kMostWaiting) waiting_.front().until = Clock::time_point();
  waiting_.push_back({i, message, until});
  takeWaiting();
}

void WrenchInputs::listenToTf() {
  foreign_ = std::make_unique<ForeignFrames>(mechanism_, frame_prefix_, posedIn(root_), max_gap_);
  foreign_since_ = Clock::now();
  ros::NodeHandle node;
  using Transforms = tf2_msgs::TFMessageConstPtr;
  const auto listen = [&](const char* topic, bool is_static) {
    return node.subscribe<tf2_msgs::TFMessage>(topic, 1000,
                                               [this, is_static](const Transforms& message) {
                                                 foreign_->take(*message, is_static);
                                                 takeWaiting();
                                               });
  };
  tf_ = listen("/tf", false);
  tf_static_ = listen("/tf_static", true);
  patience_ = node.createSteadyTimer(ros::WallDuration(kLook),
                                     [this](const ros::SteadyTimerEvent&) { takeWaiting(); });
  ROS_INFO("A wrench is measured in a frame that is no link of the robot; such frames are from tf");
}

// Takes messages whose frames are known by now, those of each wrench in their order, and drops
// those that have waited too long.
void WrenchInputs::takeWaiting() {
  std::deque<Waiting> left;
  std::vector<bool> blocked(subscribers_.size(), false);
  const Clock::time_point now = Clock::now();
  std::swap(left, waiting_);
  for (Waiting& each : left) {
    const geometry_msgs::WrenchStamped& message = *each.message;
    const bool is_link = conversion_.knowsFrame(each.i, message);
    std::optional<MeasuringFrame> frame;
    if (!is_link && !blocked[each.i]) {
      frame = foreign_->find(message.header.frame_id,
                             static_cast<std::int64_t>(message.header.stamp.toNSec()));
    }
    if ((!frame && !is_link && now < each.until) || (blocked[each.i] && now < each.until)) {
      blocked[each.i] = true;
      waiting_.push_back(std::move(each));
      continue;
    }
    guard(each.i, [&]() -> std::optional<Rejection> {
      auto rejection = conversion_.take(each.i, message, frame ? &*frame : nullptr);
      if (rejection && rejection->reason == DropReason::kUnknownFrame) {
        rejection->text += ", and tf tells of no way from it to one at stamp " +
                           stampText(static_cast<std::int64_t>(message.header.stamp.toNSec()));
      }
      return rejection;
    });
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
