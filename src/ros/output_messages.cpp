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

void copyTwist(const Twist& from, geometry_msgs::Twist& to) {
  copyVector(from.linear, to.linear);
  copyVector(from.angular, to.angular);
}

void copyValues(const Eigen::VectorXd& from, std::vector<double>& to) {
  std::copy(from.data(), from.data() + from.size(), to.begin());
}

// The frame whose axes and origin a reaction in child axes refers to: the child link's, or the
// closure's own.
const std::string& childFrame(const Mechanism& mechanism, const std::string& name) {
  const int index = name == kGround ? -1 : mechanism.jointIndex(name);
  if (index < 0 && name != kGround) return name;
  return mechanism.links()[static_cast<std::size_t>(index + 1)].name;
}

bool all(const std::vector<bool>& values) {
  return std::find(values.begin(), values.end(), false) == values.end();
}

}  // namespace

std::vector<std::string> namesOfEfforts(const Mechanism& mechanism, const Scene& scene) {
  std::vector<std::string> names = mechanism.coordinateNames();
  if (!scene.actuated) return names;
  for (const Closure& closure : scene.closures) {
    const auto& actuated = *scene.actuated;
    if (std::find(actuated.begin(), actuated.end(), closure.name) == actuated.end()) continue;
    names.push_back(closure.name);
  }
  return names;
}

OutputMessages::OutputMessages(const Mechanism& mechanism, const Scene& scene,
                               const Request& request, const std::string& frame_prefix)
    : reaction_names_(request.root_axes), wrench_names_(request.child_axes) {
  const std::string root_frame = frame_prefix + mechanism.links().front().name;
  effort_.header.frame_id = root_frame;
  if (request.efforts) {
    effort_names_ = namesOfEfforts(mechanism, scene);
    effort_.name = effort_names_;
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
    wrenches_.back().header.frame_id = frame_prefix + childFrame(mechanism, joint);
    wrench_places_.push_back(wrench_places_.size());
  }
  wrench_exists_.assign(wrenches_.size(), true);
}

void OutputMessages::setComputed(const Request& computed) {
  const std::vector<std::string>& names = computed.child_axes;
  for (std::size_t i = 0; i < wrench_names_.size(); ++i) {
    const auto place = std::find(names.begin(), names.end(), wrench_names_[i]);
    wrench_places_[i] = static_cast<std::size_t>(place - names.begin());
  }
}

void OutputMessages::setStamp(std::int64_t stamp_ns) {
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  effort_.header.stamp = stamp;
  reactions_.header.stamp = stamp;
  for (geometry_msgs::WrenchStamped& wrench : wrenches_) wrench.header.stamp = stamp;
}

void OutputMessages::fill(std::int64_t stamp_ns, const Motion& motion, const Workspace& results) {
  setStamp(stamp_ns);
  if (!effort_.name.empty()) {
    copyValues(motion.q, effort_.position);
    copyValues(motion.qd, effort_.velocity);
    copyValues(results.effort(), effort_.effort);
  }
  fillReactions(results);
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    copyWrench(results.childAxes()[i], wrenches_[i].wrench);
  }
}

void OutputMessages::fill(std::int64_t stamp_ns, const Motion& motion, const LoopPlan& plan) {
  setStamp(stamp_ns);
  if (!effort_names_.empty()) fillEffort(motion, plan);
  // Results may have reactions that no message is for.
  if (!reaction_names_.empty()) {
    if (all(plan.rootAxesExist()) && reactions_.joint_names.size() == reaction_names_.size()) {
      fillReactions(plan.results());
    } else {
      fillExistingReactions(plan);
    }
  }
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    const std::size_t place = wrench_places_[i];
    wrench_exists_[i] = plan.childAxesExist()[place];
    copyWrench(plan.results().childAxes()[place], wrenches_[i].wrench);
  }
}

void OutputMessages::fillEffort(const Motion& motion, const LoopPlan& plan) {
  const ClosedLoopDynamics& results = plan.results();
  const bool as_before = all(plan.effortExists()) && effort_.name.size() == effort_names_.size();
  if (!as_before) effort_.name.clear();
  effort_.position.clear();
  effort_.velocity.clear();
  effort_.effort.clear();
  for (std::size_t i = 0; i < effort_names_.size(); ++i) {
    if (!plan.effortExists()[i]) continue;
    if (!as_before) effort_.name.push_back(effort_names_[i]);
    const auto index = static_cast<Eigen::Index>(i);
    const Eigen::Index closure = index - motion.q.size();
    effort_.position.push_back(closure < 0 ? motion.q[index]
                                           : results.actuatedClosurePositions()[closure]);
    effort_.velocity.push_back(closure < 0 ? motion.qd[index]
                                           : results.actuatedClosureVelocities()[closure]);
    effort_.effort.push_back(results.effort()[index]);
  }
}

void OutputMessages::fillExistingReactions(const LoopPlan& plan) {
  const ClosedLoopDynamics& results = plan.results();
  const bool poses = results.request().poses, twists = results.request().twists;
  reactions_.joint_names.clear();
  reactions_.wrench.clear();
  reactions_.transforms.clear();
  reactions_.twist.clear();
  for (std::size_t i = 0; i < reaction_names_.size(); ++i) {
    if (!plan.rootAxesExist()[i]) continue;
    reactions_.joint_names.push_back(reaction_names_[i]);
    reactions_.wrench.emplace_back();
    copyWrench(results.rootAxes()[i], reactions_.wrench.back());
    if (poses) {
      reactions_.transforms.emplace_back();
      copyPose(results.poses()[i], reactions_.transforms.back());
    }
    if (twists) {
      reactions_.twist.emplace_back();
      copyTwist(results.twists()[i], reactions_.twist.back());
    }
  }
}

template <typename Results>
void OutputMessages::fillReactions(const Results& results) {
  for (std::size_t i = 0; i < reactions_.wrench.size(); ++i) {
    copyWrench(results.rootAxes()[i], reactions_.wrench[i]);
  }
  for (std::size_t i = 0; i < reactions_.transforms.size(); ++i) {
    copyPose(results.poses()[i], reactions_.transforms[i]);
  }
  for (std::size_t i = 0; i < reactions_.twist.size(); ++i) {
    copyTwist(results.twists()[i], reactions_.twist[i]);
  }
}

}  // namespace virtual_work_dynamics
