#include "ros/root_frames.h"

#include <tf2/exceptions.h>

#include <utility>

#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

// By which tf2 is to name the publishers in its own messages.
constexpr char kAuthority[] = "tf";

}  // namespace

RootFrames::RootFrames(std::string inertial_frame, std::string link, double max_gap)
    : inertial_frame_(std::move(inertial_frame)), link_(std::move(link)), max_gap_(max_gap) {}

void RootFrames::take(const geometry_msgs::TransformStamped& transform, bool is_static) {
  // What tf2 would refuse with a line of its own for each message.
  const std::string& parent = transform.header.frame_id;
  const std::string& child = transform.child_frame_id;
  if (parent.empty() || child.empty() || parent == child) return;
  if (!is_static) {
    ros::Time& latest = latest_[child];
    if ((latest - transform.header.stamp).toSec() > max_gap_) startAnew();
    latest_[child] = transform.header.stamp;
  }
  buffer_.setTransform(transform, kAuthority, is_static);
}

// Time has gone back, and what is known of later instants would hide what comes. What is static
// stays.
void RootFrames::startAnew() {
  buffer_.clear();
  latest_.clear();
  found_ = ros::Time();
}

bool RootFrames::findNew(geometry_msgs::TransformStamped& found) {
  if (!buffer_.canTransform(inertial_frame_, link_, ros::Time())) return false;
  try {
    found = buffer_.lookupTransform(inertial_frame_, link_, ros::Time());
  } catch (const tf2::TransformException&) {
    return false;
  }
  if (found.header.stamp == found_) return false;
  found_ = found.header.stamp;
  return true;
}

std::string RootFrames::problem() const {
  if (buffer_.canTransform(inertial_frame_, link_, ros::Time())) return "";
  return "no transform from " + inQuotes(inertial_frame_) + " to " + inQuotes(link_);
}

}  // namespace virtual_work_dynamics
