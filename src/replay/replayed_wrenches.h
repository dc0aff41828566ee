#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <cstdint>
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

  /// Takes a message of live wrench `i`, or lets it wait. Times of receipt are in ns.
  void take(std::size_t i, std::size_t number, const geometry_msgs::WrenchStamped& message,
            std::int64_t receipt);
  void takeFrames(const tf2_msgs::TFMessage& message, bool is_static, std::int64_t receipt);
  /// Drops what has waited too long when a message of this time of receipt comes.
  void waitUntil(std::int64_t receipt);
  /// No more messages come: what waits waits no longer.
  void finish();

 private:
  struct Waiting {
    std::size_t i, number;
    geometry_msgs::WrenchStamped message;
    std::int64_t until;  // ns
  };

  std::optional<Rejection> receive(std::size_t i, std::size_t number,
                                   const geometry_msgs::WrenchStamped& message,
                                   std::int64_t receipt);
  bool waits(std::size_t i) const;
  void takeWaiting(std::int64_t now);

  const RootSettings root_;
  const std::int64_t timeout_;  // ns
  const std::size_t count_;
  const Drop drop_;
  WrenchConversion conversion_;
  ForeignFrames frames_;
  std::optional<std::int64_t> foreign_since_;  // ns; nothing: all frames were links
  std::deque<Waiting> waiting_;
};

}  // namespace virtual_work_dynamics
