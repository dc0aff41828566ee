#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace virtual_work_dynamics {

/// The transforms of /tf and /tf_static as their messages come. Nothing waits. Serves one thread.
class TfRecord {
 public:
  /// @param max_gap s by which a frame's stamps go back when time does
  explicit TfRecord(double max_gap) : max_gap_(max_gap) {}

  /// Takes a transform of finite numbers, whose quaternion has unit length. One that goes back in
  /// time by more than `max_gap` has what is known of its own frame forgotten, and of no other.
  void take(const geometry_msgs::TransformStamped& transform, bool is_static);

  const tf2::BufferCore& buffer() const { return buffer_; }
  /// Stamp of the first transform known of a frame in another one; nothing where none is, or it is
  /// static.
  std::optional<std::int64_t> firstOf(const std::string& child) const;

 private:
  // What the buffer knows of a frame, by stamp in ns, as nothing of it can be taken out again.
  struct Frame {
    std::map<std::int64_t, geometry_msgs::TransformStamped> known;
    bool went_back = false;  // so that the buffer has what is forgotten
  };

  void keep(const geometry_msgs::TransformStamped& transform);
  void fillAnew();

  const double max_gap_;
  tf2::BufferCore buffer_;
  std::map<std::string, Frame> frames_;  // that move, by child frame
  std::size_t known_ = 0;                // of all of them
  std::size_t taken_ = 0;                // since the buffer was filled anew
  bool went_back_ = false;               // one of them
};

}  // namespace virtual_work_dynamics
