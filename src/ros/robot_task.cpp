#include "ros/robot_task.h"

#include <ros/console.h>

#include <cmath>
#include <limits>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "dynamics/given_joints.h"
#include "robot/effort_limits.h"
#include "ros/closure_frames.h"
#include "ros/delivered_efforts.h"
#include "ros/given_lengths.h"
#include "ros/loop_report.h"
#include "ros/message_text.h"
#include "ros/private_name.h"
#include "ros/private_parameters.h"
#include "ros/start_position.h"
#include "ros/topic_names.h"
#include "scene/scene_units.h"
#include "virtual_work_dynamics/closure_axes.h"
#include "virtual_work_dynamics/drives.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/momentum_observer.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

SceneOfMechanism readRobot(const InverseDynamicsParameters& parameters) {
  try {
    return mechanismFor(readUrdf(parameters.robot_description), parameters.scene);
  } catch (const UrdfError& error) {
    throw UrdfError("parameter " + parameters.robot_description_key + ": " + error.what());
  }
}

// Checks the settings before anything is advertised; the estimator names a wrong one itself.
EstimatorSettings checkedSettings(const Mechanism& mechanism, EstimatorSettings settings,
                                  const Scene& scene) {
  try {
    const MotionEstimator check(mechanism, settings);
  } catch (const MotionError& error) {
    throw parameterError("estimator", error.what());
  }
  settings.estimate = settings.estimate && !scene.static_motion;
  return settings;
}

std::vector<std::pair<int, double>> restOf(const Mechanism& mechanism, const Scene& scene,
                                           const std::vector<RestingJoint>& joints) {
  std::vector<std::pair<int, double>> rest;
  for (const RestingJoint& joint : joints) {
    const int coordinate = mechanism.coordinateIndex(joint.name);
    if (coordinate < 0) {
      throw parameterError("rest", "robot " + inQuotes(mechanism.name()) + " has no joint " +
                                       inQuotes(joint.name) + " that moves by itself" +
                                       nameHelp(joint.name, mechanism.coordinateNames()));
    }
    for (const DriveLaw& drive : scene.drives) {
      if (drive.name != joint.name) continue;
      throw parameterError("rest", inQuotes(joint.name) + " has a drive, which says how it moves");
    }
    rest.emplace_back(coordinate, joint.position);
  }
  return rest;
}

std::vector<std::string> liveWrenches(const Scene& scene) {
  std::vector<std::string> names;
  for (const AppliedWrench& wrench : scene.applied_wrenches) {
    if (wrench.live) names.push_back(wrench.name);
  }
  return names;
}

// Compiles all that the scene asks for.
Dynamics movableDynamics(const Mechanism& mechanism, const Scene& scene, const std::string& key) {
  if (mechanism.coordinates().empty()) {
    throw UrdfError("parameter " + key + ": robot " + inQuotes(mechanism.name()) +
                    " has no joint that moves");
  }
  Request request;
  request.child_axes = request.root_axes = requestedReactions(mechanism, scene);
  request.child_axes_about_origin = true;  // see requestFor()
  request.can_hold = scene.contact_intervals;
  return Dynamics(mechanism, scene, request);
}

// Why a momentum observer cannot follow the joint states; empty when it can.
std::string whyNotObserved(const Mechanism& mechanism, const Scene& scene, double gain) {
  try {
    const MomentumObserver check(mechanism, scene, gain);
  } catch (const SceneError& error) {
    return error.what();
  }
  // It is at the newest joint state, and these are known behind it.
  if (!scene.drives.empty()) return "momentum observer: what has a drive is not observed live";
  if (scene.root_moves) return "momentum observer: a root that moves is not observed live";
  if (!liveWrenches(scene).empty()) return "momentum observer: live wrenches are not observed";
  return "";
}

// Why a coordinate never has an external effort; empty when it may have one.
std::string whyNotMeasured(const Mechanism& mechanism, const Dynamics& dynamics, int coordinate) {
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    const int angle = coordinate - mechanism.anglesOf(i);
    if (angle >= 0 && angle < 3) {
      return "is an angle of " + inQuotes(mechanism.freeJoint(i).name) +
             ", a joint that turns freely, whose efforts joint states do not have";
    }
  }
  const auto place = static_cast<std::size_t>(coordinate);
  return deliveredEfforts(dynamics)[place] ? "" : "is passive: no actuator delivers its effort";
}

