#include "ros/closure_frames.h"

#include <Eigen/Geometry>
#include <unordered_set>

#include "base/printable.h"
#include "scene/closure_types.h"
#include "virtual_work_dynamics/closure_axes.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

geometry_msgs::Transform transformOf(const LinkFrame& frame) {
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(frame.rpy.z(), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(frame.rpy.y(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(frame.rpy.x(), Eigen::Vector3d::UnitX());
  geometry_msgs::Transform transform;
  transform.translation.x = frame.xyz.x();
  transform.translation.y = frame.xyz.y();
  transform.translation.z = frame.xyz.z();
  transform.rotation.x = rotation.x();
  transform.rotation.y = rotation.y();
  transform.rotation.z = rotation.z();
  transform.rotation.w = rotation.w();
  return transform;
}

}  // namespace

tf2_msgs::TFMessage closureFrames(const Mechanism& mechanism, const Scene& scene,
                                  const std::vector<std::string>& reactions,
                                  const std::string& frame_prefix) {
  tf2_msgs::TFMessage message;
  const std::unordered_set<std::string> shown(reactions.begin(), reactions.end());
  for (const Closure& closure : scene.closures) {
    // A link that the description does not have.
    const std::string axis = axisOfClosure(mechanism, scene, closure);
    const std::string& name = axis.empty() ? closure.name : axis;
    if (shown.count(name) == 0) continue;
    if (axis.empty() && mechanism.linkIndex(name) >= 0) {
      throw SceneError("closures: " + inQuotes(name) +
                       " is also the name of a link; a closure's frame in tf needs another name");
    }
    if (traitsOf(closure.type).touches()) continue;  // a contact moves on its link
    message.transforms.emplace_back();
    message.transforms.back().header.frame_id = frame_prefix + closure.child.link;
    message.transforms.back().child_frame_id = frame_prefix + name;
    message.transforms.back().transform = transformOf(closure.child);
  }
  return message;
}

std::string reactionFrame(const Mechanism& mechanism, const std::string& reaction) {
  const int joint = reaction == kGround ? -1 : mechanism.reactionIndex(reaction);
  if (joint < 0 && reaction != kGround) return reaction;
  return mechanism.link(joint + 1).name;
}

}  // namespace virtual_work_dynamics
