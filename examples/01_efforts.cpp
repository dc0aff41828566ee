// What must the motors deliver? The efforts of a robot that moves by a law, second by second.
//
//   01_efforts [ROBOT.urdf [SCENE.yaml]]
//
// Without arguments: the composed pendulum of the paper's section 5, in the paper's motion (5.11).
#include <virtual_work_dynamics/dynamics.h>
#include <virtual_work_dynamics/error.h>
#include <virtual_work_dynamics/motion_law.h>
#include <virtual_work_dynamics/scene_reader.h>
#include <virtual_work_dynamics/urdf_reader.h>

#include <cmath>
#include <cstdio>
#include <string>

using namespace virtual_work_dynamics;

int main(int argc, char** argv) try {
  const std::string folder = PACKAGE_FOLDER;
  // 1. Read a mechanism from its description, and the scene around it.
  const Mechanism robot =
      readUrdfFile(argc > 1 ? argv[1] : folder + "/urdf/composed_pendulum.urdf");
  Scene scene = readSceneFile(argc > 2 ? argv[2] : folder + "/config/composed_pendulum_scene.yaml");
  scene.reactions = ReactionSelection::kNone;  // efforts only: what is not asked for costs nothing

  // 2. Compile both into a plan, and make the memory for the results of one thread.
  const Dynamics dynamics(robot, scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();

  // 3. Choose a motion: joint j swings by q_j = j pi/12 [1 - cos(2 pi t / 12 s)], j = 1, 2, ...
  const Eigen::Index joints = dynamics.coordinates();
  const auto law =
      cosineLaw(Eigen::VectorXd::LinSpaced(joints, 1, double(joints)) * M_PI / 12, 12, 6);

  // 4. Compute sample after sample. Neither evaluate() nor compute() allocates memory.
  Motion motion(joints);
  std::printf("Efforts in N m (in N where a joint slides):\ntime [s]");
  for (const std::string& name : dynamics.effortNames()) std::printf(" %14s", name.c_str());
  for (int t = 0; t <= 6; ++t) {
    law->evaluate(t, motion);
    dynamics.compute(motion, workspace);
    std::printf("\n%8d", t);
    const Eigen::VectorXd& efforts = workspace.results().effort;
    for (int i = 0; i < efforts.size(); ++i) std::printf(" %14.9f", efforts[i]);
  }
  std::printf("\n");
} catch (const Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
