#include "ros/private_name.h"

#include <ros/init.h>
#include <ros/this_node.h>

namespace virtual_work_dynamics {

std::string privateName(const std::string& name) {
  return (ros::isInitialized() ? ros::this_node::getName() + "/" : "~") + name;
}

}  // namespace virtual_work_dynamics
