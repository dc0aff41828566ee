#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "closed_loop_results.h"
#include "tested_build.h"
#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Closed forms of some hundred newtons against a factorization.
constexpr double kExact = 1e-10;

struct CoupledExample {
  explicit CoupledExample(const std::string& name)
      : mechanism(readUrdfFile(std::string(kSourceFolder) + "/urdf/" + name + ".urdf")),
        scene(readSceneFile(std::string(kSourceFolder) + "/config/" + name + "_scene.yaml")),
        found(mechanism, scene) {}
  Eigen::Index at(const std::string& joint) const { return mechanism.coordinateIndex(joint); }

  const Mechanism mechanism;
  const Scene scene;
  ClosedLoopResults found;
};

// 30 N m on the carrier, radii 0.03, 0.02 and 0.07 m: three planets bear it together, and which
// part each of them takes is not determined.
TEST(CoupledExamples, PlanetaryGearSharesItsLoad) {
  CoupledExample gear("planetary_gear");
  Motion motion(5);
  motion.q[gear.at("sun_joint")] = 4;
  ASSERT_TRUE(gear.found.dynamics.complete(motion));
  EXPECT_NEAR(motion.q[gear.at("carrier_joint")], 4 * 0.3, kExact);
  EXPECT_NEAR(motion.q[gear.at("planet_2_joint")], -(4 - 1.2) * 1.5, kExact);
  gear.found.dynamics.compute(motion);
  EXPECT_NEAR(gear.found.dynamics.effort()[gear.at("sun_joint")], 9, kExact);
  EXPECT_EQ(gear.found.dynamics.determinacy().redundant_constraints, 2);
  const double angle = motion.q[gear.at("carrier_joint")];
  const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
  const Eigen::Vector3d along = Eigen::Vector3d::UnitZ().cross(out);
  const Eigen::Vector3d tooth = gear.found.root("sun_1").force;
  EXPECT_NEAR(tooth.dot(along), 100, kExact);
  EXPECT_NEAR(tooth.dot(out), 100 * std::tan(M_PI / 9) / std::cos(0.2), kExact);
  EXPECT_FALSE(gear.found.rootDetermined("sun_1")[0]);
  // The helices of both meshes push a planet against each other.
  const Eigen::Vector3d bearing = gear.found.root("planet_1_joint").force;
  EXPECT_NEAR(bearing.z(), 0.12 * 9.81, kExact);
  EXPECT_NEAR(bearing.dot(along), -200, kExact);
}

TEST(CoupledExamples, CoupledWristDrivesItsMotors) {
  CoupledExample wrist("coupled_wrist");
  Motion motion(4);
  const auto q5 = wrist.at("joint_5"), q6 = wrist.at("joint_6");
  motion.q[q5] = 0.4;
  motion.q[q6] = -1.1;
  motion.qdd[q5] = 3;
  motion.qdd[q6] = -2;
  std::vector<bool> given(4, false);
  given[static_cast<std::size_t>(q5)] = given[static_cast<std::size_t>(q6)] = true;
  ASSERT_TRUE(wrist.found.dynamics.complete(motion, given));
  EXPECT_NEAR(motion.q[wrist.at("motor_5")], 45 * 0.4, kExact);
  EXPECT_NEAR(motion.q[wrist.at("motor_6")], 32 * (0.4 - 1.1), kExact);
  wrist.found.dynamics.compute(motion);
  const InverseDynamics tree(wrist.mechanism, Scene());
  Workspace workspace = tree.makeWorkspace();
  tree.compute(motion, workspace);
  const double t5 = workspace.effort()[q5], t6 = workspace.effort()[q6];
  const Eigen::VectorXd& effort = wrist.found.dynamics.effort();
  // At rest there is no friction.
  EXPECT_NEAR(effort[wrist.at("motor_5")], 3e-5 * 45 * 3 + (t5 - t6) / 45, kExact);
  EXPECT_NEAR(effort[wrist.at("motor_6")], 2e-5 * 32 * (3 - 2) + t6 / 32, kExact);
  EXPECT_EQ(effort[q5], 0);
  EXPECT_EQ(effort[q6], 0);
}

}  // namespace
}  // namespace virtual_work_dynamics
