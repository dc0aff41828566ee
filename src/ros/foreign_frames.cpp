#include "ros/foreign_frames.h"

#include <tf2/exceptions.h>

#include <Eigen/Geometry>
#include <utility>

#include "dynamics/wrench_history.h"

namespace virtual_work_dynamics {
namespace {

// Of frames between one and the link that it hangs on.
constexpr int kMostFrames = 1000;

}  // namespace

ForeignFrames::ForeignFrames(const Mechanism& mechanism, std::string frame_prefix,
                             std::string inertial_frame, double max_gap)
    : mechanism_(mechanism),
      frame_prefix_(std::move(frame_prefix)),
      inertial_frame_(std::move(inertial_frame)),
      record_(max_gap) {}

void ForeignFrames::take(const tf2_msgs::TFMessage& message, bool is_static) {
  for (geometry_msgs::TransformStamped transform : message.transforms) {
    Eigen::Vector3d position;
    Eigen::Quaterniond orientation;
    if (reading_.readTransform(transform.transform, "", position, orientation)) continue;
    transform.transform.rotation.x = orientation.x();
    transform.transform.rotation.y = orientation.y();
    transform.transform.rotation.z = orientation.z();
    transform.transform.rotation.w = orientation.w();
    record_.take(transform, is_static);
  }
}

int ForeignFrames::linkOf(const std::string& id) const {
  if (id.compare(0, frame_prefix_.size(), frame_prefix_) != 0) return -1;
  return mechanism_.linkIndex(id.substr(frame_prefix_.size()));
}

std::optional<MeasuringFrame> ForeignFrames::find(const std::string& id,
                                                  std::int64_t stamp_ns) const {
  const ros::Time stamp = ros::Time().fromNSec(static_cast<std::uint64_t>(stamp_ns));
  std::string at = id;
  for (int frames = 0; frames < kMostFrames; ++frames) {
    const int link = linkOf(at);
    if (link >= 0) return place(link, at, id, stamp);
    if (!inertial_frame_.empty() && at == inertial_frame_)
      return place(MeasuredWrench::kInertial, at, id, stamp);
    std::string parent;
    if (!record_.buffer()._getParent(at, stamp, parent)) break;
    at = parent;
  }
  if (!inertial_frame_.empty()) {
    if (auto frame = place(MeasuredWrench::kInertial, inertial_frame_, id, stamp)) return frame;
  }
  return place(0, frame_prefix_ + mechanism_.link(0).name, id, stamp);
}

ForeignFrames::Known ForeignFrames::known(const std::string& id, std::int64_t stamp_ns) const {
  std::string at = id, parent;
  for (int frames = 0; frames < kMostFrames; ++frames) {
    if (at != id && (linkOf(at) >= 0 || at == inertial_frame_)) return Known::kOnRobot;
    const auto first = record_.firstOf(at);
    if (first && stamp_ns < *first) return Known::kLater;
    if (!record_.buffer()._getParent(at, ros::Time(), parent)) break;
    at = parent;
  }
  return Known::kThen;
}

std::string ForeignFrames::topOf(const std::string& id) const {
  std::string at = id, parent;
  for (int frames = 0; frames < kMostFrames; ++frames) {
    if (!record_.buffer()._getParent(at, ros::Time(), parent)) break;
    at = parent;
  }
  return at;
}

bool ForeignFrames::isPast(const std::string& id, std::int64_t stamp_ns) const {
  const Known frame = known(id, stamp_ns);
  if (frame != Known::kThen) return frame == Known::kLater;
  // What the robot hangs on together with it has to be known, too.
  const std::string top = topOf(id);
  const auto later = [&](const std::string& on) {
    return topOf(on) == top && known(on, stamp_ns) == Known::kLater;
  };
  return later(frame_prefix_ + mechanism_.link(0).name) &&
         (inertial_frame_.empty() || later(inertial_frame_));
}

std::optional<MeasuringFrame> ForeignFrames::place(int link, const std::string& on,
                                                   const std::string& id,
                                                   const ros::Time& stamp) const {
  MeasuringFrame frame;
  frame.link = link;
  if (on == id) return frame;
  if (!record_.buffer().canTransform(on, id, stamp)) return std::nullopt;
  try {
    const geometry_msgs::Transform found =
        record_.buffer().lookupTransform(on, id, stamp).transform;
    frame.R =
        Eigen::Quaterniond(found.rotation.w, found.rotation.x, found.rotation.y, found.rotation.z)
            .normalized()
            .toRotationMatrix();
    frame.origin << found.translation.x, found.translation.y, found.translation.z;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
  return frame;
}

}  // namespace virtual_work_dynamics
