#include "ros/inverse_dynamics_parameters.h"

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <utility>

#include "base/number_text.h"
#include "base/printable.h"
#include "ros/described_robot.h"
#include "ros/private_name.h"
#include "ros/private_parameters.h"
#include "ros/scene_parameter.h"
#include "ros/trajectory_queue.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

void readRobotDescription(const ros::NodeHandle& node, InverseDynamicsParameters& parameters) {
  std::string& key = parameters.robot_description_key;
  if (!node.searchParam(kRobotDescription, key)) {
    throw ParameterError(std::string("parameter ") + kRobotDescription + ": not set, neither in " +
                         node.getNamespace() +
                         " nor in any namespace above it; robot:=FILE of inverse_dynamics.launch "
                         "sets it");
  }
  if (!node.getParam(key, parameters.robot_description)) {
    throw ParameterError("parameter " + key + ": expected the text of a URDF");
  }
}

// A noise, or what else the estimator finds by itself unless it is given: negative for "auto".
double readOrAuto(PrivateParameters& parameters, const std::string& name, bool may_be_zero) {
  constexpr double kAuto = -1;
  const XmlRpc::XmlRpcValue value = parameters.raw(name);
  if (!value.valid()) return kAuto;
  XmlRpc::XmlRpcValue copy = value;
  if (copy.getType() == XmlRpc::XmlRpcValue::TypeString && std::string(copy) == "auto") {
    return kAuto;
  }
  const double number = numberOf(value, name);
  if (!(may_be_zero ? number >= 0 : number > 0)) {
    throw parameterError(name, numberText(number) + " is neither auto nor " +
                                   (may_be_zero ? "zero or positive" : "positive"));
  }
  return number;
}

// Counts of samples, which fitted one rate and one encoder only.
void refuseOldEstimator(const PrivateParameters& parameters) {
  for (const char* name : {"estimator/window", "estimator/order"}) {
    if (!parameters.has(name)) continue;
    throw parameterError(
        name,
        "no longer exists: the estimator finds noise and bandwidth itself; they can be given as " +
            privateName("estimator/position_noise") +
            ", velocity_noise, stamp_noise and bandwidth, and " + privateName("estimator/lag") +
            " is in seconds");
  }
}

double readPeriod(PrivateParameters& parameters, const std::string& name, double fallback) {
  const double period = parameters.number(name, fallback);
  if (!(period > 0)) throw parameterError(name, numberText(period) + " s is not positive");
  return period;
}

EstimatorSettings readEstimator(PrivateParameters& parameters) {
  refuseOldEstimator(parameters);
  EstimatorSettings settings;
  settings.lag = parameters.number("estimator/lag", settings.lag);
  settings.max_gap = readPeriod(parameters, "estimator/max_gap", settings.max_gap);
  settings.hold_after = readPeriod(parameters, "hold_after", settings.hold_after);
  NoiseSettings& noise = settings.noise;
  noise.use_velocity = parameters.boolean("estimator/use_velocity", noise.use_velocity);
  noise.position_noise = readOrAuto(parameters, "estimator/position_noise", false);
  noise.velocity_noise = readOrAuto(parameters, "estimator/velocity_noise", false);
  noise.stamp_noise = readOrAuto(parameters, "estimator/stamp_noise", true);
  noise.bandwidth = readOrAuto(parameters, "estimator/bandwidth", false);
  const std::string acceleration = parameters.text("estimator/acceleration", "estimate");
  if (acceleration != "estimate" && acceleration != "zero") {
    throw parameterError("estimator/acceleration",
                         inQuotes(acceleration) + " is neither estimate nor zero");
  }
  settings.estimate = acceleration == "estimate";
  return settings;
}

std::vector<RestingJoint> readRest(PrivateParameters& parameters) {
  std::vector<RestingJoint> rest;
  XmlRpc::XmlRpcValue list = parameters.raw("rest");
  if (!list.valid()) return rest;
  constexpr char kForm[] = "expected a list like [{name: finger, position: 0.02}]";
  if (list.getType() != XmlRpc::XmlRpcValue::TypeArray) throw parameterError("rest", kForm);
  for (int i = 0; i < list.size(); ++i) {
    XmlRpc::XmlRpcValue entry = list[i];
    const bool form = entry.getType() == XmlRpc::XmlRpcValue::TypeStruct && entry.size() == 2 &&
                      entry.hasMember("name") && entry.hasMember("position") &&
                      entry["name"].getType() == XmlRpc::XmlRpcValue::TypeString;
    if (!form) throw parameterError("rest", kForm);
    const std::string name = entry["name"];
    rest.push_back({name, numberOf(entry["position"], "rest of " + inQuotes(name))});
  }
  return rest;
}

