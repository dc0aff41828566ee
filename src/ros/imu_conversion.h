#pragma once

#include <sensor_msgs/Imu.h>

#include <optional>
#include <string>
#include <utility>

#include "motion/root_imu.h"
#include "ros/fixed_frames.h"
#include "ros/rejection.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Checks messages of an inertial measurement unit, and turns their vectors into the root's axes.
/// The frame is looked up when a message names another one than the message before.
class ImuConversion {
 public:
  /// @param frame_prefix what stands before the names of links in every frame_id
  /// @param mechanism must outlive it
  ImuConversion(const Mechanism& mechanism, std::string frame_prefix)
      : mechanism_(mechanism), frame_prefix_(std::move(frame_prefix)) {}

  /// Allocates only for a frame that is new, or a rejection.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> convert(const sensor_msgs::Imu& message, ImuSample& sample);

 private:
  const Mechanism& mechanism_;
  const std::string frame_prefix_;
  bool found_ = false;
  std::string frame_;  // found last
  FixedFrame placed_;  // against the root link
};

}  // namespace virtual_work_dynamics
