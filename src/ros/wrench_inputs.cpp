#include "ros/wrench_inputs.h"

#include <ros/console.h>
#include <ros/transport_hints.h>

#include <algorithm>
#include <exception>
#include <iterator>
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
  guard(subscribers_[i].getTopic(), [&]() -> std::optional<Rejection> {
    const bool foreign = !message->header.frame_id.empty() && !message->header.stamp.isZero() &&
                         !conversion_.knowsFrame(i, *message);
    if (foreign && root_.source == RootSource::kImu &&
        message->header.frame_id == root_.inertial_frame) {
      return Rejection{DropReason::kUnknownFrame,
                       "its frame " + inQuotes(root_.inertial_frame) +
                           " is the inertial one, and an IMU does not tell where the root link is "
                           "in it"};
    }
    if (!foreign) return conversion_.take(i, *message);
    wait(i, message);
    return std::nullopt;
  });
}

// A message whose processing throws, for example for lack of memory, is dropped, too.
void WrenchInputs::guard(const std::string& topic,
                         const std::function<std::optional<Rejection>()>& take) {
  try {
    if (const auto rejection = take()) drop_(topic, rejection->reason, rejection->text);
  } catch (const std::exception& error) {
    drop_(topic, DropReason::kInternal, printable(error.what()));
  }
}

void WrenchInputs::wait(std::size_t i, const Message& message) {
  if (!foreign_) listenToTf();
  const auto patience = [](double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  };
  const Clock::time_point until =
      std::max(Clock::now() + patience(timeout_), foreign_since_ + patience(kBegins));
  WaitingOfFrame& waiting = waiting_[{i, message->header.frame_id}];
  auto later = waiting.end();
  while (later != waiting.begin() &&
         message->header.stamp < std::prev(later)->message->header.stamp) {
    --later;
  }
  waiting.insert(later, {message, until});
  ++waiting_count_;
  takeWaiting(i, waiting);
  if (waiting_count_ > kMostWaiting && !waiting.empty()) takeFirst(i, waiting, nullptr);
  if (waiting.empty()) waiting_.erase({i, message->header.frame_id});
}

void WrenchInputs::listenToTf() {
  foreign_ = std::make_unique<ForeignFrames>(mechanism_, frame_prefix_, posedIn(root_), max_gap_);
  foreign_since_ = Clock::now();
  ros::NodeHandle node;
  using Transforms = tf2_msgs::TFMessageConstPtr;
  const auto listen = [&](const std::string& topic, bool is_static) {
    return node.subscribe<tf2_msgs::TFMessage>(topic, 1000,
                                               [this, topic, is_static](const Transforms& message) {
                                                 guard(topic, [&]() -> std::optional<Rejection> {
                                                   foreign_->take(*message, is_static);
                                                   return std::nullopt;
                                                 });
                                                 takeWaiting();
                                               });
  };
  tf_ = listen("/tf", false);
  tf_static_ = listen("/tf_static", true);
  patience_ = node.createSteadyTimer(ros::WallDuration(kLook),
                                     [this](const ros::SteadyTimerEvent&) { takeWaiting(); });
  ROS_INFO("A wrench is measured in a frame that is no link of the robot; such frames are from tf");
}

void WrenchInputs::takeWaiting() {
  for (auto each = waiting_.begin(); each != waiting_.end();) {
    takeWaiting(each->first.first, each->second);
    each = each->second.empty() ? waiting_.erase(each) : std::next(each);
  }
}

// Takes messages whose frame is known by now, and drops those that have waited too long, or that
// lie before all that tf tells of it. Where the earliest one has to wait, so have those behind it.
void WrenchInputs::takeWaiting(std::size_t i, WaitingOfFrame& waiting) {
  const Clock::time_point now = Clock::now();
  while (!waiting.empty()) {
    std::optional<MeasuringFrame> frame;
    bool waits = false;
    guard(subscribers_[i].getTopic(), [&]() -> std::optional<Rejection> {
      const std_msgs::Header& header = waiting.front().message->header;
      const auto stamp_ns = static_cast<std::int64_t>(header.stamp.toNSec());
      frame = foreign_->find(header.frame_id, stamp_ns);
      waits = !frame && now < waiting.front().until && !foreign_->isPast(header.frame_id, stamp_ns);
      return std::nullopt;
    });
    if (waits) return;
    takeFirst(i, waiting, frame ? &*frame : nullptr);
  }
}

void WrenchInputs::takeFirst(std::size_t i, WaitingOfFrame& waiting, const MeasuringFrame* frame) {
  const Message message = std::move(waiting.front().message);
  waiting.pop_front();
  --waiting_count_;
  guard(subscribers_[i].getTopic(), [&]() -> std::optional<Rejection> {
    auto rejection = conversion_.take(i, *message, frame);
    if (rejection && rejection->reason == DropReason::kUnknownFrame) {
      rejection->text += ", and tf tells of no way from it to one at stamp " +
                         stampText(static_cast<std::int64_t>(message->header.stamp.toNSec()));
    }
    return rejection;
  });
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
