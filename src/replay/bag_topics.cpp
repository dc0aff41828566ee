#include "replay/bag_topics.h"

#include <ros/advertise_options.h>
#include <ros/message_traits.h>

#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include "bag/byte_writer.h"
#include "base/printable.h"

namespace virtual_work_dynamics {
namespace {

BagConnection connectionOf(const ros::AdvertiseOptions& options, const std::string& node) {
  return {options.topic, options.datatype, options.md5sum, options.message_definition,
          node,          options.latch};
}

}  // namespace

// One topic, with the number of its messages in their headers, as publishers count them.
class BagTopics::Topic : public MessageRecorder {
 public:
  Topic(const ros::AdvertiseOptions& options, const std::string& node, BagWriter& writer)
      : name_(options.topic),
        has_header_(options.has_header),
        writer_(writer),
        connection_(writer.add(connectionOf(options, node))) {}

  const std::string& name() const { return name_; }
  std::size_t messages() const { return messages_; }
  void setTime(std::int64_t time_ns) { time_ns_ = time_ns; }

 protected:
  void write(std::string_view bytes) override {
    ++messages_;
    if (!has_header_) {
      writer_.write(connection_, time_ns_, bytes);
      return;
    }
    numbered_.clear();
    appendWord(numbered_, number_++);
    numbered_ += bytes.substr(numbered_.size());
    writer_.write(connection_, time_ns_, numbered_);
  }

 private:
  const std::string name_;
  const bool has_header_;
  BagWriter& writer_;
  const std::uint32_t connection_;
  std::int64_t time_ns_ = 0;
  std::uint32_t number_ = 0;
  std::size_t messages_ = 0;
  std::string numbered_;
};

BagTopics::BagTopics(const RobotTask& task, const Audience& audience, const std::string& node,
                     BagWriter& writer)
    : task_(task), topics_(task.outputs.size()) {
  for (const std::size_t i : audience) {
    const Output& output = *task.outputs[i];
    const std::string topic = output.topic();
    const std::string name = topic.front() == '/' ? topic : node + "/" + topic;
    topics_[i] = std::make_unique<Topic>(output.options(name, 0), node, writer);
  }
  if (task.closure_frames.transforms.empty()) return;
  ros::AdvertiseOptions options;
  options.init<tf2_msgs::TFMessage>("/tf_static", 1);
  options.latch = true;
  frames_ = std::make_unique<Topic>(options, node, writer);
}

BagTopics::~BagTopics() = default;

void BagTopics::start(std::int64_t time_ns) {
  if (frames_) {
    frames_->setTime(time_ns);
    frames_->record(task_.closure_frames);
  }
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (!topics_[i]) continue;
    topics_[i]->setTime(time_ns);
    task_.outputs[i]->recordStart(*topics_[i]);
  }
}

void BagTopics::write(const ActivePlan& plan, bool of_trajectories, std::int64_t time_ns) {
  for (const ActiveOutput& output : plan.outputs) {
    if (output.of_trajectories != of_trajectories) continue;
    Topic& topic = *topics_[output.index];
    topic.setTime(time_ns);
    output.message->record(topic);
  }
}

std::vector<std::string> BagTopics::names() const {
  std::vector<std::string> names;
  if (frames_) names.push_back(frames_->name());
  for (const auto& topic : topics_) {
    if (topic) names.push_back(topic->name());
  }
  return names;
}

std::string BagTopics::written() const {
  std::map<std::size_t, std::vector<std::string>, std::greater<>> topics;  // by messages
  for (const auto& topic : topics_) {
    if (topic && topic->messages() > 0) topics[topic->messages()].push_back(topic->name());
  }
  std::string text;
  for (const auto& [count, names] : topics) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) +
            (count == 1 ? " result " : " results ") + (names.size() == 1 ? "on " : "each on ") +
            namesInQuotes(names);
  }
  return text;
}

}  // namespace virtual_work_dynamics
