#include "ros/inverse_dynamics_node.h"

#include <ros/ros.h>

#include <cstdio>
#include <exception>
#include <string>

#include "base/printable.h"
#include "ros/inverse_dynamics_parameters.h"
#include "ros/inverse_dynamics_usage.h"
#include "ros/private_parameters.h"

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      std::fputs(kInverseDynamicsUsage, stdout);
      return 0;
    }
  }
  ros::init(argc, argv, "inverse_dynamics");
  // Lives until after the last line is logged: with the last handle, ROS and its console go.
  const ros::NodeHandle private_node("~");
  try {
    if (argc > 1) throw ParameterError(std::string("unknown argument ") + argv[1]);
    InverseDynamicsNode node(readInverseDynamicsParameters(private_node));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", printable(error.what()).c_str());
    return 1;
  }
  return 0;
}
