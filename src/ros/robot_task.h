#pragma once

#include <tf2_msgs/TFMessage.h>

#include <memory>
#include <string>
#include <vector>

#include "ros/inverse_dynamics_parameters.h"
#include "ros/outputs.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What the parameters of inverse_dynamics_node make of the robot.
struct RobotTask {
  /// @throws Error, one line naming what is wrong with the robot, the scene or a parameter.
  explicit RobotTask(const InverseDynamicsParameters& parameters);

  /// Tells the log what is to be computed, and of doubtful bodies.
  void log(const InverseDynamicsParameters& parameters) const;

  /// Passive joints, by coordinate; none in an open chain.
  std::vector<bool> passive() const;

  Mechanism mechanism;
  Scene scene;
  std::vector<std::string> reactions;        ///< joints and closures that the scene asks for
  std::vector<std::string> reaction_topics;  ///< their topics
  EstimatorSettings estimator;
  tf2_msgs::TFMessage closure_frames;
  Dynamics everything;  ///< of all that the scene asks for, in both axes
  Outputs outputs;
  std::vector<std::string> plan_lines;  ///< what everything that the scene asks for costs
};

}  // namespace virtual_work_dynamics
