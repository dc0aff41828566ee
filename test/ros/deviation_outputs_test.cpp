#include <diagnostic_msgs/DiagnosticStatus.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>

#include <cstddef>
#include <string>
#include <vector>

#include "allocation_guard.h"
#include "plan_maker.h"
#include "ros/deviation_report.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using diagnostic_msgs::DiagnosticStatus;

Scene tolerant() {
  Scene scene;
  scene.tolerances.mass = 0.03;
  return scene;
}

/// Samples of the composed pendulum as the node computes them.
class DeviationOutputs : public testing::Test {
 protected:
  DeviationOutputs() {
    motion_.q << 0.4, 0.2;
    motion_.qd << 1, -2;
    motion_.qdd << 3, 4;
    covariance_.coordinates.assign(2, Eigen::Vector3d(1e-10, 1e-6, 1e-2).asDiagonal());
  }

  SampleComputation::Outcome compute(PlanMaker& maker, ActivePlan& plan,
                                     MotionCovariance* covariance) {
    maker.samples.motion() = motion_;
    return maker.samples.compute(plan, 7, covariance);
  }
  // The status with what is in doubt.
  static diagnostic_updater::DiagnosticStatusWrapper report(const PlanMaker& maker,
                                                            double threshold) {
    diagnostic_updater::DiagnosticStatusWrapper status;
    status.summary(DiagnosticStatus::OK, "running");
    DeviationReport(maker.deviations, threshold).add(status);
    return status;
  }

  const Mechanism mechanism_ = readUrdf(pendulumUrdf());
  const std::vector<std::string> names_ = {"joint_1", "joint_2"};
  Motion motion_{2};
  MotionCovariance covariance_;
};

TEST_F(DeviationOutputs, MessagesHoldBothSharesApart) {
  const Scene scene = tolerant();
  PlanMaker maker(mechanism_, scene);
  const auto plan = maker.compile({"effort_deviation", "effort_tolerance"});
  ASSERT_EQ(compute(maker, *plan, &covariance_), SampleComputation::Outcome::kDone);
  const Deviations deviations(mechanism_, scene, Request());
  Deviations::Workspace workspace = deviations.makeWorkspace();
  deviations.computeMotion(motion_, covariance_, workspace);
  deviations.computeDescription(motion_, workspace);
  const auto expect = [&](const std::string& topic, const Eigen::VectorXd& wanted) {
    const auto& of = maker.message<sensor_msgs::JointState>(*plan, topic);
    EXPECT_TRUE(of.exists());
    EXPECT_EQ(of.message().name, names_);
    EXPECT_EQ(of.message().header.stamp.toNSec(), 7u);
    EXPECT_EQ(of.message().header.frame_id, "base");
    EXPECT_TRUE(of.message().position.empty() && of.message().velocity.empty());
    ASSERT_EQ(of.message().effort.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(of.message().effort[i], wanted[static_cast<Eigen::Index>(i)]);
      EXPECT_GT(of.message().effort[i], 0);
    }
  };
  expect("effort_deviation", workspace.motion().effort);
  expect("effort_tolerance", workspace.description().effort);
}

TEST_F(DeviationOutputs, NothingIsPublishedOfMotionsWhoseErrorIsNotKnown) {
  const Scene scene = tolerant();
  PlanMaker maker(mechanism_, scene);
  const auto plan = maker.compile({"effort_deviation", "effort_tolerance"});
  ASSERT_EQ(compute(maker, *plan, nullptr), SampleComputation::Outcome::kDone);
  EXPECT_FALSE(maker.message<sensor_msgs::JointState>(*plan, "effort_deviation").exists());
  EXPECT_TRUE(maker.message<sensor_msgs::JointState>(*plan, "effort_tolerance").exists());
  EXPECT_EQ(maker.deviations->take(0).samples, 0u);
}

TEST_F(DeviationOutputs, EffortsWithoutADeviationAreLeftOut) {
  const Scene scene;
  PlanMaker maker(mechanism_, scene);
  const auto plan = maker.compile({"effort_deviation"});
  covariance_.coordinates[1](2, 2) = -1;
  compute(maker, *plan, &covariance_);
  const auto& of = maker.message<sensor_msgs::JointState>(*plan, "effort_deviation");
  EXPECT_TRUE(of.message().name.empty() && of.message().effort.empty());
  covariance_.coordinates[1](2, 2) = 1;
  compute(maker, *plan, &covariance_);
  EXPECT_EQ(of.message().name, names_);
  EXPECT_EQ(of.message().effort.size(), 2u);
}

TEST_F(DeviationOutputs, WithoutTolerancesThereIsNoTopicForThem) {
  const Scene scene;
  const PlanMaker maker(mechanism_, scene);
  EXPECT_THROW(maker.audience({"effort_tolerance"}), std::invalid_argument);
}

TEST_F(DeviationOutputs, DoubtsAreAWarningThatNamesJointAndCause) {
  const Scene scene = tolerant();
  PlanMaker maker(mechanism_, scene);
  const auto plan = maker.compile({"effort_deviation"});
  EXPECT_EQ(report(maker, 1e-9).level, DiagnosticStatus::OK);
  compute(maker, *plan, &covariance_);
  const auto status = report(maker, 1e-3);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("effort of 'joint_1'"), std::string::npos) << status.message;
  EXPECT_NE(status.message.find("mostly from the"), std::string::npos) << status.message;
  EXPECT_EQ(report(maker, 1e-3).level, DiagnosticStatus::OK);  // nothing since
  compute(maker, *plan, &covariance_);
  const auto fine = report(maker, 1e3);
  EXPECT_EQ(fine.level, DiagnosticStatus::OK);
  EXPECT_EQ(fine.values.back().value, "none");
}

TEST_F(DeviationOutputs, FillingMessagesDoesNotAllocate) {
  const Scene scene = tolerant();
  PlanMaker maker(mechanism_, scene);
  const auto plan = maker.compile({"effort_deviation", "effort_tolerance"});
  compute(maker, *plan, &covariance_);
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) compute(maker, *plan, &covariance_);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace virtual_work_dynamics
