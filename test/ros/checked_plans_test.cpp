#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "allocation_guard.h"
#include "plan_maker.h"
#include "ros/cross_check.h"
#include "ros/plan_switch.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/urdf_reader.h"
#include "wait_until.h"

namespace virtual_work_dynamics {
namespace {

// Both routes round: a few eps for each of the 9 links that a wrench may have gone through.
constexpr double kSound = 1e-13;

/// Plans as the node compiles them, for one robot.
class CheckedPlans : public testing::Test {
 protected:
  explicit CheckedPlans(const Scene& wanted = Scene())
      : robot(3, 9), mechanism(readUrdf(robot.urdf())), scene(wanted), maker(mechanism, scene) {}

  std::unique_ptr<ActivePlan> compile(const Topics& topics, bool checked = true) const {
    return maker.compile(topics, PlanChecks{checked, checked});
  }

  void compute(ActivePlan& plan) {
    maker.samples.motion() = robot.motion(mechanism);
    ASSERT_EQ(maker.samples.compute(plan, 1), SampleComputation::Outcome::kDone);
  }

  void expectSound(ActivePlan& plan) {
    compute(plan);
    const auto finding = plan.cross_check->check();
    ASSERT_TRUE(finding);
    EXPECT_LE(finding->largest, kSound);
    const auto certified = maker.certificates.take();
    ASSERT_TRUE(certified);
    EXPECT_LE(certified->largest(), kSound);
  }

  // Topics of the first and the third reaction that the scene asks for.
  Topics wrenchesOnly() const {
    return {"reaction/" + maker.reactions[0], "reaction/" + maker.reactions[2]};
  }

  Topics everything() const {
    Topics topics{"effort", "reactions", "joint_trajectory"};
    for (const std::string& topic : wrenchesOnly()) topics.push_back(topic);
    return topics;
  }

  RandomRobot robot;
  Mechanism mechanism;
  Scene scene;
  PlanMaker maker;
};

const Topics kEffortOnly{"effort"};

TEST_F(CheckedPlans, CheckNothingThatNobodyListensTo) {
  const auto plan = compile({});
  EXPECT_FALSE(plan->cross_check);
  EXPECT_FALSE(plan->certifier);
  EXPECT_FALSE(plan->dynamics.request().efforts);
  EXPECT_EQ(describe(*plan), "nothing");
}

TEST_F(CheckedPlans, PublishNothingOfWhatCertificatesNeed) {
  const auto plan = compile(wrenchesOnly());
  EXPECT_TRUE(plan->dynamics.request().efforts);
  EXPECT_EQ(plan->dynamics.request().child_axes.size(), 3u);
  compute(*plan);
  EXPECT_EQ(plan->outputs.size(), 2u);
  for (const std::string& topic : wrenchesOnly()) {
    EXPECT_EQ(maker.message<geometry_msgs::WrenchStamped>(*plan, topic).message().header.stamp,
              ros::Time(0, 1));
  }
}

TEST_F(CheckedPlans, AreAsEverWithChecksOff) {
  const auto plan = compile(wrenchesOnly(), false);
  EXPECT_FALSE(plan->cross_check);
  EXPECT_FALSE(plan->certifier);
  EXPECT_FALSE(plan->dynamics.request().efforts);
  EXPECT_EQ(plan->dynamics.request().child_axes.size(), 2u);
  compute(*plan);
  EXPECT_FALSE(maker.certificates.take());
}

TEST_F(CheckedPlans, AreCheckedAcrossSwitches) {
  PlanSwitch plans(compile({}));
  CrossCheck cross_check(1000);
  std::uint64_t done = 0;
  for (const Topics& topics : {kEffortOnly, wrenchesOnly(), kEffortOnly}) {
    auto next = compile(topics);
    cross_check.watch(next->cross_check);
    plans.offer(std::move(next));
    compute(plans.current());
    plans.collect();
    CrossCheck::Report report;
    waitUntil([&] { return (report = cross_check.takeReport()).news; });
    EXPECT_EQ(report.done, ++done);
    EXPECT_LE(report.finding.largest, kSound);
    const auto certified = maker.certificates.take();
    ASSERT_TRUE(certified);
    EXPECT_LE(certified->largest(), kSound);
  }
}

Scene staticScene() {
  Scene scene;
  scene.static_motion = true;
  return scene;
}

class CheckedStaticPlans : public CheckedPlans {
 protected:
  CheckedStaticPlans() : CheckedPlans(staticScene()) {}
};

// Static plans do not use the accelerations of the motion.
TEST_F(CheckedStaticPlans, AreSound) {
  expectSound(*compile(everything()));
}

Scene busyScene() {
  Scene scene;
  scene.include_active = false;
  scene.reactions = ReactionSelection::kNamed;
  scene.reaction_names = {kGround, "joint_3", "joint_5", "joint_8"};
  scene.moments_about = {{"joint_3", JointFrame::kParent, std::nullopt, {0.1, 0.2, -0.1}},
                         {"joint_8", JointFrame::kChild, "link_2", {0, 30, 0}}};
  scene.applied_wrenches.resize(1);
  scene.applied_wrenches[0].link = "link_5";
  scene.applied_wrenches[0].at << 0.1, -0.2, 0.3;
  scene.applied_wrenches[0].force << 10, 20, -30;
  scene.applied_wrenches[0].torque << 1, -2, 3;
  return scene;
}

class CheckedBusyPlans : public CheckedPlans {
 protected:
  CheckedBusyPlans() : CheckedPlans(busyScene()) {}
};

TEST_F(CheckedBusyPlans, AreSound) {
  expectSound(*compile(everything()));
  // Ground is the first of them.
  expectSound(*compile(wrenchesOnly()));
}

TEST_F(CheckedPlans, ComputeAndCheckWithoutAllocation) {
  const auto plan = compile(kEffortOnly);
  maker.samples.motion() = robot.motion(mechanism);
  const AllocationGuard guard;
  const SampleComputation::Outcome outcome = maker.samples.compute(*plan, 1);
  const std::size_t allocations = guard.allocations();
  EXPECT_EQ(outcome, SampleComputation::Outcome::kDone);
  EXPECT_EQ(allocations, 0u);
  EXPECT_TRUE(plan->cross_check->full());
}

TEST_F(CheckedPlans, MarkersAreWrittenWithoutAllocation) {
  const auto plan = maker.compile({"markers"});
  maker.samples.motion() = robot.motion(mechanism);
  const AllocationGuard guard;
  const SampleComputation::Outcome outcome = maker.samples.compute(*plan, 1);
  const std::size_t allocations = guard.allocations();
  EXPECT_EQ(outcome, SampleComputation::Outcome::kDone);
  EXPECT_EQ(allocations, 0u);
  const auto& markers = maker.message<visualization_msgs::MarkerArray>(*plan, "markers");
  EXPECT_NE(markers.message().markers.at(0).text.find(" N, "), std::string::npos);
}

}  // namespace
}  // namespace virtual_work_dynamics
