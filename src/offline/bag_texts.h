#pragma once

#include <optional>
#include <string>
#include <vector>

namespace virtual_work_dynamics {

/// A text that a bag has as a std_msgs/String.
struct BagText {
  std::string file, topic, text;
};

/// The first message of the first of these topics that the parts of a recording have as texts.
/// @throws FileError as BagReader, and where the topic is in the bag without a message.
std::optional<BagText> findBagText(const std::vector<std::string>& files,
                                   const std::vector<std::string>& topics);

/// The topics of texts whose last word is this one.
std::vector<std::string> bagTextTopics(const std::vector<std::string>& files,
                                       const std::string& word);

}  // namespace virtual_work_dynamics
