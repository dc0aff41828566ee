// Can the numbers be trusted? Two witnesses of one sample, which share no formula with the
// recursion.
//
//   05_certificates [ROBOT.urdf [SCENE.yaml]]    (without arguments: the six-axis arm)
#include <virtual_work_dynamics/certificates.h>
#include <virtual_work_dynamics/dynamics.h>
#include <virtual_work_dynamics/error.h>
#include <virtual_work_dynamics/lagrange_dynamics.h>
#include <virtual_work_dynamics/scene_reader.h>
#include <virtual_work_dynamics/urdf_reader.h>

#include <cstdio>
#include <string>

using namespace virtual_work_dynamics;

int main(int argc, char** argv) try {
  const std::string folder = PACKAGE_FOLDER;
  const Mechanism robot = readUrdfFile(argc > 1 ? argv[1] : folder + "/urdf/six_axis_arm.urdf");
  const Scene scene =
      readSceneFile(argc > 2 ? argv[2] : folder + "/config/six_axis_arm_scene.yaml");

  // 1. Certificates need all efforts and the reaction of ground: extend the request by them.
  const Request request = Certifier::extended(Request());
  const Dynamics dynamics(robot, scene, request);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();

  // 2. Compute one sample. complete() makes the passive joints of closed loops follow.
  Motion motion(dynamics.coordinates());
  motion.q = dynamics.assembly();
  motion.qd.setConstant(1);
  motion.qdd.setConstant(-2);
  if (!dynamics.complete(motion, workspace)) throw MotionError(dynamics.whyOpen(motion, workspace));
  dynamics.compute(motion, workspace);

  // 3. Witnesses see the mechanism as a tree, on which the wrenches of closures act as loads.
  Load load;
  dynamics.getTreeLoad(workspace.results(), load);
  const Wrench& ground = workspace.results().child_axes[Certifier::groundIndex(request)];
  Eigen::VectorXd effort = workspace.results().effort.head(dynamics.coordinates());

  // 4. The first witness: the balances of power and of momentum, relative, near 1e-15 when right.
  Certifier certifier(robot, dynamics.tree());
  std::printf("What the balances miss:        %.1e\n",
              certifier.check(motion, load, effort, ground).largest());
  std::printf("with efforts a thousandth off: %.1e\n",
              certifier.check(motion, load, effort * 1.001, ground).largest());

  // 5. The second witness: Lagrange's equations, in long double.
  LagrangeDynamics<long double> lagrange(robot, dynamics.tree(), Request());
  lagrange.compute(motion, load);
  std::printf("Largest effort, N m or N:      %.9f\n", effort.cwiseAbs().maxCoeff());
  std::printf("It differs from Lagrange's by: %.1e\n",
              (effort - lagrange.effort()).cwiseAbs().maxCoeff());
} catch (const Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
