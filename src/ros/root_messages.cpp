#include "ros/root_messages.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/free_joint_conversion.h"
#include "ros/message_text.h"
#include "ros/private_name.h"

namespace virtual_work_dynamics {

RootMessages::RootMessages(const RootSettings& settings, const Mechanism& mechanism,
                           const std::string& frame_prefix, const Eigen::Vector3d& gravity,
                           const EstimatorSettings& estimator, Counters& counters)
    : mechanism_(mechanism),
      settings_(settings),
      max_gap_(estimator.max_gap),
      counters_(counters),
      conversion_(settings.inertial_frame,
                  settings.link.empty() ? frame_prefix + mechanism.link(0).name : settings.link),
      imu_conversion_(mechanism, frame_prefix, settings.axes != RootAxes::kRoot, max_gap_) {
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

std::optional<Rejection> RootMessages::take(const trajectory_msgs::MultiDOFJointTrajectory& message,
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

std::optional<Rejection> RootMessages::take(const tf2_msgs::TFMessage& message, ros::Time) {
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

void RootMessages::takeStatic(const tf2_msgs::TFMessage& message,
                              const std::function<void(const Rejection&)>& drop) {
  for (geometry_msgs::TransformStamped transform : message.transforms) {
    if (const auto wrong = conversion_.check(transform)) {
      drop(*wrong);
    } else {
      frames_->take(transform, true);
    }
  }
}

bool RootMessages::isOfRoot(const sensor_msgs::MultiDOFJointState& message) const {
  const std::vector<std::string>& names = message.joint_names;
  return settings_.source == RootSource::kStates &&
         std::find(names.begin(), names.end(), conversion_.link()) != names.end();
}

// Joints that turn freely may come by the same topic.
std::optional<Rejection> RootMessages::take(const sensor_msgs::MultiDOFJointState& message,
                                            ros::Time) {
  if (!isOfRoot(message) && namesFreeJoint(mechanism_, message.joint_names)) return std::nullopt;
  return takePose(message);
}

std::optional<Rejection> RootMessages::take(const nav_msgs::Odometry& message, ros::Time) {
  return takePose(message);
}

template <typename Message>
std::optional<Rejection> RootMessages::takePose(const Message& message) {
  RootPose pose;
  if (auto rejection = conversion_.convert(message, pose)) return rejection;
  if (conversion_.twistLeftOut()) counters_.root_twist_left.add();
  return report(estimator_->push(pose), pose.stamp_ns);
}

std::optional<Rejection> RootMessages::take(const sensor_msgs::Imu& message, ros::Time) {
  ImuSample sample;
  if (auto rejection = imu_conversion_.convert(message, sample)) return rejection;
  return report(imu_->push(sample), sample.stamp_ns);
}

// Counts what became of a sample.
std::optional<Rejection> RootMessages::report(TrackGroup::Verdict verdict, std::int64_t stamp_ns) {
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
      news_ = News::kGap;
      return std::nullopt;
    case Verdict::kRestartedBack:
      counters_.root_restarts.add();
      news_ = News::kRestart;
      restart_stamp_ns_ = stamp_ns;
      return std::nullopt;
  }
  return std::nullopt;
}

RootMessages::News RootMessages::takeNews() {
  const News news = news_;
  news_ = News::kNone;
  return news;
}

std::string RootMessages::gapText() const {
  return "a gap of " + numberText(course_->interval()) + " s, longer than " +
         privateName("estimator/max_gap") + " = " + numberText(max_gap_) +
         " s: the root's motion is estimated anew";
}

std::string RootMessages::restartText() const {
  return "time went back to stamp " + stampText(restart_stamp_ns_) +
         ": the root's motion is estimated anew";
}

std::string RootMessages::problem(const std::string& topic) const {
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
