#include "offline/bag_texts.h"

#include <algorithm>
#include <string_view>

#include "bag/bag_connections.h"
#include "bag/bag_reader.h"
#include "bag/byte_cursor.h"
#include "base/printable.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::string_view kStringType = "std_msgs/String";

bool hasText(const std::string& file, const std::string& topic) {
  const std::vector<BagConnection> all = connectionsOf(file).connections;
  return std::any_of(all.begin(), all.end(), [&](const BagConnection& connection) {
    return connection.topic == topic && connection.type == kStringType;
  });
}

// The first message of a topic.
std::optional<std::string> firstText(const std::string& file, const std::string& topic) {
  BagReader reader(file);
  BagMessage message;
  while (reader.next(message)) {
    if (message.connection->topic != topic || message.connection->type != kStringType) continue;
    ByteCursor bytes(message.bytes);
    const std::string_view text = bytes.sized();
    if (!bytes.ok() || !bytes.empty()) {
      throw FileError(file + ": " + topic + ": its bytes are not those of a text");
    }
    return std::string(text);
  }
  return std::nullopt;
}

}  // namespace

std::optional<BagText> findBagText(const std::vector<std::string>& files,
                                   const std::vector<std::string>& topics) {
  for (const std::string& topic : topics) {
    bool there = false;
    for (const std::string& file : files) {
      if (!hasText(file, topic)) continue;
      there = true;
      if (auto text = firstText(file, topic)) return BagText{file, topic, *text};
    }
    if (there) throw FileError(files[0] + ": topic " + inQuotes(topic) + " has no message");
  }
  return std::nullopt;
}

std::vector<std::string> bagTextTopics(const std::vector<std::string>& files,
                                       const std::string& word) {
  std::vector<std::string> topics;
  for (const std::string& file : files) {
    for (const BagConnection& connection : connectionsOf(file).connections) {
      const std::string& topic = connection.topic;
      if (connection.type == kStringType && topic.substr(topic.rfind('/') + 1) == word &&
          std::find(topics.begin(), topics.end(), topic) == topics.end()) {
        topics.push_back(topic);
      }
    }
  }
  return topics;
}

}  // namespace virtual_work_dynamics
