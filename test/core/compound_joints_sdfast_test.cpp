// Reactions that SD/FAST finds for a chain with a ball joint, as Simbody's tests publish them.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/free_turn.h"
#include "virtual_work_dynamics/joint_types.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// Half a unit of the sixth decimal, and what Simbody's own test allows of the norm.
constexpr double kPrinted = 1e-5;

// Mass and inertia of a body about its centre, which is at (0, y, 0) of the link.
std::string link(const std::string& name, double mass, double y) {
  return "<link name='" + name + "'><inertial><origin xyz='0 " + std::to_string(y) +
         " 0'/><mass value='" + std::to_string(mass) +
         "'/><inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0.01' ixz='0.01' iyz='0.01'/>"
         "</inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& at, const std::string& axis) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + at + "'/><axis xyz='" + axis +
         "'/><limit lower='-9' upper='9' effort='1' velocity='1'/></joint>";
}

// Simbody/tests/TestMobilizerReactionForces.cpp, testByComparingToSDFAST: a slide along x, a pin
// about z, a ball and a pin about z, all of them free. Links begin at their joints, 0.2 below the
// centres.
class SdFastChain : public ::testing::Test {
 protected:
  SdFastChain()
      : scene_(readScene(YAML::Load("{gravity: [0, -9.8, 0], reactions: [slide, hip, ball, knee], "
                                    "joint_types: [{name: ball, type: spherical}]}"))),
        mechanism_(withJointTypes(
            readUrdf("<robot name='chain'><link name='ground_link'/>" + link("body1", 10, 0) +
                     link("body2", 20, 0.2) + link("body3", 20, 0.2) + link("body4", 30, 0.2) +
                     joint("slide", "prismatic", "ground_link", "body1", "0 0 0", "1 0 0") +
                     joint("hip", "continuous", "body1", "body2", "0.1 0.1 0", "0 0 1") +
                     joint("ball", "fixed", "body2", "body3", "0 0.4 0", "0 0 1") +
                     joint("knee", "continuous", "body3", "body4", "0 0.4 0", "0 0 1") +
                     "</robot>"),
            scene_)),
        motion_(static_cast<Eigen::Index>(mechanism_.coordinates().size()), 1) {}

  Eigen::Index at(const std::string& name) const { return mechanism_.coordinateIndex(name); }

  // Gives the motion the accelerations with which no joint needs an effort: efforts are linear in
  // them.
  const std::vector<Wrench>& freeReactions() {
    Request request;
    request.child_axes = {"slide", "hip", "ball", "knee"};
    dynamics_ = std::make_unique<Dynamics>(mechanism_, scene_, request);
    workspace_ = std::make_unique<Dynamics::Workspace>(dynamics_->makeWorkspace());
    const auto efforts = [&](const Eigen::VectorXd& qdd) {
      motion_.qdd = qdd;
      dynamics_->compute(motion_, *workspace_);
      return Eigen::VectorXd(workspace_->results().effort);
    };
    const Eigen::Index n = motion_.q.size();
    const Eigen::VectorXd bias = efforts(Eigen::VectorXd::Zero(n));
    Eigen::MatrixXd mass(n, n);
    for (Eigen::Index i = 0; i < n; ++i) mass.col(i) = efforts(Eigen::VectorXd::Unit(n, i)) - bias;
    EXPECT_LT(efforts(mass.ldlt().solve(-bias)).norm(), 1e-10);
    return workspace_->results().child_axes;
  }

  // Moment, then force, in axes of each body, as Simbody's test has them.
  void expect(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& published) {
    const std::vector<Wrench>& found = freeReactions();
    ASSERT_EQ(found.size(), published.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto& [moment, force] = published[i];
      EXPECT_LE((found[i].torque - moment).cwiseAbs().maxCoeff(),
                kPrinted * std::max(1.0, moment.norm()))
          << i << ": " << found[i].torque.transpose();
      EXPECT_LE((found[i].force - force).cwiseAbs().maxCoeff(),
                kPrinted * std::max(1.0, force.norm()))
          << i << ": " << found[i].force.transpose();
    }
  }

