#pragma once

#include <tf2_msgs/TFMessage.h>

#include <memory>
#include <string>
#include <vector>

#include "ros/inverse_dynamics_parameters.h"
#include "ros/loop_samples.h"
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

  /// Passive joints, by coordinate; empty in an open chain.
  std::vector<bool> passive() const;
  /// Coordinates that joint states have to show at first.
  std::vector<bool> needed() const;

  Mechanism mechanism;
  Scene scene;
  std::vector<std::string> reactions;        ///< joints and closures that the scene asks for
  std::vector<std::string> reaction_topics;  ///< their topics
  EstimatorSettings estimator;
  tf2_msgs::TFMessage closure_frames;
  std::unique_ptr<LoopSamples> loops;   ///< null: an open chain
  std::vector<std::string> plan_lines;  ///< what everything that the scene asks for costs
};

}  // namespace virtual_work_dynamics
