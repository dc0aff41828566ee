// A mechanism with a loop: the motor of a four-bar linkage turns its crank once, at 2 rad/s. The
// other joints follow, and the pin that closes the loop has a reaction like any joint.
//
//   03_closed_loop [PACKAGE_FOLDER]
#include <virtual_work_dynamics/dynamics.h>
#include <virtual_work_dynamics/error.h>
#include <virtual_work_dynamics/passive_joints.h>
#include <virtual_work_dynamics/scene_reader.h>
#include <virtual_work_dynamics/urdf_reader.h>

#include <cmath>
#include <cstdio>
#include <string>

using namespace virtual_work_dynamics;

int main(int argc, char** argv) try {
  // 1. The description is a tree. The scene closes its loop (key: closures) and names the motor
  //    (key: actuated). Compiling both assembles the loop.
  const std::string folder = argc > 1 ? argv[1] : PACKAGE_FOLDER;
  const Mechanism robot = readUrdfFile(folder + "/urdf/four_bar.urdf");
  const Scene scene = readSceneFile(folder + "/config/four_bar_scene.yaml");

  // 2. Ask for the effort of the motor and the force at the pin. Find two joints by name.
  Request request;
  request.root_axes = {"rocker_pin"};
  const Dynamics dynamics(robot, scene, request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const auto coordinate = [&robot](const char* name) {
    return robot.joints().at(std::size_t(robot.jointIndex(name))).coordinate;
  };
  const int crank = coordinate("crank_joint"), rocker = coordinate("rocker_joint");

  // 3. Give the motion of the motor. The follower completes it, from one position to the next.
  PassiveJoints follower(robot, dynamics);
  Motion motion(dynamics.coordinates());
  std::printf("crank [rad]  rocker [rad]  motor [N m]     pin fx, fy, fz [N]\n");
  for (int step = 0; step <= 12; ++step) {
    motion.q[crank] = step * M_PI / 6;
    motion.qd[crank] = 2;
    motion.qdd[crank] = 0;
    if (!follower.complete(motion, dynamics, workspace)) {
      throw MotionError(dynamics.whyOpen(motion, workspace));
    }
    // 4. Compute. The flags say what rigid-body mechanics determines: fz is the policy's choice.
    dynamics.compute(motion, workspace);
    const Results& results = workspace.results();
    std::printf("%11.6f %13.6f %12.6f ", motion.q[crank], motion.q[rocker], results.effort[crank]);
    for (std::size_t i = 0; i < 3; ++i) {
      std::printf(" %12.6f%s", results.root_axes[0].force[Eigen::Index(i)],
                  results.loops.root_axes_determined[0][i] ? "" : " (not determined)");
    }
    std::printf("\n");
  }
} catch (const Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
