#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "motion/root_estimator.h"
#include "motion/root_imu.h"
#include "motion/root_trajectory.h"
#include "ros/counters.h"
#include "ros/imu_conversion.h"
#include "ros/rejection.h"
#include "ros/root_conversion.h"
#include "ros/root_frames.h"
#include "ros/root_settings.h"
#include "ros/throttle.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The subscription to the messages that tell how the root link moves, and what they tell.
class RootInputs {
 public:
  /// Counts, and says to the user, why a message of a topic is dropped.
  using Drop =
      std::function<void(const std::string& topic, DropReason reason, const std::string& text)>;

  /// Without a source, nothing is subscribed to and there is no course.
  /// @param mechanism must outlive it, like counters   @param frame_prefix of every frame_id
  /// @param gravity of the scene, m/s^2   @param estimator that of the joints
  RootInputs(const RootSettings& settings, const Mechanism& mechanism,
             const std::string& frame_prefix, const Eigen::Vector3d& gravity,
             const EstimatorSettings& estimator, Counters& counters, Drop drop);

  void subscribe(ros::NodeHandle node, std::uint32_t queue);

  /// How the root moves; null without a source.
  RootCourse* course() const { return course_; }
  /// Whether a message names the root link, of which it so tells.
  bool isOfRoot(const sensor_msgs::MultiDOFJointState& message) const;
  /// Why the motion of the root is not known at an instant, in one line.
  std::string problem() const;

 private:
  template <typename Message>
  void listen(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue);
  template <typename Message>
  void receive(const ros::MessageEvent<const Message>& event);
  std::optional<Rejection> take(const trajectory_msgs::MultiDOFJointTrajectory& message,
                                ros::Time receipt);
  std::optional<Rejection> take(const tf2_msgs::TFMessage& message, ros::Time receipt);
  std::optional<Rejection> take(const sensor_msgs::Imu& message, ros::Time receipt);
  std::optional<Rejection> take(const sensor_msgs::MultiDOFJointState& message, ros::Time receipt);
  void takeStatic(const tf2_msgs::TFMessage& message);
  template <typename Message>
  std::optional<Rejection> takePose(const Message& message);
  std::optional<Rejection> take(const nav_msgs::Odometry& message, ros::Time receipt);
  std::optional<Rejection> report(TrackGroup::Verdict verdict, std::int64_t stamp_ns);

  const Mechanism& mechanism_;
  const RootSettings settings_;
  const double max_gap_;  // s
  Counters& counters_;
  const Drop drop_;
  RootConversion conversion_;
  std::unique_ptr<RootEstimator> estimator_;    // of poses, or null
  std::unique_ptr<RootTrajectory> trajectory_;  // of trajectories, or null
  ImuConversion imu_conversion_;
  std::unique_ptr<RootImu> imu_;        // of an inertial measurement unit, or null
  std::unique_ptr<RootFrames> frames_;  // of tf, or null
  RootCourse* course_ = nullptr;        // the one that there is
  std::vector<RootPoint> points_;
  Throttle restart_throttle_, gap_throttle_;
  ros::Subscriber subscriber_, static_subscriber_;
};

}  // namespace virtual_work_dynamics
