#include "replay/bag_run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "bag/bag_connections.h"
#include "bag/bag_reader.h"
#include "bag/bag_writer.h"
#include "bag/joint_state_bytes.h"
#include "base/output_file.h"
#include "base/printable.h"
#include "offline/bag_topic.h"
#include "offline/check_report.h"
#include "offline/inputs.h"
#include "offline/progress.h"
#include "offline/state_motion.h"
#include "offline/task_inputs.h"
#include "replay/bag_topics.h"
#include "replay/dumped_parameters.h"
#include "replay/input_topics.h"
#include "replay/replayed_states.h"
#include "ros/robot_task.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// The parameters of the node, with those that options of the command line stand for.
XmlRpc::XmlRpcValue parameterTree(const Arguments& arguments) {
  XmlRpc::XmlRpcValue tree = parametersFrom(arguments.inputs->parameters);
  if (arguments.root_source.empty()) return tree;
  PrivateParameters(tree).raw("root");  // refuses what is no map
  if (tree.valid() && tree.hasMember("root") &&
      tree["root"].getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    throw parameterError("root", "expected a map of parameters");
  }
  tree["root"]["source"] = arguments.root_source;
  return tree;
}

InverseDynamicsParameters nodeParameters(const Arguments& arguments) {
  try {
    return readInverseDynamicsParameters(PrivateParameters(parameterTree(arguments)),
                                         arguments.inputs->scene);
  } catch (const SceneError& error) {
    throw SceneError(scenePrefix(arguments) + error.what());
  } catch (const ParameterError& error) {
    throw ParameterError((arguments.rosparam.empty() ? "" : arguments.rosparam + ": ") +
                         error.what());
  }
}

InverseDynamicsParameters parametersOf(const Arguments& arguments) {
  InverseDynamicsParameters parameters = nodeParameters(arguments);
  parameters.robot_description = arguments.inputs->description;
  parameters.robot_description_key = arguments.inputs->description_name;
  if (arguments.gravity && parameters.root.source == RootSource::kImu) {
    throw UsageError("--gravity: with the root's motion from an IMU it is measured");
  }
  replaceInScene(arguments, parameters.scene);
  const CompletionSettings& asked = arguments.recording.completion;
  if (std::isfinite(asked.lag)) parameters.estimator.lag = asked.lag;
  if (asked.max_gap != CompletionSettings().max_gap) parameters.estimator.max_gap = asked.max_gap;
  NoiseSettings& noise = parameters.estimator.noise;
  const auto replace = [](double given, double& value) {
    if (given >= 0) value = given;
  };
  replace(asked.noise.position_noise, noise.position_noise);
  replace(asked.noise.velocity_noise, noise.velocity_noise);
  replace(asked.noise.stamp_noise, noise.stamp_noise);
  replace(asked.noise.bandwidth, noise.bandwidth);
  for (const auto& [name, position] : arguments.recording.rest) {
    parameters.rest.push_back({name, position});
  }
  if (arguments.observer_gain) parameters.external.observer_gain = *arguments.observer_gain;
  if (arguments.loop_tolerance) parameters.loop_limits.tolerance = *arguments.loop_tolerance;
  return parameters;
}

RobotTask taskOf(const Arguments& arguments, const InverseDynamicsParameters& parameters) {
  try {
    return RobotTask(parameters);
  } catch (const SceneError& error) {
    throw SceneError(scenePrefix(arguments) + error.what());
  }
}

Audience audienceOf(const RobotTask& task, const Arguments& arguments, bool of_trajectories) {
  Audience audience;
  for (std::size_t i = 0; i < task.outputs.size(); ++i) {
    const Output& output = *task.outputs[i];
    if (output.isForLooking()) continue;
    if (output.ofTrajectories() && !of_trajectories) continue;
    if (output.ofDeviations() && !arguments.deviations) continue;
    if (output.ofMeasuredEfforts() && !arguments.residuals) continue;
    audience.push_back(i);
  }
  return audience;
}

// A bag with topics that are to be written would have each result twice.
void refuseTopics(const std::vector<std::string>& files, const std::vector<std::string>& names) {
  for (const std::string& file : files) {
    for (const BagConnection& connection : connectionsOf(file).connections) {
      if (connection.topic == "/tf_static" || connection.topic == "/tf" ||
          std::find(names.begin(), names.end(), connection.topic) == names.end()) {
        continue;
      }
      throw FileError(file + ": has a topic " + inQuotes(connection.topic) +
                      " already, which --copy-input would mix with the new one: --node NAME gives "
                      "that another name");
    }
  }
}

