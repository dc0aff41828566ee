#include "ros/inverse_dynamics_node.h"

#include <ros/ros.h>

#include "ros/inverse_dynamics_parameters.h"
#include "ros/inverse_dynamics_usage.h"
#include "ros/node_program.h"
#include "ros/scene_parameter.h"

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  const auto run = [](const ros::NodeHandle& private_node) {
    try {
      InverseDynamicsNode node(readInverseDynamicsParameters(private_node));
      ros::spin();
    } catch (const SceneError& error) {
      throw sceneParameterError(error);
    }
  };
  return runNode(argc, argv, {"inverse_dynamics", kInverseDynamicsUsage, run});
}
