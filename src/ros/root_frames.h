#pragma once

#include <geometry_msgs/TransformStamped.h>

#include <string>

#include "ros/tf_record.h"

namespace virtual_work_dynamics {

/// The transform from one frame to another as the messages of /tf and /tf_static tell it, over
/// however many frames. Nothing waits.
class RootFrames {
 public:
  /// @param max_gap s by which a frame's stamps go back when time does
  RootFrames(std::string inertial_frame, std::string link, double max_gap);

  /// Takes transforms that RootConversion has found to be sound.
  void take(const geometry_msgs::TransformStamped& transform, bool is_static);
  /// Finds the transform at the latest instant at which it is known. Returns false where it is not
  /// known, or is the one found before.
  bool findNew(geometry_msgs::TransformStamped& found);
  /// Why there is no transform yet, in one line; empty where there is one.
  std::string problem() const;

 private:
  const std::string inertial_frame_, link_;
  TfRecord record_;
  ros::Time found_;
};

}  // namespace virtual_work_dynamics
