#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MultiDOFJointState.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ros/loop_plan.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// Names of what has an effort: coordinates, then actuated closures in the scene's order.
std::vector<std::string> namesOfEfforts(const Mechanism& mechanism, const Scene& scene);

/// The messages of one request, with names, frames and sizes set once; fill() then only writes
/// numbers. Does not allocate after construction.
class OutputMessages {
 public:
  /// @param request what is published of the results that will be given. Reactions in child axes
  /// refer to the child link's frame, those of closures to a frame of the closure's name.
  /// @param frame_prefix put before every frame_id.
  OutputMessages(const Mechanism& mechanism, const Scene& scene, const Request& request,
                 const std::string& frame_prefix);

  /// Says where the results have the reactions in child axes, when more of them are computed.
  void setComputed(const Request& computed);

  /// Writes one sample into all messages of the request. @param stamp_ns instant of the motion, ns.
  void fill(std::int64_t stamp_ns, const Motion& motion, const Workspace& results);
  /// The same with closed loops: effort() has the actuated closures after the coordinates, and what
  /// does not exist is left out. Allocates where that begins or ends.
  void fill(std::int64_t stamp_ns, const Motion& motion, const LoopPlan& plan);

  const sensor_msgs::JointState& effort() const { return effort_; }
  const sensor_msgs::MultiDOFJointState& reactions() const { return reactions_; }
  /// One for each of Request::child_axes.
  const std::vector<geometry_msgs::WrenchStamped>& wrenches() const { return wrenches_; }
  /// Whether such a wrench exists; always in open chains.
  bool wrenchExists(std::size_t index) const { return wrench_exists_[index]; }

 private:
  void setStamp(std::int64_t stamp_ns);
  template <typename Results>
  void fillReactions(const Results& results);
  void fillEffort(const Motion& motion, const LoopPlan& plan);
  void fillExistingReactions(const LoopPlan& plan);

  // Names of all; messages have those of what exists.
  std::vector<std::string> effort_names_, reaction_names_;
  sensor_msgs::JointState effort_;
  sensor_msgs::MultiDOFJointState reactions_;
  std::vector<geometry_msgs::WrenchStamped> wrenches_;
  std::vector<std::string> wrench_names_;
  std::vector<std::size_t> wrench_places_;  // among the results
  std::vector<bool> wrench_exists_;
};

}  // namespace virtual_work_dynamics
