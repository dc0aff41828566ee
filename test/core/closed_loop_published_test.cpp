#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "loop_examples.h"
#include "named_loop_results.h"
#include "tested_build.h"

namespace virtual_work_dynamics {
namespace {

// Relative to the largest multiplier. The published state at 0.03 s satisfies the accelerations of
// the loops to 2e-3 of 7e5 only.
constexpr double kAtRest = 1e-12;
constexpr double kInMotion = 1e-9;
constexpr double kMotorTorque = 1e-9;  // N m
// Forces at joint E are printed with ten decimals, of up to 245 N.
constexpr double kPrintedForces = 1e-9 * 245;

class AndrewsSqueezer : public testing::Test {
 protected:
  AndrewsSqueezer() : example_("andrews_squeezer") {
    const std::string path = std::string(kSharedData) + "/reference/andrews_squeezer.json";
    if (std::filesystem::exists(path)) reference_ = YAML::LoadFile(path);
  }

  bool missing() const { return !reference_.IsDefined() || reference_.IsNull(); }

  NamedLoopResults results(const YAML::Node& state) const {
    Motion motion(static_cast<Eigen::Index>(example_.mechanism.coordinates().size()));
    for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
      const std::string& name = example_.mechanism.coordinateNames()[static_cast<std::size_t>(i)];
      motion.q[i] = state["q_rad"][name].as<double>();
      motion.qd[i] = state["qd_rad_s"][name].as<double>();
      motion.qdd[i] = state["qdd_rad_s2"][name].as<double>();
    }
    return {example_.mechanism, example_.scene, motion};
  }

  void expectPublished(const YAML::Node& state, double tolerance) const {
    const std::vector<double> lambda = state["lambda_N"].as<std::vector<double>>();
    double largest = 0;
    for (const double value : lambda) largest = std::max(largest, std::abs(value));
    const NamedLoopResults results = this->results(state);
    std::size_t i = 0;
    for (const char* closure : {"E_BDE", "E_EG", "E_HE"}) {
      const Wrench& reaction = results.rootAxes(closure);
      EXPECT_NEAR(reaction.force.x(), lambda[i++], tolerance * largest) << closure;
      EXPECT_NEAR(reaction.force.y(), lambda[i++], tolerance * largest) << closure;
      EXPECT_TRUE(results.rootAxesDetermined(closure)[0]);
      EXPECT_TRUE(results.rootAxesDetermined(closure)[1]);
    }
    EXPECT_NEAR(results.effort("beta"), state["motor_torque_Nm"].as<double>(), kMotorTorque);
    EXPECT_TRUE(results.effortDetermined("beta"));
  }

  LoopExample example_;
  YAML::Node reference_;
};

TEST_F(AndrewsSqueezer, MultipliersAndMotorTorqueAtRest) {
  if (missing()) GTEST_SKIP() << "no reference results in " << kSharedData;
  expectPublished(reference_["states"][0], kAtRest);
}

TEST_F(AndrewsSqueezer, MultipliersAndMotorTorqueInMotion) {
  if (missing()) GTEST_SKIP() << "no reference results in " << kSharedData;
  expectPublished(reference_["states"][1], kInMotion);
}

TEST_F(AndrewsSqueezer, ForcesAtTheJointThatFourBodiesShare) {
  if (missing()) GTEST_SKIP() << "no reference results in " << kSharedData;
  const YAML::Node printed = reference_["forces_at_shared_joint_E_at_t_0.03_N"];
  const NamedLoopResults results = this->results(reference_["states"][1]);
  const auto expect = [&](const char* key, const Eigen::Vector3d& force) {
    EXPECT_NEAR(force.x(), printed[key][0].as<double>(), kPrintedForces) << key;
    EXPECT_NEAR(force.y(), printed[key][1].as<double>(), kPrintedForces) << key;
  };
  const Eigen::Vector3d on_bde = results.rootAxes("E_BDE").force;
  const Eigen::Vector3d on_eg = results.rootAxes("E_EG").force;
  const Eigen::Vector3d on_he = results.rootAxes("E_HE").force;
  expect("on_body_3_BDE", on_bde);
  expect("on_EG", on_eg);
  expect("on_HE", on_he);
  expect("on_crank_side_FE", -(on_bde + on_eg + on_he));
}

}  // namespace
}  // namespace virtual_work_dynamics
