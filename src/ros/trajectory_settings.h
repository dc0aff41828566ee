#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ros/private_parameters.h"
#include "virtual_work_dynamics/motion_law.h"

namespace virtual_work_dynamics {

/// What a trajectory publisher plays, and how (config/trajectory_publisher.yaml).
struct TrajectorySettings {
  std::vector<std::string> joints;
  std::shared_ptr<const MotionLaw> law;
  double rate = 0;             ///< samples per second, Hz
  bool as_trajectory = false;  ///< one JointTrajectory rather than a stream of JointStates
  bool velocities = true;      ///< in JointStates
  bool zero_stamp = false;     ///< of the JointTrajectory
  bool loop = false;
  int wait_for_subscribers = 0;
  double start_delay = 0;  ///< s
  double linger = 0;       ///< s
};

/// Reads the settings; what is not set has the values of config/trajectory_publisher.yaml.
/// @throws ParameterError naming a parameter that is unknown, or has the wrong type, length or
/// value;
///   MotionError, FileError as the motion law and the CSV reader.
TrajectorySettings readTrajectorySettings(PrivateParameters& parameters);

}  // namespace virtual_work_dynamics
