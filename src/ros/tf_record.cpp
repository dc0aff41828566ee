#include "ros/tf_record.h"

namespace virtual_work_dynamics {
namespace {

// By which tf2 is to name the publishers in its own messages.
constexpr char kAuthority[] = "tf";

}  // namespace

void TfRecord::take(const geometry_msgs::TransformStamped& transform, bool is_static) {
  // What tf2 would refuse with a line of its own for each message.
  const std::string& parent = transform.header.frame_id;
  const std::string& child = transform.child_frame_id;
  if (parent.empty() || child.empty() || parent == child) return;
  if (!is_static) {
    ros::Time& latest = latest_[child];
    if ((latest - transform.header.stamp).toSec() > max_gap_) {
      // What is known of later instants would hide what comes. What is static stays.
      buffer_.clear();
      latest_.clear();
      ++restarts_;
    }
    latest_[child] = transform.header.stamp;
  }
  buffer_.setTransform(transform, kAuthority, is_static);
}

}  // namespace virtual_work_dynamics