  Scene scene_;
  Mechanism mechanism_;
  Motion motion_;
  std::unique_ptr<Dynamics> dynamics_;
  std::unique_ptr<Dynamics::Workspace> workspace_;
};

TEST_F(SdFastChain, HangsUpright) {
  expect({{{0, 0, 68.6}, {0, 784, 0}},
          {{0, 0, 0}, {0, 686, 0}},
          {{0, 0, 0}, {0, 490, 0}},
          {{0, 0, 0}, {0, 294, 0}}});
}

TEST_F(SdFastChain, FallsFromAnotherPosition) {
  motion_.q[at("slide")] = 1;
  motion_.q[at("hip")] = 0.5;
  motion_.q[at("knee")] = -0.5;
  FreeTurn turn;
  turn.orientation = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitY());
  setFreeTurn(mechanism_, 0, turn, motion_);
  expect({{{1.647327, 0.783211, 34.088183}, {0, 359.274099, 3.342380}},
          {{1.688077, 0.351125, 0}, {55.399123, 267.455570, 3.342380}},
          {{0, 0, 0}, {-17.757553, 174.663042, -11.383057}},
          {{0.910890, 0.082353, 0}, {-13.977214, 74.444715, 4.943682}}});
}

TEST_F(SdFastChain, HasMomentum) {
  motion_.qd[at("hip")] = 1;
  motion_.qd[at("knee")] = 5;
  FreeTurn turn;
  turn.angular_velocity << 3, 4, 2;
  setFreeTurn(mechanism_, 0, turn, motion_);
  expect({{{-13.549253, 2.723897, -6.355912}, {0, 34, -27.088584}},
          {{-10.840395, 0.015039, 0}, {-0.440882, -64, -27.088584}},
          {{0, 0, 0}, {0.692814, -256, -27.088584}},
          {{3.276930, -0.281928, 0}, {3.796164, -372, 21.472977}}});
}

// RigidBodyDynamics.jl, test/urdf/planar_slider.urdf: about which axes a planar joint slides whose
// normal is x, y or z. Its first two axes are a rotation of x and y onto the plane; here the axes
// are those that the scene's documentation says, and the plane is the same.
TEST(PlanarSlider, SlidesInThePlaneOfItsNormal) {
  for (int normal = 0; normal < 3; ++normal) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(normal);
    const std::string text =
        std::to_string(axis.x()) + " " + std::to_string(axis.y()) + " " + std::to_string(axis.z());
    const Mechanism mechanism =
        readUrdf("<robot name='slider'><link name='base'/>" + link("slider1", 1, 0) +
                 joint("j", "planar", "base", "slider1", "0 0 0", text) + "</robot>");
    ASSERT_EQ(mechanism.coordinates().size(), 3u);
    Scene scene;
    scene.gravity.setZero();
    Request request;
    request.root_axes = {"j"};
    request.poses = true;
    const Dynamics dynamics(mechanism, scene, request);
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    Eigen::Matrix3d slides;
    for (int i = 0; i < 3; ++i) {
      Motion motion(3);
      motion.q[i] = 0.7;
      dynamics.compute(motion, workspace);
      const Pose& pose = workspace.results().poses[0];
      if (i < 2) {
        slides.col(i) = pose.position / 0.7;
        EXPECT_LT(pose.orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-7);
      } else {
        slides.col(i) = 2 * pose.orientation.vec() / (2 * std::sin(0.35));
        EXPECT_LT(pose.position.norm(), 1e-15);
      }
    }
    EXPECT_LT((slides.col(2) - axis).norm(), 1e-14);
    EXPECT_LT((slides.transpose() * slides - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(slides.determinant(), 1, 1e-14);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
