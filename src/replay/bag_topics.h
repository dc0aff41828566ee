#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bag/bag_writer.h"
#include "ros/active_plan.h"
#include "ros/outputs.h"
#include "ros/robot_task.h"

namespace virtual_work_dynamics {

/// The topics of the node's outputs in a bag that is written, as OutputTopics is of publishers.
class BagTopics {
 public:
  /// Adds a connection for each output of an audience, and for /tf_static where there are frames of
  /// closures.
  /// @param node name before the topics
  BagTopics(const RobotTask& task, const Audience& audience, const std::string& node,
            BagWriter& writer);
  ~BagTopics();

  /// Writes what latched topics say before the first sample.
  void start(std::int64_t time_ns);
  /// Writes the messages of a sample, or those of a trajectory.
  void write(const ActivePlan& plan, bool of_trajectories, std::int64_t time_ns);

  /// The topics.
  std::vector<std::string> names() const;
  /// How many results were written, by topics that got as many, in words; empty: none.
  std::string written() const;

 private:
  class Topic;

  const RobotTask& task_;
  std::vector<std::unique_ptr<Topic>> topics_;  // by output; none of those without audience
  std::unique_ptr<Topic> frames_;               // none: there are no closures
};

}  // namespace virtual_work_dynamics
