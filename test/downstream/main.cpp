// What a user does who has a robot, a scene in YAML, and a motion.

#include <yaml-cpp/yaml.h>

#include <exception>
#include <iostream>

#include "every_public_header.h"

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  if (argc != 2) {
    std::cerr << "Usage: " << argv[0] << " ROBOT.urdf\n";
    return 2;
  }
  try {
    const Mechanism mechanism = readUrdfFile(argv[1]);
    const Scene scene = readScene(YAML::Load("{gravity: [0, 9.81, 0], reactions: all}"));
    const InverseDynamics dynamics(mechanism, scene);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(Motion(dynamics.coordinates()), workspace);
    for (Eigen::Index i = 0; i < dynamics.coordinates(); ++i) {
      std::cout << mechanism.coordinateNames()[i] << ": " << workspace.effort()[i] << "\n";
    }
    return workspace.finite() && workspace.effort().norm() > 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
