// What do the bearings carry? Reaction wrenches of an arm that stands still and is pushed.
//
//   02_reactions [ROBOT.urdf [SCENE.yaml]]
//
// Without arguments: the six-axis arm, every joint at 0.5 rad, with 50 N on its last link.
#include <virtual_work_dynamics/dynamics.h>
#include <virtual_work_dynamics/error.h>
#include <virtual_work_dynamics/scene_reader.h>
#include <virtual_work_dynamics/urdf_reader.h>

#include <cstdio>
#include <string>

using namespace virtual_work_dynamics;

void print(const std::string& name, const char* axes, const Wrench& wrench) {
  std::printf("%-10s %-5s", name.c_str(), axes);
  for (int i = 0; i < 3; ++i) std::printf(" %12.6f", wrench.force[i]);
  for (int i = 0; i < 3; ++i) std::printf(" %12.6f", wrench.torque[i]);
  std::printf("\n");
}

int main(int argc, char** argv) try {
  const std::string folder = PACKAGE_FOLDER;
  const Mechanism robot = readUrdfFile(argc > 1 ? argv[1] : folder + "/urdf/six_axis_arm.urdf");
  Scene scene = readSceneFile(argc > 2 ? argv[2] : folder + "/config/six_axis_arm_scene.yaml");

  // 1. Add what the world exerts on a link: 50 N along x of the root link, on the last link's z
  //    axis. A scene file says that under the key applied_wrenches.
  AppliedWrench push;
  push.link = robot.links().back().name;
  push.at = {0, 0, 0.1};
  push.axes = Axes::kRoot;  // of force and torque
  push.force = {50, 0, 0};
  scene.applied_wrenches.push_back(push);

  // 2. Ask for wrenches by name, "ground" being what ground exerts on the root link:
  Request request;
  const std::string last = robot.coordinateNames().back();
  request.root_axes = {"ground", last};  // 2a. in axes of the root link,
  request.child_axes = {last};           // 2b. in axes of the joint's child link.
  const Dynamics dynamics(robot, scene, request);

  // 3. Compute. A new Motion has positions, velocities and accelerations of zero.
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(dynamics.coordinates());
  motion.q.setConstant(0.5);
  dynamics.compute(motion, workspace);

  // 4. Print what the parent exerts on the child, about the joint's origin, in the request's order.
  std::printf("joint      axes  force x y z [N]                        moment x y z [N m]\n");
  print("ground", "root", workspace.results().root_axes[0]);
  print(last, "root", workspace.results().root_axes[1]);
  print(last, "child", workspace.results().child_axes[0]);
} catch (const Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
