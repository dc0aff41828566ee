#include <ros/ros.h>

#include "ros/described_robot.h"
#include "ros/node_program.h"
#include "ros/private_parameters.h"
#include "ros/trajectory_publisher.h"
#include "ros/trajectory_publisher_usage.h"

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  const auto run = [](const ros::NodeHandle& private_node) {
    PrivateParameters parameters(private_node);
    const auto robot = [&private_node] { return describedRobot(private_node); };
    TrajectoryPublisher(ros::NodeHandle(), readTrajectorySettings(parameters, robot)).run();
  };
  return runNode(argc, argv, {"trajectory_publisher", kTrajectoryPublisherUsage, run});
}
