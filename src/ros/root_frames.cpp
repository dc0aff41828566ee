#include "ros/root_frames.h"

#include <tf2/exceptions.h>

#include <utility>

#include "base/printable.h"

namespace virtual_work_dynamics {

RootFrames::RootFrames(std::string inertial_frame, std::string link, double max_gap)
    : inertial_frame_(std::move(inertial_frame)), link_(std::move(link)), record_(max_gap) {}

void RootFrames::take(const geometry_msgs::TransformStamped& transform, bool is_static) {
  record_.take(transform, is_static);
}

bool RootFrames::findNew(geometry_msgs::TransformStamped& found) {
  const tf2::BufferCore& buffer = record_.buffer();
  if (!buffer.canTransform(inertial_frame_, link_, ros::Time())) return false;
  try {
    found = buffer.lookupTransform(inertial_frame_, link_, ros::Time());
  } catch (const tf2::TransformException&) {
    return false;
  }
  if (found.header.stamp == found_) return false;
  found_ = found.header.stamp;
  return true;
}

std::string RootFrames::problem() const {
  if (record_.buffer().canTransform(inertial_frame_, link_, ros::Time())) return "";
  return "no transform from " + inQuotes(inertial_frame_) + " to " + inQuotes(link_);
}

}  // namespace virtual_work_dynamics