// Copies messages with their connections.
class Copy {
 public:
  explicit Copy(BagWriter& writer) : writer_(writer) {}
  void write(const BagMessage& message) {
    const auto found = numbers_.find(message.connection);
    const std::uint32_t number =
        found != numbers_.end()
            ? found->second
            : numbers_.emplace(message.connection, writer_.add(*message.connection)).first->second;
    writer_.write(number, message.time_ns, message.bytes);
  }

 private:
  BagWriter& writer_;
  std::unordered_map<const BagConnection*, std::uint32_t> numbers_;
};

// The topic of joint states; empty where the recording only has trajectories.
std::string statesTopic(const Arguments& arguments, const InputTopics& topics,
                        const ReplayedStates& states) {
  const bool none = arguments.motion.topic.empty() && !topics.hasType(kJointStateType);
  return none && !states.trajectoryTopic().empty() ? "" : jointStateTopic(arguments.motion);
}

void requireResults(const ReplayedStates& states, const RobotTask& task, const std::string& where) {
  if (states.results() > 0) return;
  const bool planned = states.mainTopic() == states.trajectoryTopic();
  throw FileError(where + ": no result of " + states.messages() +
                  (planned ? ""
                           : "; a result comes when each of " +
                                 namesInQuotes(task.mechanism.coordinateNames()) +
                                 " has been seen, and the lag has passed"));
}

// What is said in the end.
void noteResults(const ReplayedStates& states, const BagTopics& topics, const std::string& where) {
  std::cerr << "note: " << printable(where) << ": " << states.messages() << "; " << topics.written()
            << "\n";
}

// Reads the parts of a recording one after the other.
class Replay {
 public:
  Replay(const Arguments& arguments, ReplayedStates& states, BagTopics& topics, BagWriter& writer)
      : copy_input_(arguments.copy_input), states_(states), topics_(topics), writer_(writer) {}

  void read(const std::string& path) {
    Progress progress(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "computing " + path);
    BagReader reader(path);
    Copy copy(writer_);
    while (reader.next(message_)) {
      progress.update(reader.position(), reader.size());
      if (!started_) topics_.start(message_.time_ns);
      started_ = true;
      if (copy_input_) copy.write(message_);
      states_.take(message_);
    }
    warnOfDamage(reader);
  }
  /// When the message was received that is taken.
  std::int64_t time() const { return message_.time_ns; }

 private:
  const bool copy_input_;
  ReplayedStates& states_;
  BagTopics& topics_;
  BagWriter& writer_;
  BagMessage message_;
  bool started_ = false;
};

}  // namespace

void runToBag(Arguments arguments) {
  refuseToOverwriteInput(arguments);
  arguments.inputs = std::make_shared<const TaskInputs>(readTaskInputs(arguments));
  const InverseDynamicsParameters parameters = parametersOf(arguments);
  const RobotTask task = taskOf(arguments, parameters);
  printDoubts(std::cerr, task.mechanism);
  if (arguments.observer_gain && !task.not_observed.empty()) {
    throw SceneError(scenePrefix(arguments) + task.not_observed);
  }
  for (const std::string& file : arguments.motion.files) {
    if (!looksLikeBag(file)) {
      throw FileError(file + ": is not a bag, and --output is one: results of CSV are CSV");
    }
  }
  const std::vector<std::string> files = bagParts(arguments.motion);
  InputTopics inputs(arguments.motion, arguments.node, arguments.remap);
  const Replay* replay = nullptr;
  BagTopics* written = nullptr;
  ReplayedStates states(task, parameters, arguments.motion,
                        [&](const ActivePlan& plan, bool of_trajectories) {
                          written->write(plan, of_trajectories, replay->time());
                        });
  states.listen(inputs);
  inputs.refuseUnused();
  const std::string topic = statesTopic(arguments, inputs, states);
  if (!topic.empty()) states.setJointStates(topic);
  const Audience audience = audienceOf(task, arguments, !states.trajectoryTopic().empty());
  states.setAudience(audience);

  OutputFile file(arguments.output);
  if (!file.canRewrite()) throw FileError(arguments.output + ": a bag is written to a file only");
  BagWriter writer(file);
  BagTopics topics(task, audience, arguments.node, writer);
  if (arguments.copy_input) refuseTopics(files, topics.names());
  Replay all(arguments, states, topics, writer);
  written = &topics;
  replay = &all;
  for (const std::string& path : files) all.read(path);
  const std::string name = arguments.motion.name();
  const std::string where = name + ": " + states.mainTopic();
  states.finish();
  std::cerr << states.report(name);
  requireResults(states, task, where);
  writer.finish();
  noteResults(states, topics, where);
}

}  // namespace virtual_work_dynamics
