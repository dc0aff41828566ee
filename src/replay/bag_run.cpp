#include "replay/bag_run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>
#include <unordered_map>
#include <vector>

#include "bag/bag_connections.h"
#include "bag/bag_reader.h"
#include "bag/bag_writer.h"
#include "base/output_file.h"
#include "base/printable.h"
#include "base/text_file.h"
#include "offline/bag_topic.h"
#include "offline/check_report.h"
#include "offline/inputs.h"
#include "offline/progress.h"
#include "offline/state_motion.h"
#include "replay/bag_topics.h"
#include "replay/replayed_states.h"
#include "ros/robot_task.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kLongestDescription = std::size_t{1} << 28;  // bytes

InverseDynamicsParameters parametersOf(const Arguments& arguments) {
  InverseDynamicsParameters parameters;
  parameters.robot_description = readTextFile(arguments.urdf, kLongestDescription);
  parameters.robot_description_key = arguments.urdf;
  parameters.scene = askedScene(arguments);
  const CompletionSettings& asked = arguments.recording.completion;
  if (std::isfinite(asked.lag)) parameters.estimator.lag = asked.lag;
  parameters.estimator.max_gap = asked.max_gap;
  parameters.estimator.noise = asked.noise;
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
    throw SceneError((arguments.scene.empty() ? "" : arguments.scene + ": ") + error.what());
  }
}

// Refuses what is measured by others than the joints.
void refuseOtherInputs(const Arguments& arguments, const RobotTask& task) {
  if (task.scene.root_moves) {
    throw SceneError(arguments.scene +
                     ": root: moving: its motion is not read from bags; play the bag to the node");
  }
  if (task.mechanism.orientations() > 0) {
    throw SceneError("joint " + inQuotes(task.mechanism.freeJoint(0).name) +
                     ": turns freely, and its orientation is not read from bags; play the bag to "
                     "the node");
  }
  if (!task.wrench_topics.empty()) {
    throw SceneError(arguments.scene +
                     ": live wrenches are not read from bags; play the bag to the node");
  }
}

Audience audienceOf(const RobotTask& task, const Arguments& arguments) {
  Audience audience;
  for (std::size_t i = 0; i < task.outputs.size(); ++i) {
    const Output& output = *task.outputs[i];
    if (output.ofTrajectories() || output.isForLooking()) continue;
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
      if (connection.topic == "/tf_static" ||
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

}  // namespace

void runToBag(const Arguments& arguments) {
  refuseToOverwriteInput(arguments);
  printDoubts(std::cerr, readUrdfFile(arguments.urdf));
  const InverseDynamicsParameters parameters = parametersOf(arguments);
  const RobotTask task = taskOf(arguments, parameters);
  refuseOtherInputs(arguments, task);
  if (arguments.observer_gain && !task.not_observed.empty()) {
    throw SceneError((arguments.scene.empty() ? "" : arguments.scene + ": ") + task.not_observed);
  }
  for (const std::string& file : arguments.motion.files) {
    if (!looksLikeBag(file)) {
      throw FileError(file + ": is not a bag, and --output is one: results of CSV are CSV");
    }
  }
  const std::vector<std::string> files = bagParts(arguments.motion);
  const std::string topic = jointStateTopic(arguments.motion);
  const std::string where = arguments.motion.name() + ": " + topic;
  const Audience audience = audienceOf(task, arguments);

  OutputFile file(arguments.output);
  if (!file.canRewrite()) throw FileError(arguments.output + ": a bag is written to a file only");
  BagWriter writer(file);
  BagTopics topics(task, audience, arguments.node, writer);
  if (arguments.copy_input) refuseTopics(files, topics.names());
  BagMessage message;
  ReplayedStates states(task, arguments.motion, parameters.loop_limits, audience,
                        [&](const ActivePlan& plan) { topics.write(plan, message.time_ns); });
  std::size_t number = 0;
  bool started = false;
  JointStateContent content;
  for (const std::string& path : files) {
    Progress progress(std::cerr, ProgressLine::whereIs(STDERR_FILENO), "computing " + path);
    BagReader reader(path);
    Copy copy(writer);
    while (reader.next(message)) {
      progress.update(reader.position(), reader.size());
      if (!started) topics.start(message.time_ns);
      started = true;
      if (arguments.copy_input) copy.write(message);
      if (message.connection->topic != topic) continue;
      ++number;
      if (readJointState(message.bytes, content)) {
        states.take(content, number);
      } else {
        states.refuse(number, "its bytes are not those of a joint state");
      }
    }
    warnOfDamage(reader);
  }
  std::cerr << states.report(where);
  if (states.results() == 0) {
    throw FileError(where + ": no result of " + std::to_string(number) +
                    " messages; a result comes when each of " +
                    namesInQuotes(task.mechanism.coordinateNames()) + " has been seen, and " +
                    "the lag has passed");
  }
  writer.finish();
  std::cerr << "note: " << printable(where) << ": " << number << " messages, " << states.results()
            << " results each on " << namesInQuotes(topics.names()) << "\n";
}

}  // namespace virtual_work_dynamics
