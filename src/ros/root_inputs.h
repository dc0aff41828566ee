#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "motion/root_estimator.h"
#include "motion/root_trajectory.h"
#include "ros/counters.h"
#include "ros/rejection.h"
#include "ros/root_conversion.h"
#include "ros/root_frames.h"
#include "ros/root_settings.h"
#include "ros/throttle.h"

namespace virtual_work_dynamics {

/// The subscription to the messages that tell how the root link moves, and what they tell.
class RootInputs {
 public:
  /// Counts, and says to the user, why a message of a topic is dropped.
  using Drop =
      std::function<void(const std::string& topic, DropReason reason, const std::string& text)>;

  /// Without a source, nothing is subscribed to and there is no course.
  /// @param root_frame frame_id of the root link   @param estimator that of the joints
  RootInputs(const RootSettings& settings, const std::string& root_frame,
             const EstimatorSettings& estimator, Counters& counters, Drop drop);

  void subscribe(ros::NodeHandle node, std::uint32_t queue);

  /// How the root moves; null without a source.
  RootCourse* course() const { return course_; }
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
  void takeStatic(const tf2_msgs::TFMessage& message);
  template <typename Message>
  std::optional<Rejection> take(const Message& message, ros::Time receipt);
  std::optional<Rejection> push(const RootPose& pose);

  const RootSettings settings_;
  const double max_gap_;  // s
  Counters& counters_;
  const Drop drop_;
  RootConversion conversion_;
  std::unique_ptr<RootEstimator> estimator_;    // of poses, or null
  std::unique_ptr<RootTrajectory> trajectory_;  // of trajectories, or null
  std::unique_ptr<RootFrames> frames_;          // of tf, or null
  RootCourse* course_ = nullptr;                // the one that there is
  std::vector<RootPoint> points_;
  Throttle restart_throttle_, gap_throttle_;
  ros::Subscriber subscriber_, static_subscriber_;
};

}  // namespace virtual_work_dynamics
