#include "ros/topic_names.h"

#include <unordered_map>

#include "base/printable.h"
#include "ros/private_name.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Compares by hand, as isalnum() depends on the locale.
bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool isLegal(char c) {
  return isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

}  // namespace

std::string legalTopicName(const std::string& joint) {
  std::string topic = joint.empty() || isDigit(joint[0]) ? "_" : "";
  for (const char c : joint) topic += isLegal(c) ? c : '_';
  return topic;
}

std::vector<std::string> legalTopicNames(const std::vector<std::string>& joints) {
  std::vector<std::string> topics;
  std::unordered_map<std::string, std::string> joint_of_topic;
  for (const std::string& joint : joints) {
    topics.push_back(legalTopicName(joint));
    const auto inserted = joint_of_topic.emplace(topics.back(), joint);
    if (!inserted.second) {
      throw SceneError("reactions: joints " + inQuotes(inserted.first->second) + " and " +
                       inQuotes(joint) + " would share the topic " +
                       privateName("reaction/" + topics.back()));
    }
  }
  return topics;
}

}  // namespace virtual_work_dynamics
