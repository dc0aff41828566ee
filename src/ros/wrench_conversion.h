#pragma once

#include <geometry_msgs/WrenchStamped.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/live_wrenches.h"
#include "ros/foreign_frames.h"
#include "ros/rejection.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Checks messages of a scene's live wrenches, and hands them to LiveWrenches. Frames are looked up
/// when a message names another one than the message before.
class WrenchConversion {
 public:
  /// @param frame_prefix what stands before the names of links in every frame_id
  /// @param wrenches must outlive it, like the mechanism
  WrenchConversion(const Mechanism& mechanism, std::string frame_prefix, LiveWrenches& wrenches);

  /// Takes a message of live wrench `i`. Allocates only for a frame that is new, or a rejection.
  /// @param foreign the frame, where it is no link of the robot; null: not known
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> take(std::size_t i, const geometry_msgs::WrenchStamped& message,
                                const MeasuringFrame* foreign = nullptr);
  /// Whether the frame of a message of live wrench `i` is a link of the robot.
  bool knowsFrame(std::size_t i, const geometry_msgs::WrenchStamped& message) {
    return frameOf(i, message.header.frame_id).link >= 0;
  }

 private:
  struct Frame {
    std::string id;
    int link = -1;  // of the robot; negative: none
  };

  const Frame& frameOf(std::size_t i, const std::string& id);

  const Mechanism& mechanism_;
  const std::string frame_prefix_;
  LiveWrenches& wrenches_;
  std::vector<Frame> frames_;  // of the latest message of each wrench
};

}  // namespace virtual_work_dynamics