// The record of the thresholds, if there are any.
std::shared_ptr<ThresholdRecord> externalRecord(const Mechanism& mechanism,
                                                const Dynamics& dynamics,
                                                const ExternalEffortSettings& asked,
                                                double max_gap) {
  if (asked.thresholds.empty()) return nullptr;
  std::vector<double> thresholds(mechanism.coordinates().size(),
                                 std::numeric_limits<double>::infinity());
  for (const auto& [name, effort] : asked.thresholds) {
    const int coordinate = mechanism.coordinateIndex(name);
    if (coordinate < 0) {
      throw parameterError("external_effort/thresholds",
                           "robot " + inQuotes(mechanism.name()) + " has no joint " +
                               inQuotes(name) + " that moves by itself" +
                               nameHelp(name, mechanism.coordinateNames()));
    }
    const std::string problem = whyNotMeasured(mechanism, dynamics, coordinate);
    if (!problem.empty()) {
      throw parameterError("external_effort/thresholds", inQuotes(name) + " " + problem);
    }
    double& threshold = thresholds[static_cast<std::size_t>(coordinate)];
    if (std::isfinite(threshold)) {
      throw parameterError("external_effort/thresholds", inQuotes(name) + " is given twice");
    }
    threshold = effort;
  }
  return std::make_shared<ThresholdRecord>(mechanism.coordinateNames(), thresholds, asked.hold,
                                           max_gap);
}

// The record of efforts beyond the description's limits.
std::shared_ptr<ThresholdRecord> limitRecord(const Mechanism& mechanism, const Dynamics& dynamics,
                                             double max_gap) {
  std::vector<double> limits = effortLimits(mechanism);
  const std::vector<bool> delivered = deliveredEfforts(dynamics);
  bool any = false;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    if (!delivered[i]) limits[i] = std::numeric_limits<double>::infinity();
    any = any || std::isfinite(limits[i]);
  }
  if (!any) {
    throw parameterError("effort_limit_warn", "robot " + inQuotes(mechanism.name()) +
                                                  " has no actuated joint with a limit of effort");
  }
  return std::make_shared<ThresholdRecord>(mechanism.coordinateNames(), limits, 0, max_gap);
}

}  // namespace

RobotTask::RobotTask(const InverseDynamicsParameters& parameters)
    : RobotTask(parameters, readRobot(parameters)) {}

RobotTask::RobotTask(const InverseDynamicsParameters& parameters, const SceneOfMechanism& robot)
    : mechanism(robot.mechanism),
      scene(assembledScene(mechanism, robot.scene, parameters.start_patience)),
      reactions(requestedReactions(mechanism, scene)),
      reaction_topics(reactionTopics(reactions)),
      wrench_topics(wrenchTopics(liveWrenches(scene))),
      estimator(checkedSettings(mechanism, parameters.estimator, scene)),
      rest(restOf(mechanism, scene, parameters.rest)),
      everything(movableDynamics(mechanism, scene, parameters.robot_description_key)) {
  requireLengths(mechanism, scene, everything.given());
  lengths = givenLengths(mechanism, scene, everything.given());
  closure_frames = closureFrames(mechanism, scene, reactions, parameters.frame_prefix);
  deviations = std::make_shared<DeviationRecord>(everything.effortNames(), everything.residuals(),
                                                 mechanism.coordinateNames(), otherCauses(scene));
  efforts = std::make_shared<EffortMeasurements>(mechanism.coordinateNames(), estimator.max_gap);
  for (const auto& [coordinate, position] : rest) efforts->setRest(coordinate, position);
  const ExternalEffortSettings& asked = parameters.external;
  not_observed = whyNotObserved(mechanism, scene, asked.observer_gain);
  if (asked.observed && !not_observed.empty()) {
    throw parameterError("external_effort/by", "observer: " + not_observed);
  }
  external = externalRecord(mechanism, everything, asked, estimator.max_gap);
  if (asked.effort_limits) limits = limitRecord(mechanism, everything, estimator.max_gap);
  outputs = makeOutputs(
      mechanism, everything,
      {reactions, reaction_topics, parameters.frame_prefix, parameters.twist,
       parameters.loop_limits.condition, scene, deviates() ? deviations : nullptr,
       parameters.marker_rate, parameters.root, efforts, external, limits, asked.observed,
       not_observed.empty() ? asked.observer_gain : 0, estimator.max_gap});
  plan_lines = everything.closed()
                   ? loopLines(mechanism, scene, everything, parameters.loop_limits.condition)
                   : everything.summary().lines();
}

