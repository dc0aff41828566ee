#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MultiDOFJointState.h>

#include <cstdint>
#include <string>
#include <vector>

#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"

namespace virtual_work_dynamics {

/// The messages of one request, with names, frames and sizes set once; fill() then only writes
/// numbers. Does not allocate after construction.
class OutputMessages {
 public:
  /// @param request of the plan whose workspaces will be given.
  /// @param frame_prefix put before every frame_id.
  OutputMessages(const Mechanism& mechanism, const Request& request,
                 const std::string& frame_prefix);

  /// Writes one sample into all messages of the request. @param stamp_ns instant of the motion, ns.
  void fill(std::int64_t stamp_ns, const Motion& motion, const Workspace& results);

  const sensor_msgs::JointState& effort() const { return effort_; }
  const sensor_msgs::MultiDOFJointState& reactions() const { return reactions_; }
  /// One for each of Request::child_axes.
  const std::vector<geometry_msgs::WrenchStamped>& wrenches() const { return wrenches_; }

 private:
  void fillReactions(const Workspace& results);

  sensor_msgs::JointState effort_;
  sensor_msgs::MultiDOFJointState reactions_;
  std::vector<geometry_msgs::WrenchStamped> wrenches_;
};

}  // namespace virtual_work_dynamics
