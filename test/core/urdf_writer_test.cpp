#include "urdf_writer.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <limits>
#include <string>

#include "random_cases.h"
#include "scene_writer.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

// Failures of the property tests are printed as files; these must say what was computed.
namespace virtual_work_dynamics {
namespace {

constexpr unsigned kTrees = 200;
// Three angles of up to pi, each half a rounding off.
constexpr long double kRotation = 6 * std::numeric_limits<double>::epsilon();
// Rounded components of a unit vector that the reader makes a unit vector again.
constexpr long double kAxis = std::numeric_limits<double>::epsilon();

void expectSame(const Link& a, const Link& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.parent_joint, b.parent_joint);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.p_KoCm_K, b.p_KoCm_K);
  EXPECT_EQ(a.inertia_Cm_K, b.inertia_Cm_K);
}

void expectSame(const Joint& a, const Joint& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.parent_link, b.parent_link);
  EXPECT_EQ(a.p_PoKo_P, b.p_PoKo_P);
  EXPECT_LE((a.R_PK - b.R_PK).norm(), kRotation);
  EXPECT_LE((a.axis_K - b.axis_K).norm(), kAxis);
  EXPECT_EQ(a.coordinate, b.coordinate);
  EXPECT_EQ(a.mimics, b.mimics);
  EXPECT_EQ(a.multiplier, b.multiplier);
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.damping, b.damping);
  EXPECT_EQ(a.friction, b.friction);
}

TEST(UrdfWriter, ReadsBackToTheSameTree) {
  for (unsigned seed = 1; seed <= kTrees && !testing::Test::HasFailure(); ++seed) {
    RandomCases random(seed);
    const Mechanism written = random.next().mechanism;
    const Mechanism read = readUrdf(urdfText(written));
    SCOPED_TRACE(urdfText(written));
    ASSERT_EQ(written.links().size(), read.links().size());
    for (std::size_t i = 0; i < read.links().size(); ++i) {
      expectSame(written.links()[i], read.links()[i]);
    }
    for (std::size_t k = 0; k < read.joints().size(); ++k) {
      expectSame(written.joints()[k], read.joints()[k]);
    }
  }
}

// Where the pitch is a quarter turn, roll and yaw turn about the same axis.
TEST(UrdfWriter, FindsAnglesOfEveryOrientation) {
  for (const double pitch : {M_PI_2, -M_PI_2, 0.0, M_PI}) {
    for (const double roll : {0.0, 0.3, -2.0, M_PI}) {
      for (const double yaw : {0.0, 1.2, -3.0}) {
        using Turn = Eigen::AngleAxis<long double>;
        const auto rotation = [](const Vector3l& rpy) {
          return (Turn(rpy[2], Vector3l::UnitZ()) * Turn(rpy[1], Vector3l::UnitY()) *
                  Turn(rpy[0], Vector3l::UnitX()))
              .toRotationMatrix();
        };
        const Matrix3l R = rotation({roll, pitch, yaw});
        EXPECT_LE((rotation(UrdfWriter::anglesOf(R)) - R).norm(), kRotation)
            << roll << " " << pitch << " " << yaw;
      }
    }
  }
}

void expectSame(const AppliedWrench& a, const AppliedWrench& b) {
  EXPECT_EQ(a.link, b.link);
  EXPECT_EQ(a.at, b.at);
  EXPECT_EQ(a.axes, b.axes);
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.torque, b.torque);
}

void expectSame(const JointTerms& a, const JointTerms& b) {
  EXPECT_EQ(a.joint, b.joint);
  EXPECT_EQ(a.stiffness, b.stiffness);
  EXPECT_EQ(a.rest, b.rest);
  EXPECT_EQ(a.damping, b.damping);
  EXPECT_EQ(a.coulomb, b.coulomb);
  EXPECT_EQ(a.coulomb_velocity, b.coulomb_velocity);
  EXPECT_EQ(a.rotor_inertia, b.rotor_inertia);
}

TEST(SceneWriter, ReadsBackToTheSameScene) {
  for (unsigned seed = 1; seed <= kTrees && !testing::Test::HasFailure(); ++seed) {
    RandomCases random(seed);
    const Scene written = random.next().scene;
    const Scene read = readScene(YAML::Load(yamlText(written)));
    SCOPED_TRACE(yamlText(written));
    EXPECT_EQ(written.gravity, read.gravity);
    EXPECT_EQ(written.static_motion, read.static_motion);
    EXPECT_EQ(written.reactions, read.reactions);
    EXPECT_EQ(written.reaction_names, read.reaction_names);
    EXPECT_EQ(written.include_active, read.include_active);
    EXPECT_EQ(written.strict_inertia, read.strict_inertia);
    ASSERT_EQ(written.applied_wrenches.size(), read.applied_wrenches.size());
    for (std::size_t i = 0; i < read.applied_wrenches.size(); ++i) {
      expectSame(written.applied_wrenches[i], read.applied_wrenches[i]);
    }
    EXPECT_EQ(written.use_urdf_dynamics, read.use_urdf_dynamics);
    ASSERT_EQ(written.joints.size(), read.joints.size());
    for (std::size_t i = 0; i < read.joints.size(); ++i) {
      expectSame(written.joints[i], read.joints[i]);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
