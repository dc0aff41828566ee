// Many samples at once, several in each vector instruction and divided among threads: the peaks of
// a motion. For open chains.
//
//   04_blocks [ROBOT.urdf [SCENE.yaml]]    (without arguments: the paper's composed pendulum)
#include <virtual_work_dynamics/block.h>
#include <virtual_work_dynamics/error.h>
#include <virtual_work_dynamics/motion_law.h>
#include <virtual_work_dynamics/scene_reader.h>
#include <virtual_work_dynamics/urdf_reader.h>

#include <cmath>
#include <cstdio>
#include <string>

using namespace virtual_work_dynamics;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

int main(int argc, char** argv) try {
  const std::string folder = PACKAGE_FOLDER;
  const Mechanism robot =
      readUrdfFile(argc > 1 ? argv[1] : folder + "/urdf/composed_pendulum.urdf");
  const Scene scene =
      readSceneFile(argc > 2 ? argv[2] : folder + "/config/composed_pendulum_scene.yaml");

  // 1. Compile the plan of an open chain, and put a computation in two threads around it.
  const InverseDynamics dynamics(robot, scene);
  BlockInverseDynamics<double> block(dynamics, 2);

  // 2. Fill in the motion: a row for each sample, one sample a millisecond.
  const Eigen::Index samples = 6001, joints = dynamics.coordinates();
  const auto law =
      cosineLaw(Eigen::VectorXd::LinSpaced(joints, 1, double(joints)) * M_PI / 12, 12, 6);
  Rows q(samples, joints), qd(samples, joints), qdd(samples, joints);
  Motion motion(joints);
  for (Eigen::Index n = 0; n < samples; ++n) {
    law->evaluate(double(n) / 1000, motion);
    q.row(n) = motion.q, qd.row(n) = motion.qd, qdd.row(n) = motion.qdd;
  }

  // 3. Compute efforts and reactions, fx fy fz tx ty tz of each. This does not allocate memory.
  const std::vector<std::string>& names = dynamics.request().root_axes;
  Rows effort(samples, joints), wrenches(samples, 6 * Eigen::Index(names.size()));
  block.compute(BlockLayout::kRowMajor, {std::size_t(samples), q.data(), qd.data(), qdd.data()},
                {effort.data(), nullptr, wrenches.data()});

  // 4. Print the peaks, which size motors and bearings.
  for (Eigen::Index j = 0; j < joints; ++j) {
    std::printf("%-16s largest |effort| %14.9f\n", robot.coordinateNames()[std::size_t(j)].c_str(),
                effort.col(j).cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::printf("%-16s largest |force|  %14.9f N\n", names[k].c_str(),
                wrenches.middleCols(6 * Eigen::Index(k), 3).rowwise().norm().maxCoeff());
  }
} catch (const Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
