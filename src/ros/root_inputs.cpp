#include "ros/root_inputs.h"

#include <ros/console.h>
#include <ros/transport_hints.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/free_joint_conversion.h"
#include "ros/message_text.h"
#include "ros/private_name.h"

namespace virtual_work_dynamics {

RootInputs::RootInputs(const RootSettings& settings, const Mechanism& mechanism,
                       const std::string& frame_prefix, const Eigen::Vector3d& gravity,
                       const EstimatorSettings& estimator, Counters& counters, Drop drop)
    : mechanism_(mechanism),
      settings_(settings),
      max_gap_(estimator.max_gap),
      counters_(counters),
      drop_(std::move(drop)),
      conversion_(settings.inertial_frame,
                  settings.link.empty() ? frame_prefix + mechanism.link(0).name : settings.link),
      imu_conversion_(mechanism, frame_prefix, settings.axes != RootAxes::kRoot) {
  const auto timeout_ns = static_cast<std::int64_t>(std::llround(settings.timeout * 1e9));
  if (settings.source == RootSource::kNone) return;
  if (settings.source == RootSource::kTrajectory) {
    trajectory_ = std::make_unique<RootTrajectory>(timeout_ns);
    course_ = trajectory_.get();
  } else if (settings.source == RootSource::kImu) {
    imu_ =
        std::make_unique<RootImu>(estimator, timeout_ns, gravity, settings.axes != RootAxes::kRoot);
    course_ = imu_.get();
  } else {
    estimator_ = std::make_unique<RootEstimator>(estimator, timeout_ns);
    course_ = estimator_.get();
  }
  if (settings.source == RootSource::kTf) {
    frames_ = std::make_unique<RootFrames>(settings.inertial_frame, conversion_.link(), max_gap_);
  }
}

template <typename Message>
void RootInputs::listen(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue) {
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const ros::MessageEvent<const Message>&>(
      topic, queue, [this](const ros::MessageEvent<const Message>& event) { receive(event); });
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscriber_ = node.subscribe(options);
}

void RootInputs::subscribe(ros::NodeHandle node, std::uint32_t queue) {
  switch (settings_.source) {
    case RootSource::kNone:
      return;
    case RootSource::kOdometry:
      listen<nav_msgs::Odometry>(node, "odom", queue);
      break;
    case RootSource::kTrajectory:
      listen<trajectory_msgs::MultiDOFJointTrajectory>(node, "multi_dof_joint_trajectory", queue);
      break;
    case RootSource::kStates:
      listen<sensor_msgs::MultiDOFJointState>(node, "multi_dof_joint_states", queue);
      break;
    case RootSource::kTf:
      listen<tf2_msgs::TFMessage>(node, "/tf", queue);
      static_subscriber_ = node.subscribe("/tf_static", queue, &RootInputs::takeStatic, this);
      break;
    case RootSource::kImu:
      listen<sensor_msgs::Imu>(node, "imu", queue);
      break;
  }
  if (imu_) {
    ROS_INFO("The root link %s moves as %s measures, gravity with it",
             inQuotes(conversion_.link()).c_str(), subscriber_.getTopic().c_str());
    return;
  }
  ROS_INFO("The root link %s moves against %s, by %s", inQuotes(conversion_.link()).c_str(),
           inQuotes(conversion_.inertialFrame()).c_str(), subscriber_.getTopic().c_str());
}

// A message whose processing throws, for example for lack of memory, is dropped, too.
template <typename Message>
void RootInputs::receive(const ros::MessageEvent<const Message>& event) {
  counters_.roots.add();
  try {
    if (const auto rejection = take(*event.getConstMessage(), event.getReceiptTime())) {
      drop_(subscriber_.getTopic(), rejection->reason, rejection->text);
    }
    const std::string doubt = imu_ ? imu_conversion_.takeDoubt() : conversion_.takeDoubt();
    if (!doubt.empty()) ROS_WARN("%s: %s", subscriber_.getTopic().c_str(), doubt.c_str());
  } catch (const std::exception& error) {
    drop_(subscriber_.getTopic(), DropReason::kInternal, printable(error.what()));
  }
}

std::optional<Rejection> RootInputs::take(const trajectory_msgs::MultiDOFJointTrajectory& message,
                                          ros::Time receipt) {
  const ros::Time start = message.header.stamp.isZero() ? receipt : message.header.stamp;
  if (start.isZero()) {
    return Rejection{DropReason::kNoTime,
                     "its stamp is zero, and /clock has not been received yet"};
  }
  const auto start_ns = static_cast<std::int64_t>(start.toNSec());
  if (auto rejection = conversion_.convert(message, start_ns, points_)) return rejection;
  trajectory_->take(points_);
  return std::nullopt;
}

std::optional<Rejection> RootInputs::take(const tf2_msgs::TFMessage& message, ros::Time) {
  std::optional<Rejection> rejection;
  for (geometry_msgs::TransformStamped transform : message.transforms) {
    if (auto wrong = conversion_.check(transform)) {
      rejection = wrong;
    } else {
      frames_->take(transform, false);
    }
  }
  geometry_msgs::TransformStamped found;
  if (!frames_->findNew(found)) return rejection;
  RootPose pose;
  auto wrong = conversion_.convert(found, pose);
  if (!wrong) wrong = report(estimator_->push(pose), pose.stamp_ns);
  return wrong ? wrong : rejection;
}

void RootInputs::takeStatic(const tf2_msgs::TFMessage& message) {
  for (geometry_msgs::TransformStamped transform : message.transforms) {
    if (const auto wrong = conversion_.check(transform)) {
      drop_(static_subscriber_.getTopic(), wrong->reason, wrong->text);
    } else {
      frames_->take(transform, true);
    }
  }
}

bool RootInputs::isOfRoot(const sensor_msgs::MultiDOFJointState& message) const {
  const std::vector<std::string>& names = message.joint_names;
  return settings_.source == RootSource::kStates &&
         std::find(names.begin(), names.end(), conversion_.link()) != names.end();
}

// Joints that turn freely may come by the same topic.
std::optional<Rejection> RootInputs::take(const sensor_msgs::MultiDOFJointState& message,
                                          ros::Time) {
  if (!isOfRoot(message) && namesFreeJoint(mechanism_, message.joint_names)) return std::nullopt;
  return takePose(message);
}

std::optional<Rejection> RootInputs::take(const nav_msgs::Odometry& message, ros::Time) {
  return takePose(message);
}

template <typename Message>
std::optional<Rejection> RootInputs::takePose(const Message& message) {
  RootPose pose;
  if (auto rejection = conversion_.convert(message, pose)) return rejection;
  if (conversion_.twistLeftOut()) counters_.root_twist_left.add();
  return report(estimator_->push(pose), pose.stamp_ns);
}

std::optional<Rejection> RootInputs::take(const sensor_msgs::Imu& message, ros::Time) {
  ImuSample sample;
  if (auto rejection = imu_conversion_.convert(message, sample)) return rejection;
  return report(imu_->push(sample), sample.stamp_ns);
}

// Counts what became of a sample.
std::optional<Rejection> RootInputs::report(TrackGroup::Verdict verdict, std::int64_t stamp_ns) {
  using Verdict = TrackGroup::Verdict;
  switch (verdict) {
    case Verdict::kAccepted:
      return std::nullopt;
    case Verdict::kReordered:
      counters_.root_reordered.add();
      return std::nullopt;
    case Verdict::kEqualStamp:
      return Rejection{DropReason::kEqualStamp,
                       "its stamp " + stampText(stamp_ns) + " was received before"};
    case Verdict::kTooLate:
      return Rejection{DropReason::kTooLate, "its stamp " + stampText(stamp_ns) +
                                                 " is too far behind those received before"};
    case Verdict::kAfterGap:
      counters_.root_gaps.add();
      if (gap_throttle_.open()) {
        ROS_INFO("%s: a gap of %s s, longer than %s = %s s: the root's motion is estimated anew",
                 subscriber_.getTopic().c_str(), numberText(course_->interval()).c_str(),
                 privateName("estimator/max_gap").c_str(), numberText(max_gap_).c_str());
      }
      return std::nullopt;
    case Verdict::kRestartedBack:
      counters_.root_restarts.add();
      if (restart_throttle_.open()) {
        ROS_INFO("%s: time went back to stamp %s: the root's motion is estimated anew",
                 subscriber_.getTopic().c_str(), stampText(stamp_ns).c_str());
      }
      return std::nullopt;
  }
  return std::nullopt;
}

std::string RootInputs::problem() const {
  const std::string topic = subscriber_.getTopic();
  if (frames_ && course_->empty()) {
    const std::string gap = frames_->problem();
    if (!gap.empty()) return topic + " has " + gap;
  }
  if (course_->empty()) return topic + " has not told how the root link moves";
  if (course_->interval() > max_gap_ && std::isfinite(course_->interval())) {
    return topic + " has messages " + numberText(course_->interval()) +
           " s apart, and across more than " + privateName("estimator/max_gap") + " = " +
           numberText(max_gap_) + " s no acceleration is estimated";
  }
  return topic + " tells how the root link moves from stamp " + stampText(course_->first()) +
         " to " + stampText(course_->last()) + ", and " + privateName("root/timeout") + " is " +
         numberText(settings_.timeout) + " s";
}

}  // namespace virtual_work_dynamics
