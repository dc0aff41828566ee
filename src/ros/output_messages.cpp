#include "ros/output_messages.h"

#include <algorithm>

namespace virtual_work_dynamics {
namespace {

template <typename Message>
void copyVector(const Eigen::Vector3d& from, Message& to) {
  to.x = from.x();
  to.y = from.y();
  to.z = from.z();
}

void copyWrench(const Wrench& from, geometry_msgs::Wrench& to) {
  copyVector(from.force, to.force);
  copyVector(from.torque, to.torque);
}

void copyPose(const Pose& from, geometry_msgs::Transform& to) {
  copyVector(from.position, to.translation);
  to.rotation.x = from.orientation.x();
  to.rotation.y = from.orientation.y();
  to.rotation.z = from.orientation.z();
  to.rotation.w = from.orientation.w();
}

void copyValues(const Eigen::VectorXd& from, std::vector<double>& to) {
  std::copy(from.data(), from.data() + from.size(), to.begin());
}

// The link whose axes and origin a reaction in child axes refers to.
const std::string& childLink(const Mechanism& mechanism, const std::string& joint) {
  const int index = joint == kGround ? -1 : mechanism.jointIndex(joint);
  return mechanism.links()[static_cast<std::size_t>(index + 1)].name;
}

}  // namespace

OutputMessages::OutputMessages(const Mechanism& mechanism, const Request& request,
                               const std::string& frame_prefix) {
  const std::string root_frame = frame_prefix + mechanism.links().front().name;
  effort_.header.frame_id = root_frame;
  if (request.efforts) {
    effort_.name = mechanism.coordinateNames();
    effort_.position.resize(effort_.name.size());
    effort_.velocity.resize(effort_.name.size());
    effort_.effort.resize(effort_.name.size());
  }
  reactions_.header.frame_id = root_frame;
  reactions_.joint_names = request.root_axes;
  reactions_.wrench.resize(request.root_axes.size());
  if (request.poses) reactions_.transforms.resize(request.root_axes.size());
  if (request.twists) reactions_.twist.resize(request.root_axes.size());
  for (const std::string& joint : request.child_axes) {
    wrenches_.emplace_back();
    wrenches_.back().header.frame_id = frame_prefix + childLink(mechanism, joint);
  }
}

void OutputMessages::fill(std::int64_t stamp_ns, const Motion& motion, const Workspace& results) {
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  effort_.header.stamp = stamp;
  if (!effort_.name.empty()) {
    copyValues(motion.q, effort_.position);
    copyValues(motion.qd, effort_.velocity);
    copyValues(results.effort(), effort_.effort);
  }
  reactions_.header.stamp = stamp;
  fillReactions(results);
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    wrenches_[i].header.stamp = stamp;
    copyWrench(results.childAxes()[i], wrenches_[i].wrench);
  }
}

void OutputMessages::fillReactions(const Workspace& results) {
  for (std::size_t i = 0; i < reactions_.wrench.size(); ++i) {
    copyWrench(results.rootAxes()[i], reactions_.wrench[i]);
  }
  for (std::size_t i = 0; i < reactions_.transforms.size(); ++i) {
    copyPose(results.poses()[i], reactions_.transforms[i]);
  }
  for (std::size_t i = 0; i < reactions_.twist.size(); ++i) {
    copyVector(results.twists()[i].linear, reactions_.twist[i].linear);
    copyVector(results.twists()[i].angular, reactions_.twist[i].angular);
  }
}

}  // namespace virtual_work_dynamics
