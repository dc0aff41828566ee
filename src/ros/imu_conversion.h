#pragma once

#include <sensor_msgs/Imu.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "motion/root_imu.h"
#include "ros/fixed_frames.h"
#include "ros/pose_reading.h"
#include "ros/rejection.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// Checks messages of an inertial measurement unit, and turns their vectors into the axes of the
/// link that it is on: the root link, or one that joints move. Messages are those of one unit, by
/// its frame; another one takes over when that has been silent.
class ImuConversion {
 public:
  /// @param frame_prefix what stands before the names of links in every frame_id
  /// @param mechanism must outlive it
  /// @param oriented whether messages have to tell the orientation, which otherwise is not read
  /// @param max_gap s for which a unit has to be silent before another one is believed
  ImuConversion(const Mechanism& mechanism, std::string frame_prefix, bool oriented, double max_gap)
      : mechanism_(mechanism),
        frame_prefix_(std::move(frame_prefix)),
        oriented_(oriented),
        max_gap_(max_gap) {}

  /// Allocates only for a frame that is new, or a rejection.
  /// @returns why the message is to be dropped, or nothing.
  std::optional<Rejection> convert(const sensor_msgs::Imu& message, ImuSample& sample);
  /// Of quaternions, see PoseReading.
  std::string takeDoubt() { return orientations_.takeDoubt(); }

 private:
  std::optional<Rejection> readOrientation(const sensor_msgs::Imu& message,
                                           Eigen::Quaterniond& orientation);

  const Mechanism& mechanism_;
  const std::string frame_prefix_;
  const bool oriented_;
  const double max_gap_;
  PoseReading orientations_;
  bool found_ = false;
  std::string frame_;          // found last
  std::int64_t stamp_ns_ = 0;  // of its latest message
  int link_ = 0;               // that it is on
  FixedFrame placed_;          // against this link
};

}  // namespace virtual_work_dynamics
