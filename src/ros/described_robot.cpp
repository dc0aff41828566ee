#include "ros/described_robot.h"

#include <ros/console.h>
#include <ros/node_handle.h>

#include <string>

#include "base/printable.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {

std::optional<Mechanism> describedRobot(const ros::NodeHandle& private_node) {
  std::string key, description;
  if (!private_node.searchParam(kRobotDescription, key)) return std::nullopt;
  if (!private_node.getParam(key, description)) return std::nullopt;
  try {
    return readUrdf(description);
  } catch (const UrdfError& error) {
    ROS_WARN("parameter %s is not used: %s", key.c_str(), printable(error.what()).c_str());
    return std::nullopt;
  }
}

}  // namespace virtual_work_dynamics
