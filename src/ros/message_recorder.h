#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <string_view>
#include <vector>

namespace virtual_work_dynamics {

/// Takes the messages of one output for a recording.
class MessageRecorder {
 public:
  virtual ~MessageRecorder() = default;

  /// Serializes a message as a publisher does. Allocates only for messages that are longer than
  /// those before.
  template <typename Message>
  void record(const Message& message) {
    const std::uint32_t length = ros::serialization::serializationLength(message);
    if (bytes_.size() < length) bytes_.resize(length);
    ros::serialization::OStream stream(bytes_.data(), length);
    ros::serialization::serialize(stream, message);
    write({reinterpret_cast<const char*>(bytes_.data()), length});
  }

 protected:
  /// Writes a serialized message.
  virtual void write(std::string_view bytes) = 0;

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace virtual_work_dynamics
