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

constexpr char kUsualTopic[] = "/joint_states";

using Names = std::vector<std::string>;

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
  std::map<std::string, BagConnection> topics;
  std::string damage;
  for (const std::string& file : source.files) {
    const BagConnections found = connectionsOf(file);
    for (const BagConnection& connection : found.connections) {
      topics.emplace(connection.topic, connection);
    }
    if (!found.damage.empty()) damage = "; " + file + " is damaged: " + found.damage;
  }
  Names all, of_joint_states;
  for (const auto& [name, connection] : topics) {
    all.push_back(name);
    if (connection.type == kJointStateType) of_joint_states.push_back(name);
  }
  if (!source.topic.empty()) {
    const auto found = topics.find(source.topic);
    if (found == topics.end()) {
      throw FileError(source.name() + ": has no topic " + inQuotes(source.topic) +
                      nameHelp(source.topic, of_joint_states.empty() ? all : of_joint_states) +
                      damage);
    }
    if (found->second.type != kJointStateType) {
      throw FileError(source.name() + ": topic " + inQuotes(source.topic) + " is of " +
                      inQuotes(found->second.type) + ", and a motion is read from " +
                      std::string(kJointStateType));
    }
    if (found->second.md5sum != kJointStateMd5) {
      throw FileError(source.name() + ": topic " + inQuotes(source.topic) + " is of a version of " +
                      std::string(kJointStateType) + " that is not read");
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
    if (topics.count(kUsualTopic) == 0) {
      throw FileError(source.name() + ": has several topics of " + std::string(kJointStateType) +
                      ", " + namesInQuotes(of_joint_states) + ": --topic says which");
    }
    chosen.topic = kUsualTopic;
  }
  return jointStateTopic(chosen);
}

}  // namespace virtual_work_dynamics