std::vector<std::pair<std::string, double>> readThresholds(PrivateParameters& parameters) {
  constexpr char kName[] = "external_effort/thresholds";
  constexpr char kForm[] = "expected a list like [{name: elbow, effort: 4.5}]";
  std::vector<std::pair<std::string, double>> thresholds;
  XmlRpc::XmlRpcValue list = parameters.raw(kName);
  if (!list.valid()) return thresholds;
  if (list.getType() != XmlRpc::XmlRpcValue::TypeArray) throw parameterError(kName, kForm);
  for (int i = 0; i < list.size(); ++i) {
    XmlRpc::XmlRpcValue entry = list[i];
    const bool form = entry.getType() == XmlRpc::XmlRpcValue::TypeStruct && entry.size() == 2 &&
                      entry.hasMember("name") && entry.hasMember("effort") &&
                      entry["name"].getType() == XmlRpc::XmlRpcValue::TypeString;
    if (!form) throw parameterError(kName, kForm);
    const std::string name = entry["name"];
    const double effort = numberOf(entry["effort"], kName + (" of " + inQuotes(name)));
    if (!(effort > 0)) {
      throw parameterError(kName, inQuotes(name) + ": " + numberText(effort) + " is not positive");
    }
    thresholds.emplace_back(name, effort);
  }
  return thresholds;
}

ExternalEffortSettings readExternalEffort(PrivateParameters& parameters) {
  ExternalEffortSettings settings;
  settings.thresholds = readThresholds(parameters);
  settings.hold = parameters.number("external_effort/hold", settings.hold);
  if (!(settings.hold >= 0)) {
    throw parameterError("external_effort/hold", numberText(settings.hold) + " s is less than 0");
  }
  const std::string by = parameters.text("external_effort/by", "residual");
  if (by != "residual" && by != "observer") {
    throw parameterError("external_effort/by", inQuotes(by) + " is neither residual nor observer");
  }
  settings.observed = by == "observer";
  settings.observer_gain = parameters.number("external_effort/gain", settings.observer_gain);
  if (!(settings.observer_gain > 0)) {
    throw parameterError("external_effort/gain",
                         numberText(settings.observer_gain) + " 1/s is not positive");
  }
  settings.effort_limits = parameters.boolean("effort_limit_warn", settings.effort_limits);
  return settings;
}

int readQueueSize(PrivateParameters& parameters, const std::string& name, int fallback) {
  const int size = parameters.integer(name, fallback);
  if (size < 1) throw parameterError(name, std::to_string(size) + " is less than 1 message");
  return size;
}

// A rate, or 0 for none.
double readRate(PrivateParameters& parameters, const std::string& name, const std::string& unit,
                double fallback, double fastest) {
  constexpr double kSlowest = 0.001;
  const double rate = parameters.number(name, fallback);
  if (rate != 0 && !(rate >= kSlowest && rate <= fastest)) {
    throw parameterError(name, numberText(rate) + " " + unit + " is neither 0 nor from " +
                                   numberText(kSlowest) + " to " + numberText(fastest));
  }
  return rate;
}

SelfCheckSettings readSelfCheck(PrivateParameters& parameters) {
  SelfCheckSettings settings;
  settings.cross_check_rate =
      readRate(parameters, "cross_check_rate", "checks/s", settings.cross_check_rate, 1000);
  settings.certificates = parameters.boolean("certificates", settings.certificates);
  settings.residual_warn = parameters.number("residual_warn", settings.residual_warn);
  settings.residual_error = parameters.number("residual_error", settings.residual_error);
  if (!(settings.residual_warn > 0)) {
    throw parameterError("residual_warn", numberText(settings.residual_warn) + " is not positive");
  }
  if (!(settings.residual_error >= settings.residual_warn)) {
    throw parameterError("residual_error", numberText(settings.residual_error) + " is less than " +
                                               privateName("residual_warn") + " = " +
                                               numberText(settings.residual_warn));
  }
  return settings;
}

LoopLimits readLoopLimits(PrivateParameters& parameters) {
  LoopLimits limits;
  limits.tolerance = parameters.number("loop_tolerance", limits.tolerance);
  if (!(limits.tolerance > 0)) {
    throw parameterError("loop_tolerance", numberText(limits.tolerance) + " is not positive");
  }
  limits.condition = parameters.number("condition_warn", limits.condition);
  if (!(limits.condition > 1)) {
    throw parameterError("condition_warn", numberText(limits.condition) +
                                               " is not greater than 1, the least condition");
  }
  return limits;
}

double readStartPatience(PrivateParameters& parameters, double fallback) {
  const double patience = parameters.number("start_patience", fallback);
  if (!(patience >= 0)) {
    throw parameterError("start_patience", numberText(patience) + " s is less than 0");
  }
  return patience;
}

double readDriveStart(PrivateParameters& parameters, double fallback) {
  constexpr double kLatest = 9e9;  // whose nanoseconds are a stamp
  const double start = parameters.number("drive_start", fallback);
  if (!(start >= 0 && start <= kLatest)) {
    throw parameterError("drive_start", numberText(start) + " s is no stamp");
  }
  return start;
}

