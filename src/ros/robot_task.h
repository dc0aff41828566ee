#pragma once

#include <tf2_msgs/TFMessage.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ros/inverse_dynamics_parameters.h"
#include "ros/outputs.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_estimator.h"
#include "virtual_work_dynamics/scene.h"
#include "virtual_work_dynamics/transmissions.h"

namespace virtual_work_dynamics {

/// The robot and the scene of inverse_dynamics_node, as its parameters give them.
struct RobotTask {
  /// @throws Error, one line naming what is wrong with the robot, the scene or a parameter.
  explicit RobotTask(const InverseDynamicsParameters& parameters);

  /// Writes to the log what is to be computed, and warns of doubtful bodies.
  void log(const InverseDynamicsParameters& parameters) const;

  /// The coordinates that joint states have to show: `needed` without those that may rest.
  std::vector<bool> waitedFor(std::vector<bool> needed) const;

  /// Names of the coordinates, then of the lengths that joint states give.
  std::vector<std::string> inputs() const;
  /// rad or m, of each of inputs().
  std::vector<std::string> units() const;

  /// Whether each coordinate is none that a trajectory gives: the closures determine it from those
  /// that motions give, or it has a drive.
  std::vector<bool> following() const;

  /// Whether the deviations of results follow from those of joints: not where axes of closures have
  /// drives or lengths are given.
  bool deviates() const;

  Mechanism mechanism;
  Scene scene;
  std::vector<std::string> reactions;        ///< joints and closures that the scene asks for
  std::vector<std::string> reaction_topics;  ///< their topics
  std::vector<std::string> wrench_topics;    ///< topics of the live wrenches
  EstimatorSettings estimator;
  std::vector<std::string> lengths;          ///< that joint states give, see givenLengths()
  std::vector<std::pair<int, double>> rest;  ///< coordinates and their positions until they come
  tf2_msgs::TFMessage closure_frames;
  Dynamics everything;                          ///< of all that the scene asks for, in both axes
  std::shared_ptr<DeviationRecord> deviations;  ///< of ~effort_deviation
  std::shared_ptr<EffortMeasurements> efforts;  ///< of joint states
  std::shared_ptr<ThresholdRecord> external;    ///< of external efforts; null: no thresholds
  std::shared_ptr<ThresholdRecord> limits;      ///< of efforts; null: limits are not looked at
  std::string not_observed;  ///< why there is no ~external_effort; empty: there is
  Outputs outputs;
  std::vector<std::string> plan_lines;  ///< what everything that the scene asks for costs

 private:
  RobotTask(const InverseDynamicsParameters& parameters, const SceneOfMechanism& robot);
};

}  // namespace virtual_work_dynamics
