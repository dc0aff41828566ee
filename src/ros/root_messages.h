#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/time.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
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
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// How the root link moves, by messages, live or recorded. Serves one thread.
class RootMessages {
 public:
  /// What happened with the motion when a message was taken.
  enum class News { kNone, kGap, kRestart };

  /// Without a source, there is no course.
  /// @param mechanism must outlive it, like counters   @param frame_prefix of every frame_id
  /// @param gravity of the scene, m/s^2   @param estimator that of the joints
  RootMessages(const RootSettings& settings, const Mechanism& mechanism,
               const std::string& frame_prefix, const Eigen::Vector3d& gravity,
               const EstimatorSettings& estimator, Counters& counters);

  // Each take() takes a message of the type of the source, and returns why it is to be dropped, or
  // nothing. `receipt` stands for a stamp of zero of a trajectory.

  std::optional<Rejection> take(const trajectory_msgs::MultiDOFJointTrajectory& message,
                                ros::Time receipt);
  std::optional<Rejection> take(const tf2_msgs::TFMessage& message, ros::Time receipt);
  std::optional<Rejection> take(const sensor_msgs::Imu& message, ros::Time receipt);
  std::optional<Rejection> take(const sensor_msgs::MultiDOFJointState& message, ros::Time receipt);
  std::optional<Rejection> take(const nav_msgs::Odometry& message, ros::Time receipt);
  /// Takes transforms of /tf_static, and says of each that is dropped why.
  void takeStatic(const tf2_msgs::TFMessage& message,
                  const std::function<void(const Rejection&)>& drop);

  /// Once for each gap and restart.
  News takeNews();
  /// What is doubtful about the latest message; empty: nothing.
  std::string takeDoubt() { return imu_ ? imu_conversion_.takeDoubt() : conversion_.takeDoubt(); }
  std::string gapText() const;
  std::string restartText() const;

  /// How the root moves; null without a source.
  RootCourse* course() const { return course_; }
  const RootSettings& settings() const { return settings_; }
  const std::string& link() const { return conversion_.link(); }
  const std::string& inertialFrame() const { return conversion_.inertialFrame(); }
  /// Whether a message names the root link, of which it so tells.
  bool isOfRoot(const sensor_msgs::MultiDOFJointState& message) const;
  /// Why the motion of the root is not known at an instant, in one line.
  std::string problem(const std::string& topic) const;

 private:
  template <typename Message>
  std::optional<Rejection> takePose(const Message& message);
  std::optional<Rejection> report(TrackGroup::Verdict verdict, std::int64_t stamp_ns);

  const Mechanism& mechanism_;
  const RootSettings settings_;
  const double max_gap_;  // s
  Counters& counters_;
  RootConversion conversion_;
  std::unique_ptr<RootEstimator> estimator_;    // of poses, or null
  std::unique_ptr<RootTrajectory> trajectory_;  // of trajectories, or null
  ImuConversion imu_conversion_;
  std::unique_ptr<RootImu> imu_;        // of an inertial measurement unit, or null
  std::unique_ptr<RootFrames> frames_;  // of tf, or null
  RootCourse* course_ = nullptr;        // the one that there is
  std::vector<RootPoint> points_;
  News news_ = News::kNone;
  std::int64_t restart_stamp_ns_ = 0;
};

}  // namespace virtual_work_dynamics