double readDeviationWarn(PrivateParameters& parameters, double fallback) {
  const double warn = parameters.number("deviation_warn", fallback);
  if (!(warn > 0)) throw parameterError("deviation_warn", numberText(warn) + " is not positive");
  return warn;
}

double readMarkerRate(PrivateParameters& parameters, double fallback) {
  constexpr double kSlowest = 0.001, kFastest = 1000;
  const double rate = parameters.number("marker_rate", fallback);
  if (!(rate >= kSlowest && rate <= kFastest)) {
    throw parameterError("marker_rate", numberText(rate) + " Hz is not from " +
                                            numberText(kSlowest) + " to " + numberText(kFastest));
  }
  return rate;
}

RootSettings readRoot(PrivateParameters& parameters) {
  RootSettings settings;
  settings.source = readRootSource(parameters);
  settings.inertial_frame = parameters.text("root/inertial_frame", settings.inertial_frame);
  settings.axes = readRootAxes(parameters, settings.source);
  settings.link = parameters.text("root/link", settings.link);
  settings.timeout = readPeriod(parameters, "root/timeout", settings.timeout);
  return settings;
}

// An inertial measurement unit knows nothing of the attitude, and gravity before all.
void checkImu(const InverseDynamicsParameters& parameters, const YAML::Node& scene) {
  if (parameters.root.source != RootSource::kImu) return;
  const std::string name = privateName("root/source");
  if (scene.IsMap() && scene["gravity"]) {
    throw SceneError("gravity: with " + name + ": imu it is measured, and is not given");
  }
  if (parameters.scene.static_motion) {
    throw SceneError("motion: static: with " + name + ": imu the attitude is not known");
  }
  if (!parameters.estimator.estimate) {
    throw parameterError("estimator/acceleration",
                         "zero: with " + name + ": imu, angular accelerations are estimated");
  }
}

void checkRoot(const RootSettings& root, const Scene& scene) {
  const std::string name = privateName("root/source");
  if (scene.root_moves && root.source == RootSource::kNone) {
    throw SceneError("root: moving: " + name +
                     " does not say who tells how the root link moves: odometry, trajectory, "
                     "states, tf or imu");
  }
  if (!scene.root_moves && root.source != RootSource::kNone) {
    throw parameterError("root/source", "the scene does not say 'root: moving'");
  }
}

}  // namespace

InverseDynamicsParameters readInverseDynamicsParameters(const ros::NodeHandle& private_node) {
  PrivateParameters parameters(private_node);
  const YAML::Node scene = sceneDocument(parameters.raw("scene"));
  InverseDynamicsParameters result = readInverseDynamicsParameters(std::move(parameters), scene);
  readRobotDescription(private_node, result);
  return result;
}

InverseDynamicsParameters readInverseDynamicsParameters(PrivateParameters parameters,
                                                        const YAML::Node& scene) {
  InverseDynamicsParameters result;
  parameters.expect(kRobotDescription);
  parameters.expect("scene");
  result.estimator = readEstimator(parameters);
  result.rest = readRest(parameters);
  result.frame_prefix = parameters.text("frame_prefix", result.frame_prefix);
  result.twist = parameters.boolean("twist", result.twist);
  result.input_queue = readQueueSize(parameters, "queue_size/input", result.input_queue);
  result.output_queue = readQueueSize(parameters, "queue_size/output", result.output_queue);
  result.trajectory_rate = readRate(parameters, "trajectory_rate", "points/s",
                                    result.trajectory_rate, TrajectoryQueue::kFastest);
  result.trajectory_sampling =
      readRate(parameters, "trajectory_sampling", "Hz", result.trajectory_sampling, 100000);
  result.diagnostic_period = readPeriod(parameters, "diagnostic_period", result.diagnostic_period);
  result.wrench_timeout = readPeriod(parameters, "wrench_timeout", result.wrench_timeout);
  result.drive_start = readDriveStart(parameters, result.drive_start);
  result.root = readRoot(parameters);
  result.late_threshold = readPeriod(parameters, "late_threshold", result.late_threshold);
  result.self_check = readSelfCheck(parameters);
  result.external = readExternalEffort(parameters);
  result.loop_limits = readLoopLimits(parameters);
  result.start_patience = readStartPatience(parameters, result.start_patience);
  result.deviation_warn = readDeviationWarn(parameters, result.deviation_warn);
  result.marker_rate = readMarkerRate(parameters, result.marker_rate);
  result.scene_given = parameters.has("scene");
  parameters.refuseUnknown();
  result.scene = readScene(scene);
  checkRoot(result.root, result.scene);
  checkImu(result, scene);
  return result;
}

}  // namespace virtual_work_dynamics
