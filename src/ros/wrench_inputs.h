#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <ros/subscriber.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/live_wrenches.h"
#include "ros/counters.h"
#include "ros/foreign_frames.h"
#include "ros/rejection.h"
#include "ros/root_settings.h"
#include "ros/wrench_conversion.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The subscriptions to the topics of live wrenches. Frames that are no links of the robot are
/// looked up in tf, which is subscribed to when the first one comes; messages wait for it a little,
/// those of a frame in the order of their stamps, and nothing else does.
class WrenchInputs {
 public:
  /// Counts, and says to the user, why a message of a topic is dropped.
  using Drop =
      std::function<void(const std::string& topic, DropReason reason, const std::string& text)>;

  /// @param wrenches must outlive it, like mechanism and counters   @param timeout of `wrenches`, s
  /// @param root how the root is known to move, and against which frame   @param max_gap s by which
  ///   stamps of tf go back when time does
  WrenchInputs(const Mechanism& mechanism, const std::string& frame_prefix, LiveWrenches& wrenches,
               double timeout, const RootSettings& root, double max_gap, Counters& counters,
               Drop drop);

  /// Subscribes to `~wrench/<topic>` of each live wrench.
  void subscribe(ros::NodeHandle private_node, const std::vector<std::string>& topics,
                 std::uint32_t queue);
  /// Why a live wrench is not known at an instant, by a topic, in one line.
  static std::string problem(const WrenchHistory& history, const std::string& topic,
                             double timeout);
  /// Why live wrench `i` is not known at an instant, in one line.
  std::string problem(std::size_t i) const;

 private:
  using Clock = std::chrono::steady_clock;
  using Message = geometry_msgs::WrenchStampedConstPtr;
  // A message whose frame is not known yet.
  struct Waiting {
    Message message;
    Clock::time_point until;
  };
  // Those of a wrench in a frame, the earliest one first.
  using WaitingOfFrame = std::deque<Waiting>;

  void receive(std::size_t i, const Message& message);
  void guard(const std::string& topic, const std::function<std::optional<Rejection>()>& take);
  void wait(std::size_t i, const Message& message);
  void listenToTf();
  void takeWaiting();
  void takeWaiting(std::size_t i, WaitingOfFrame& waiting);
  void takeFirst(std::size_t i, WaitingOfFrame& waiting, const MeasuringFrame* frame);

  const Mechanism& mechanism_;
  const std::string frame_prefix_;
  const double timeout_, max_gap_;
  const RootSettings root_;
  const LiveWrenches& wrenches_;
  WrenchConversion conversion_;
  Counters& counters_;
  const Drop drop_;
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<ForeignFrames> foreign_;  // from the first frame on that is no link
  Clock::time_point foreign_since_;
  ros::Subscriber tf_, tf_static_;
  ros::SteadyTimer patience_;
  std::map<std::pair<std::size_t, std::string>, WaitingOfFrame> waiting_;
  std::size_t waiting_count_ = 0;
};

}  // namespace virtual_work_dynamics