bool RobotTask::deviates() const {
  return everything.given().drivenNumbers() == 0;
}

std::vector<bool> RobotTask::waitedFor(std::vector<bool> needed) const {
  for (const auto& [coordinate, position] : rest) {
    needed[static_cast<std::size_t>(coordinate)] = false;
  }
  return needed;
}

std::vector<std::string> RobotTask::inputs() const {
  std::vector<std::string> names = mechanism.coordinateNames();
  names.insert(names.end(), lengths.begin(), lengths.end());
  return names;
}

std::vector<std::string> RobotTask::units() const {
  std::vector<std::string> units;
  for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
    units.emplace_back(symbolOf(mechanism.unitOf(static_cast<int>(i))));
  }
  units.resize(units.size() + lengths.size(), symbolOf(Unit::kMetre));
  return units;
}

std::vector<bool> RobotTask::following() const {
  std::vector<bool> follow = GivenJoints::resting(everything);
  follow.flip();
  const std::vector<bool> driven = Drives(mechanism, scene).coordinates();
  for (std::size_t i = 0; i < follow.size(); ++i) follow[i] = follow[i] || driven[i];
  if (!GivenJoints::givesAll(everything.given())) return follow;
  for (const auto& [joint, actuators] : scene.actuators_of) {
    for (const std::string& name : actuators) {
      follow[static_cast<std::size_t>(mechanism.coordinateIndex(name))] = true;
    }
  }
  return follow;
}

void RobotTask::log(const InverseDynamicsParameters& parameters) const {
  for (const Doubt& doubt : mechanism.doubts()) ROS_WARN("%s", printable(doubt.text).c_str());
  for (const std::string& doubt : sceneUnitDoubts(mechanism, scene)) {
    ROS_WARN("%s", printable(doubt).c_str());
  }
  for (const std::string& doubt : everything.assemblyDoubts()) {
    ROS_WARN("%s", printable(doubt).c_str());
  }
  const auto& names = mechanism.coordinateNames();
  const Eigen::Vector3d& g = scene.gravity;
  const std::string accelerations =
      scene.static_motion   ? "static scene without velocities and accelerations"
      : !estimator.estimate ? "accelerations of joint states taken as zero"
                            : "accelerations of joint states estimated " +
                                  numberText(estimator.lag) + " s behind the newest";
  ROS_INFO(
      "Robot '%s' from %s: %zu coordinates (%s), %zu reactions (%s); gravity [%s, %s, %s] m/s^2; "
      "%s; %s",
      shortened(mechanism.name()).c_str(), parameters.robot_description_key.c_str(), names.size(),
      shortList(names).c_str(), reactions.size(),
      reactions.empty() ? "none" : shortList(reactions).c_str(), numberText(g.x()).c_str(),
      numberText(g.y()).c_str(), numberText(g.z()).c_str(), accelerations.c_str(),
      parameters.scene_given ? ("scene from " + privateName("scene")).c_str() : "default scene");
  const std::vector<std::string> exact = exactWrenches(scene);
  if (!exact.empty()) {
    ROS_INFO("%s takes as exact the applied wrenches that the scene gives no deviation: %s",
             privateName("effort_deviation").c_str(), shortList(exact).c_str());
  }
  if (!deviates()) {
    ROS_INFO("%s is not offered: axes of closures have drives, or lengths are given",
             privateName("effort_deviation").c_str());
  }
  if (!not_observed.empty()) {
    ROS_INFO("%s is not offered: %s", privateName("external_effort").c_str(),
             printable(not_observed).c_str());
  }
  std::string plan;
  for (const std::string& line : plan_lines) plan += (plan.empty() ? "" : "\n  ") + line;
  ROS_INFO("With subscribers to everything (%s instructions): %s",
           toString(chosenInstructionSet()).c_str(), plan.c_str());
}

}  // namespace virtual_work_dynamics
