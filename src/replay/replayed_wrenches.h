#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "dynamics/live_wrenches.h"
#include "ros/foreign_frames.h"
#include "ros/inverse_dynamics_parameters.h"
#include "ros/rejection.h"
#include "ros/wrench_conversion.h"

namespace virtual_work_dynamics {

/// Recorded messages of live wrenches. Those measured in a frame that is no link of the robot wait
/// until tf tells of it, as long as those of WrenchInputs, by the times of receipt.
class ReplayedWrenches {
 public:
  /// Is told of a message that is dropped, by its number among those of live wrench `i`.
  using Drop = std::function<void(std::size_t i, std::size_t number, const Rejection& rejection)>;

  /// @param mechanism must outlive it, like wrenches   @param count of the live wrenches
  ReplayedWrenches(const Mechanism& mechanism, const InverseDynamicsParameters& parameters,
                   LiveWrenches& wrenches, std::size_t count, Drop drop);

  /// Takes a message of live wrench `i`, or lets it wait.
  void take(std::size_t i, std::size_t number, const geometry_msgs::WrenchStamped& message,
            ros::Time receipt);
  void takeFrames(const tf2_msgs::TFMessage& message, bool is_static, ros::Time receipt);
  /// Drops what has waited too long when a message of this time of receipt comes.
  void waitUntil(ros::Time receipt);
  /// No more messages come: what waits waits no longer.
  void finish();

 private:
  struct Waiting {
    std::size_t i, number;
    geometry_msgs::WrenchStamped message;
    ros::Time until;
  };

  std::optional<Rejection> receive(std::size_t i, std::size_t number,
                                   const geometry_msgs::WrenchStamped& message, ros::Time receipt);
  bool waits(std::size_t i) const;
  void takeWaiting(ros::Time now);

  const RootSettings root_;
  const ros::Duration timeout_;
  const std::size_t count_;
  const Drop drop_;
  WrenchConversion conversion_;
  ForeignFrames frames_;
  ros::Time foreign_since_;  // zero: all frames were links
  std::deque<Waiting> waiting_;
};

}  // namespace virtual_work_dynamics
