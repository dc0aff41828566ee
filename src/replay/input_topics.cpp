#include "replay/input_topics.h"

#include <algorithm>
#include <iostream>

#include "bag/bag_connections.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "offline/arguments.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// The names without what stands for the node's own name.
std::string bare(const std::string& name) {
  return name[0] == '~' ? name.substr(1) : name;
}

}  // namespace

InputTopics::InputTopics(const MotionSource& source, std::string node,
                         std::vector<std::pair<std::string, std::string>> remap)
    : source_(source.name()), node_(std::move(node)), remap_(std::move(remap)) {
  for (const std::string& file : source.files) {
    const BagConnections found = connectionsOf(file);
    connections_.insert(connections_.end(), found.connections.begin(), found.connections.end());
    if (!found.damage.empty()) damage_ = "; " + file + " is damaged: " + found.damage;
  }
}

bool InputTopics::has(const std::string& topic) const {
  return std::any_of(connections_.begin(), connections_.end(),
                     [&](const BagConnection& connection) { return connection.topic == topic; });
}

// Why one of the connections of a topic cannot be read; empty: all can.
std::string InputTopics::mismatch(const std::string& name, const std::string& topic,
                                  const std::string& type, const std::string& md5sum) const {
  const std::string is = source_ + ": topic " + inQuotes(topic) + " is of ";
  for (const BagConnection& connection : connections_) {
    if (connection.topic != topic) continue;
    if (connection.type != type) {
      return is + inQuotes(connection.type) + ", and " + bare(name) + " is read from " + type;
    }
    if (connection.md5sum != md5sum) return is + "a version of " + type + " that is not read";
  }
  return "";
}

bool InputTopics::hasType(std::string_view type) const {
  return std::any_of(connections_.begin(), connections_.end(),
                     [&](const BagConnection& connection) { return connection.type == type; });
}

std::string InputTopics::find(const std::string& name, const std::string& type,
                              const std::string& md5sum, const std::string& purpose) {
  asked_.push_back(bare(name));
  const std::string space = name[0] == '~' ? node_ : node_.substr(0, node_.rfind('/'));
  std::string topic = name[0] == '/' ? name : space + "/" + bare(name);
  bool needed = !purpose.empty();
  for (const auto& [from, to] : remap_) {
    if (bare(from) != bare(name)) continue;
    if (to.empty() && needed) {
      throw UsageError("--remap " + from + ":= leaves out what " + purpose);
    }
    if (to.empty()) return "";
    topic = to;
    needed = true;
  }
  if (!has(topic)) {
    if (!needed) return "";
    std::vector<std::string> others;
    for (const BagConnection& other : connections_) {
      if (other.type == type &&
          std::find(others.begin(), others.end(), other.topic) == others.end())
        others.push_back(other.topic);
    }
    throw FileError(source_ + ": has no topic " + inQuotes(topic) + " of " + type +
                    (purpose.empty() ? "" : ", which " + purpose) +
                    (others.empty() ? ""
                                    : "; " + namesInQuotes(others) + " would be read by --remap " +
                                          bare(name) + ":=TOPIC") +
                    damage_);
  }
  const std::string wrong = mismatch(name, topic, type, md5sum);
  if (wrong.empty()) return topic;
  if (needed) throw FileError(wrong);
  std::cerr << "note: " << printable(wrong) << "; it is left alone\n";
  return "";
}

void InputTopics::refuseUnused() const {
  for (const auto& remapped : remap_) {
    const std::string name = bare(remapped.first);
    if (std::find(asked_.begin(), asked_.end(), name) != asked_.end()) continue;
    throw UsageError("--remap: " + inQuotes(name) + " is no topic that is read here" +
                     nameHelp(name, asked_));
  }
}

}  // namespace virtual_work_dynamics
