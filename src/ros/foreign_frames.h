#pragma once

#include <tf2_msgs/TFMessage.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "ros/pose_reading.h"
#include "ros/tf_record.h"
#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// A frame where a wrench is measured: v_link = R v_frame, and its origin in link axes, m.
struct MeasuringFrame {
  int link = 0;  ///< of the robot, or MeasuredWrench::kInertial
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// Frames that are no links of the robot, as tf tells of them. How the robot's own links move, its
/// kinematics know better: a frame that hangs on a link is placed against that link, one that hangs
/// on the inertial frame against this one, and only one on which the robot itself hangs against the
/// root link. Nothing waits.
class ForeignFrames {
 public:
  /// @param mechanism must outlive it   @param frame_prefix of every frame_id
  /// @param inertial_frame that the root moves against, where its pose is known; empty: none
  /// @param max_gap s by which a frame's stamps go back when time does
  ForeignFrames(const Mechanism& mechanism, std::string frame_prefix, std::string inertial_frame,
                double max_gap);

  /// Takes transforms; those with numbers that no transform has are left out.
  void take(const tf2_msgs::TFMessage& message, bool is_static);
  /// The frame at an instant; nothing where tf does not tell, or not yet.
  std::optional<MeasuringFrame> find(const std::string& id, std::int64_t stamp_ns) const;
  /// Whether an instant lies before all that tf tells of the frame, so that waiting is in vain.
  bool isPast(const std::string& id, std::int64_t stamp_ns) const;

 private:
  // Of a frame at an instant: tf begins later; it does not; it does not, and the frame hangs on the
  // robot.
  enum class Known { kLater, kThen, kOnRobot };
  Known known(const std::string& id, std::int64_t stamp_ns) const;
  std::string topOf(const std::string& id) const;
  std::optional<MeasuringFrame> place(int link, const std::string& on, const std::string& id,
                                      const ros::Time& stamp) const;
  int linkOf(const std::string& id) const;

  const Mechanism& mechanism_;
  const std::string frame_prefix_, inertial_frame_;
  PoseReading reading_;
  TfRecord record_;
};

}  // namespace virtual_work_dynamics
