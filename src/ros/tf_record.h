#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>

#include <cstdint>
#include <map>
#include <string>

namespace virtual_work_dynamics {

/// The transforms of /tf and /tf_static as their messages come. Nothing waits. Serves one thread.
class TfRecord {
 public:
  /// @param max_gap s by which a frame's stamps go back when time does
  explicit TfRecord(double max_gap) : max_gap_(max_gap) {}

  /// Takes a transform of finite numbers, whose quaternion has unit length. One that goes back in
  /// time by more than `max_gap` forgets all others but those that are static.
  void take(const geometry_msgs::TransformStamped& transform, bool is_static);

  const tf2::BufferCore& buffer() const { return buffer_; }
  /// Number of times that time went back.
  std::uint64_t restarts() const { return restarts_; }

 private:
  const double max_gap_;
  tf2::BufferCore buffer_;
  std::map<std::string, ros::Time> latest_;  // stamps, by child frame
  std::uint64_t restarts_ = 0;
};

}  // namespace virtual_work_dynamics
