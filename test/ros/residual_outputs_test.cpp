#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ros/outputs.h"
#include "ros/residual_output.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::int64_t kMs = 1000000;
constexpr double kMaxGap = 0.25;  // s
constexpr double kGain = 50;      // 1/s
constexpr double kPush = 3;       // N m
// Other ways to the same efforts round differently.
constexpr double kRounding = 1e-12;

Scene downwards() {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  return scene;
}

/// The composed pendulum at rest, pushed at its second joint, with measured efforts.
class ResidualOutputs : public testing::Test {
 protected:
  using Message = MessageOf<sensor_msgs::JointState>;

  ResidualOutputs() {
    motion_.q << 0.4, 0.2;
    plan_.compute(motion_, workspace_);
  }

  /// A joint state of the first joints.
  void take(int joints = 2) {
    now_ += kMs;
    const int coordinates[] = {0, 1};
    const double effort[] = {results().effort[0], results().effort[1] - kPush};
    JointSample sample;
    sample.stamp_ns = now_;
    sample.count = joints;
    sample.coordinates = coordinates;
    sample.q = motion_.q.data();
    sample.qd = motion_.qd.data();
    sample.effort = effort;
    efforts_->take(sample);
  }

  const Results& results() { return workspace_.results(); }

  void fill(OutputMessage& message, bool measured = true) {
    message.fill({now_, motion_, results(), nullptr, nullptr, measured});
  }

  /// The external effort that the message has, by the name of its joint.
  static double valueOf(const OutputMessage& message, const std::string& name) {
    const auto& written = dynamic_cast<const Message&>(message);
    for (std::size_t i = 0; written.exists() && i < written.message().name.size(); ++i) {
      if (written.message().name[i] == name) return written.message().effort[i];
    }
    return std::nan("");
  }

  std::unique_ptr<Output> observer() const {
    return makeExternalEffortOutput(mechanism_, "base", kGain, kMaxGap, efforts_, nullptr);
  }

  const Mechanism mechanism_ = readUrdf(pendulumUrdf());
  const Scene scene_ = downwards();
  const Dynamics plan_{mechanism_, scene_};
  Dynamics::Workspace workspace_ = plan_.makeWorkspace();
  Motion motion_{2};
  std::int64_t now_ = 1600000000000 * kMs;
  std::shared_ptr<EffortMeasurements> efforts_ =
      std::make_shared<EffortMeasurements>(mechanism_.coordinateNames(), kMaxGap);
};

TEST_F(ResidualOutputs, AreOfWhatIsMeasuredOnly) {
  const auto residual = makeResidualOutput("base", efforts_, nullptr);
  const auto computed = residual->makeMessage(plan_, scene_);
  const auto observed = observer()->makeMessage(plan_, scene_);
  for (int i = 0; i < 10; ++i) {
    take();
    for (const bool measured : {true, false}) {
      for (const auto* message : {&computed, &observed}) {
        fill(**message, measured);
        EXPECT_EQ(dynamic_cast<const Message&>(**message).exists(), measured);
      }
    }
    fill(*computed);
    EXPECT_NEAR(valueOf(*computed, "joint_1"), 0, kRounding);
    EXPECT_NEAR(valueOf(*computed, "joint_2"), kPush, kRounding);
  }
}

TEST_F(ResidualOutputs, ObserverLeavesOutAJointThatHasStopped) {
  const auto observed = observer()->makeMessage(plan_, scene_);
  for (int i = 0; i < 10; ++i) {
    take();
    fill(*observed);
  }
  EXPECT_FALSE(std::isnan(valueOf(*observed, "joint_2")));
  for (int i = 0; i < 251; ++i) {
    take(1);
    fill(*observed);
  }
  EXPECT_TRUE(std::isnan(valueOf(*observed, "joint_2")));
  EXPECT_NEAR(valueOf(*observed, "joint_1"), 0, kRounding);
  take();
  fill(*observed);
  EXPECT_EQ(valueOf(*observed, "joint_2"), 0);  // begins anew
}

TEST_F(ResidualOutputs, ObserverGoesOnInANewPlanUnlessLoadsChange) {
  const auto output = observer();
  const auto first = output->makeMessage(plan_, scene_);
  for (int i = 0; i < 200; ++i) {
    take();
    fill(*first);
  }
  const double before = valueOf(*first, "joint_2");
  EXPECT_NEAR(before, kPush, 1e-3);  // 3 N m e^(-50 * 0.199)
  const auto second = output->makeMessage(plan_, scene_);
  take();
  fill(*second);
  EXPECT_NEAR(valueOf(*second, "joint_2"), kPush, 1e-3);
  Scene loaded = scene_;
  loaded.payloads.push_back({"rod_2", 0.5, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()});
  const auto third = output->makeMessage(plan_, loaded);
  take();
  fill(*third);
  EXPECT_EQ(valueOf(*third, "joint_2"), 0);
}

}  // namespace
}  // namespace virtual_work_dynamics
