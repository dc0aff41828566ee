#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "motion/root_law.h"
#include "ros/private_parameters.h"
#include "ros/root_settings.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_law.h"

namespace virtual_work_dynamics {

/// How a root link moves beside the joints, and which messages tell it.
struct RootPlay {
  RootSource source = RootSource::kNone;
  std::string inertial_frame, link;  ///< as RootSettings
  Eigen::Vector3d gravity;           ///< that an inertial measurement unit feels, m/s^2
  std::shared_ptr<const RootLaw> law;
};

/// What a trajectory publisher plays and how it does so (config/trajectory_publisher.yaml).
struct TrajectorySettings {
  std::vector<std::string> joints;
  std::shared_ptr<const MotionLaw> law;
  double rate = 0;             ///< samples per second, Hz
  bool as_trajectory = false;  ///< one JointTrajectory rather than a stream of JointStates
  bool velocities = true;      ///< whether JointStates carry velocities
  bool zero_stamp = false;     ///< whether the stamp of the JointTrajectory is zero
  bool loop = false;
  double loop_pause = 0;  ///< s, between the rounds of a JointTrajectory
  int wait_for_subscribers = 0;
  double start_delay = 0;  ///< s
  double linger = 0;       ///< s

  RootPlay root;
};

/// Gives the robot that is described, if there is one.
using RobotSource = std::function<std::optional<Mechanism>()>;

/// Reads the settings; parameters that are not set have the values of
/// config/trajectory_publisher.yaml.
/// @param robot asked, for the law `table` only, which joints are continuous (unwrapPositions());
/// may
///   be empty.
/// @throws ParameterError naming a parameter that is unknown or has a wrong type, length or value,
/// or
///   a file that cannot be read.
TrajectorySettings readTrajectorySettings(PrivateParameters& parameters,
                                          const RobotSource& robot = {});

}  // namespace virtual_work_dynamics
