#pragma once

#include <functional>
#include <string>

namespace ros {
class NodeHandle;
}

namespace virtual_work_dynamics {

/// What a node's program is besides its work.
struct NodeProgram {
  std::string name;   ///< of the node, unless it is remapped
  const char* usage;  ///< printed for --help
  /// Runs the node until it is done or ROS shuts down.
  /// @param private_node NodeHandle("~").
  std::function<void(const ros::NodeHandle& private_node)> run;
};

/// The main function of a node: whatever is wrong, with its arguments, its names, the address of
/// the master or its work, ends it with one FATAL line. @returns the exit code.
int runNode(int argc, char** argv, const NodeProgram& program);

}  // namespace virtual_work_dynamics
