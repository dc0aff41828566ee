#pragma once

#include <ros/advertise_options.h>
#include <ros/publisher.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ros/trajectory_conversion.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// One computed sample.
struct OutputSample {
  std::int64_t stamp_ns;  ///< instant of the motion
  const Motion& motion;
  const Results& results;
};

/// The message of one output in one plan, with names, frames and sizes set once. The computing
/// thread's.
class OutputMessage {
 public:
  virtual ~OutputMessage() = default;

  /// Outputs of trajectories: what the samples that follow are points of.
  virtual void begin(const trajectory_msgs::JointTrajectory&, const TrajectoryMotion&) {}
  /// Writes a sample. Allocates only where a result ceases or begins to exist, and for
  /// trajectories.
  virtual void fill(const OutputSample& sample) = 0;
  /// Publishes what was written, if there is anything to say.
  virtual void publish(const ros::Publisher& topic) const = 0;
};

/// A message of one type, published as long as it exists.
template <typename Message>
class MessageOf : public OutputMessage {
 public:
  const Message& message() const { return message_; }
  /// Whether what was written last has a value.
  bool exists() const { return exists_; }
  void publish(const ros::Publisher& topic) const override {
    if (exists_) topic.publish(message_);
  }

 protected:
  Message message_;
  bool exists_ = true;
};

/// An output of the node: its topic, what its subscribers need computed, and the message that this
/// is written to. Everything about an output is in one class of outputs.cpp, with one line in the
/// list there.
class Output {
 public:
  virtual ~Output() = default;

  /// Name of the topic, below the node's own.
  virtual std::string topic() const = 0;
  /// How it is advertised, except for who is told of subscribers.
  virtual ros::AdvertiseOptions options(const std::string& topic, std::uint32_t queue) const = 0;
  /// What there is to say before the first sample, to a latched topic.
  virtual void start(const ros::Publisher&) const {}

  /// Whether it has one message for each trajectory, rather than for each sample.
  virtual bool ofTrajectories() const { return false; }
  /// Adds what its subscribers need.
  virtual void addTo(Request& request) const = 0;
  /// Its message in a plan whose request has what addTo() adds.
  virtual std::unique_ptr<OutputMessage> makeMessage(const Dynamics& plan) const = 0;
};

using Outputs = std::vector<std::unique_ptr<Output>>;

/// What outputs depend on, apart from the plan.
struct OutputSettings {
  std::vector<std::string> reactions;        ///< joints and closures that the scene asks for
  std::vector<std::string> reaction_topics;  ///< their topics
  std::string frame_prefix;                  ///< put before every frame_id
  bool twist = false;                        ///< whether ~reactions has twists
  double condition_warn = kCloseToSingular;  ///< a larger condition is close to a singular position
};

/// All outputs of the node for a mechanism and a scene.
/// @param everything Dynamics of all that the scene asks for.
Outputs makeOutputs(const Mechanism& mechanism, const Dynamics& everything,
                    const OutputSettings& settings);

/// Indices of the outputs that somebody listens to, ascending.
using Audience = std::vector<std::size_t>;

/// What an audience needs, and no more.
Request requestFor(const Outputs& outputs, const Audience& audience);

}  // namespace virtual_work_dynamics
