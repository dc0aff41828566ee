#include "offline/bag_topic.h"

#include <algorithm>
#include <map>
#include <utility>

#include "bag/bag_connections.h"
#include "bag/joint_state_bytes.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kUsualTopic[] = "/joint_states";  // of no namespace

using Names = std::vector<std::string>;

void requireJointStates(const MotionSource& source, const BagConnection& connection) {
  const std::string topic = source.name() + ": topic " + inQuotes(connection.topic) + " is of ";
  const std::string type(kJointStateType);
  if (connection.type != type) {
    throw FileError(topic + inQuotes(connection.type) + ", and a motion is read from " + type);
  }
  if (connection.md5sum != kJointStateMd5) {
    throw FileError(topic + "a version of " + type + " that is not read");
  }
}

}  // namespace

Names bagParts(const MotionSource& source) {
  if (source.files.size() == 1) return source.files;
  std::vector<std::pair<std::int64_t, std::string>> parts;
  for (const std::string& file : source.files) parts.emplace_back(firstTimeOf(file), file);
  std::sort(parts.begin(), parts.end());
  Names files;
  for (const auto& [time, file] : parts) files.push_back(file);
  return files;
}

std::string jointStateTopic(const MotionSource& source) {
  std::map<std::string, std::vector<BagConnection>> topics;
  std::string damage;
  for (const std::string& file : source.files) {
    const BagConnections found = connectionsOf(file);
    for (const BagConnection& connection : found.connections) {
      topics[connection.topic].push_back(connection);
    }
    if (!found.damage.empty()) damage = "; " + file + " is damaged: " + found.damage;
  }
  Names all, of_joint_states;
  for (const auto& [name, connections] : topics) {
    all.push_back(name);
    if (connections.front().type == kJointStateType) of_joint_states.push_back(name);
  }
  if (!source.topic.empty()) {
    const auto found = topics.find(source.topic);
    if (found == topics.end()) {
      throw FileError(source.name() + ": has no topic " + inQuotes(source.topic) +
                      nameHelp(source.topic, of_joint_states.empty() ? all : of_joint_states) +
                      damage);
    }
    for (const BagConnection& connection : found->second) {
      requireJointStates(source, connection);
    }
    return source.topic;
  }
  if (of_joint_states.empty()) {
    throw FileError(source.name() + ": has no topic of " + std::string(kJointStateType) +
                    (all.empty() ? "" : "; its topics are " + namesInQuotes(all)) + damage);
  }
  MotionSource chosen = source;
  chosen.topic = of_joint_states.front();
  if (of_joint_states.size() > 1) {
    const auto has = [&](const std::string& topic) {
      return std::find(of_joint_states.begin(), of_joint_states.end(), topic) !=
             of_joint_states.end();
    };
    if (!has(source.usual_topic) && !has(kUsualTopic)) {
      throw FileError(source.name() + ": has several topics of " + std::string(kJointStateType) +
                      ", " + namesInQuotes(of_joint_states) + ": --topic says which");
    }
    chosen.topic = has(source.usual_topic) ? source.usual_topic : kUsualTopic;
  }
  return jointStateTopic(chosen);
}

}  // namespace virtual_work_dynamics
