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

std::vector<std::string> topicsOf(const std::string& what, const std::string& folder,
                                  const std::vector<std::string>& names) {
  std::vector<std::string> topics;
  std::unordered_map<std::string, std::string> name_of_topic;
  for (const std::string& name : names) {
    topics.push_back(legalTopicName(name));
    const auto inserted = name_of_topic.emplace(topics.back(), name);
    if (!inserted.second) {
      throw SceneError(what + inQuotes(inserted.first->second) + " and " + inQuotes(name) +
                       " would share the topic " + privateName(folder + topics.back()));
    }
  }
  return topics;
}

}  // namespace

std::string legalTopicName(const std::string& joint) {
  std::string topic = joint.empty() || isDigit(joint[0]) ? "_" : "";
  for (const char c : joint) topic += isLegal(c) ? c : '_';
  return topic;
}

std::vector<std::string> reactionTopics(const std::vector<std::string>& reactions) {
  return topicsOf("reactions: joints ", "reaction/", reactions);
}

std::vector<std::string> wrenchTopics(const std::vector<std::string>& wrenches) {
  return topicsOf("applied_wrenches: ", "wrench/", wrenches);
}

}  // namespace virtual_work_dynamics
