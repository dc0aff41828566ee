#include "ros/trajectory_publisher.h"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace virtual_work_dynamics {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

// Number of messages for which a subscriber may stall without losing any.
constexpr std::uint32_t kStateQueue = 10000;
constexpr std::uint32_t kTrajectoryQueue = 100;
constexpr std::chrono::milliseconds kShutdownCheck{50};
constexpr std::chrono::milliseconds kSubscriberCheck{5};

/// Sleeps until the deadline. @returns false when ROS shuts down before it.
bool sleepUntil(Clock::time_point deadline) {
  for (auto now = Clock::now(); ros::ok() && now < deadline; now = Clock::now()) {
    std::this_thread::sleep_until(std::min(deadline, now + kShutdownCheck));
  }
  return ros::ok();
}

bool sleepFor(double seconds) {
  return sleepUntil(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(seconds)));
}

ros::Time after(const ros::Time& start, std::int64_t ns) {
  ros::Time stamp;
  return stamp.fromNSec(start.toNSec() + static_cast<std::uint64_t>(ns));
}

void copy(const Eigen::VectorXd& from, std::vector<double>& to) {
  to.assign(from.data(), from.data() + from.size());
}

trajectory_msgs::JointTrajectory sampled(const TrajectorySettings& settings,
                                         const SampleTimes& samples) {
  trajectory_msgs::JointTrajectory trajectory;
  trajectory.joint_names = settings.joints;
  trajectory.points.resize(static_cast<std::size_t>(samples.last()) + 1);
  Motion motion;
  std::int64_t k = 0;
  for (trajectory_msgs::JointTrajectoryPoint& point : trajectory.points) {
    settings.law->evaluate(samples.time(k), motion);
    copy(motion.q, point.positions);
    copy(motion.qd, point.velocities);
    copy(motion.qdd, point.accelerations);
    point.time_from_start.fromNSec(samples.offset(k));
    ++k;
  }
  return trajectory;
}

}  // namespace

TrajectoryPublisher::TrajectoryPublisher(ros::NodeHandle node, TrajectorySettings settings)
    : settings_(std::move(settings)),
      samples_(settings_.law->duration(), settings_.rate),
      root_(node, settings_.root) {
  if (settings_.as_trajectory) {
    publisher_ =
        node.advertise<trajectory_msgs::JointTrajectory>("joint_trajectory", kTrajectoryQueue);
  } else {
    publisher_ = node.advertise<sensor_msgs::JointState>("joint_states", kStateQueue);
  }
}

void TrajectoryPublisher::run() {
  if (!waitForSubscribers() || !sleepFor(settings_.start_delay)) return;
  ros::Time::waitForValid();
  const std::int64_t count = settings_.as_trajectory ? playTrajectories() : playStates();
  ROS_INFO("published %lld message%s on %s", static_cast<long long>(count), count == 1 ? "" : "s",
           publisher_.getTopic().c_str());
  sleepFor(settings_.linger);
}

bool TrajectoryPublisher::waitForSubscribers() const {
  const auto wanted = static_cast<std::uint32_t>(settings_.wait_for_subscribers);
  if (publisher_.getNumSubscribers() < wanted) {
    ROS_INFO("waiting for %u subscriber%s of %s", wanted, wanted == 1 ? "" : "s",
             publisher_.getTopic().c_str());
  }
  while (ros::ok() && publisher_.getNumSubscribers() < wanted) {
    std::this_thread::sleep_for(kSubscriberCheck);
  }
  return ros::ok();
}

std::int64_t TrajectoryPublisher::playStates() {
  sensor_msgs::JointState state;
  state.name = settings_.joints;
  Motion motion;
  std::int64_t count = 0;
  const ros::Time start = ros::Time::now();
  const Clock::time_point steady_start = Clock::now();
  // Later rounds begin with their second sample, as the first is the end of the round before.
  for (std::int64_t round = 0, k = 0; round == 0 || settings_.loop; ++round, k = 1) {
    for (; k <= samples_.last(); ++k) {
      const std::int64_t offset = round * samples_.durationNs() + samples_.offset(k);
      settings_.law->evaluate(samples_.time(k), motion);
      state.header.stamp = after(start, offset);
      copy(motion.q, state.position);
      if (settings_.velocities) copy(motion.qd, state.velocity);
      if (!sleepUntil(steady_start + nanoseconds(offset))) return count;
      root_.publish(samples_.time(k), state.header.stamp);
      publisher_.publish(state);
      ++count;
    }
  }
  return count;
}

std::int64_t TrajectoryPublisher::playTrajectories() {
  trajectory_msgs::JointTrajectory trajectory = sampled(settings_, samples_);
  const auto pause_ns = static_cast<std::int64_t>(settings_.loop_pause * 1e9);
  const std::int64_t round_ns = samples_.durationNs() + samples_.stepNs() + pause_ns;
  std::int64_t count = 0;
  const ros::Time start = ros::Time::now();
  const Clock::time_point steady_start = Clock::now();
  for (std::int64_t round = 0; round == 0 || settings_.loop; ++round) {
    if (!sleepUntil(steady_start + nanoseconds(round * round_ns))) break;
    if (!settings_.zero_stamp) trajectory.header.stamp = after(start, round * round_ns);
    root_.publish(samples_, trajectory.header.stamp);
    publisher_.publish(trajectory);
    ++count;
  }
  return count;
}

}  // namespace virtual_work_dynamics
