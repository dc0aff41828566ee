#include <ros/ros.h>

#include <cstdio>
#include <exception>
#include <string>

#include "base/printable.h"
#include "ros/described_robot.h"
#include "ros/private_parameters.h"
#include "ros/trajectory_publisher.h"
#include "ros/trajectory_publisher_usage.h"

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      std::fputs(kTrajectoryPublisherUsage, stdout);
      return 0;
    }
  }
  ros::init(argc, argv, "trajectory_publisher");
  // Lives until after the last line is logged: with the last handle, ROS and its console go.
  const ros::NodeHandle private_node("~");
  try {
    if (argc > 1) throw ParameterError(std::string("unknown argument ") + argv[1]);
    PrivateParameters parameters(private_node);
    const auto robot = [&private_node] { return describedRobot(private_node); };
    TrajectoryPublisher(ros::NodeHandle(), readTrajectorySettings(parameters, robot)).run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", printable(error.what()).c_str());
    return 1;
  }
  return 0;
}
