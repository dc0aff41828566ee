#include "ros/robot_task.h"

#include <ros/console.h>

#include "base/number_text.h"
#include "ros/closure_frames.h"
#include "ros/loop_report.h"
#include "ros/message_text.h"
#include "ros/private_parameters.h"
#include "ros/topic_names.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

Mechanism readRobot(const InverseDynamicsParameters& parameters) {
  try {
    return readUrdf(parameters.robot_description);
  } catch (const UrdfError& error) {
    throw UrdfError("parameter " + parameters.robot_description_key + ": " + error.what());
  }
}

// The estimator names its setting itself; what is wrong must show before anything is advertised.
EstimatorSettings checkedSettings(const Mechanism& mechanism, EstimatorSettings settings,
                                  const Scene& scene) {
  try {
    const MotionEstimator check(mechanism, settings);
  } catch (const MotionError& error) {
    throw ParameterError(std::string("parameters ~estimator: ") + error.what());
  }
  settings.estimate = settings.estimate && !scene.static_motion;
  return settings;
}

}  // namespace

RobotTask::RobotTask(const InverseDynamicsParameters& parameters)
    : mechanism(readRobot(parameters)),
      scene(parameters.scene),
      reactions(requestedReactions(mechanism, scene)),
      reaction_topics(legalTopicNames(reactions)),
      estimator(checkedSettings(mechanism, parameters.estimator, scene)) {
  if (mechanism.coordinates().empty()) {
    throw UrdfError("parameter " + parameters.robot_description_key + ": robot '" +
                    mechanism.name() + "' has no joint that moves");
  }
  closure_frames = closureFrames(mechanism, scene, reactions, parameters.frame_prefix);
  if (needsClosedLoops(scene)) {
    loops = std::make_unique<LoopSamples>(mechanism, scene, reactions, parameters.loop_limits);
    plan_lines = loopLines(mechanism, scene, *loops);
  } else {
    plan_lines = InverseDynamics(mechanism, scene).summary().lines();
  }
}

std::vector<bool> RobotTask::passive() const {
  if (!loops) return {};
  std::vector<bool> passive = loops->completer.actuated();
  passive.flip();
  return passive;
}

std::vector<bool> RobotTask::needed() const {
  if (loops) return loops->completer.needed();
  return std::vector<bool>(mechanism.coordinates().size(), true);
}

void RobotTask::log(const InverseDynamicsParameters& parameters) const {
  for (const Doubt& doubt : mechanism.doubts()) ROS_WARN("%s", doubt.text.c_str());
  const auto& names = mechanism.coordinateNames();
  const Eigen::Vector3d& g = scene.gravity;
  const std::string accelerations =
      scene.static_motion ? "static scene, no velocities nor accelerations"
      : !estimator.estimate
          ? "accelerations of joint states taken as zero"
          : "accelerations of joint states estimated (window " + std::to_string(estimator.window) +
                ", order " + std::to_string(estimator.order) + ", lag " +
                std::to_string(estimator.lag) + ")";
  ROS_INFO(
      "Robot '%s' from %s: %zu coordinates (%s), %zu reactions (%s); gravity [%s, %s, %s] m/s^2; "
      "%s; %s",
      mechanism.name().c_str(), parameters.robot_description_key.c_str(), names.size(),
      shortList(names).c_str(), reactions.size(),
      reactions.empty() ? "none" : shortList(reactions).c_str(), numberText(g.x()).c_str(),
      numberText(g.y()).c_str(), numberText(g.z()).c_str(), accelerations.c_str(),
      parameters.scene_given ? "scene from ~scene" : "default scene");
  std::string plan;
  for (const std::string& line : plan_lines) plan += (plan.empty() ? "" : "\n  ") + line;
  ROS_INFO("With subscribers to everything (%s instructions): %s",
           toString(chosenInstructionSet()).c_str(), plan.c_str());
}

}  // namespace virtual_work_dynamics
