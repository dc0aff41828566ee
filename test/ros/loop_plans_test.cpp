#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "allocation_guard.h"
#include "plan_maker.h"
#include "ros/determinacy_message.h"
#include "slider_crank.h"

namespace virtual_work_dynamics {
namespace {

using Outcome = SampleComputation::Outcome;
using Names = std::vector<std::string>;

constexpr LoopLimits kLimits{1e-6, 1e4};
// A dozen terms of four bodies, relative to the sum of their magnitudes.
constexpr double kSound = 1e-14;

/// A slider-crank as the node computes it.
class LoopPlans : public testing::Test {
 protected:
  explicit LoopPlans(const std::string& actuated = "joint_3")
      : mechanism(slider_crank.mechanism()),
        scene(gravityOn(slider_crank.scene(actuated))),
        maker(mechanism, scene, true, kLimits, "left/") {}

  static Scene gravityOn(Scene scene) {
    scene.gravity << 0, -9.81, 0;
    return scene;
  }

  std::unique_ptr<ActivePlan> compile(const Topics& topics, PlanChecks checks = {}) const {
    return maker.compile(topics, checks);
  }

  /// Computes a sample of joint states that give all joints.
  Outcome compute(ActivePlan& plan, const Motion& motion) {
    const std::vector<int> all{0, 1, 2};
    maker.completer.saw(all.data(), 3);
    maker.samples.motion() = motion;
    return maker.samples.compute(plan, 1);
  }

  const MessageOf<sensor_msgs::JointState>& effortOf(const ActivePlan& plan) const {
    return maker.message<sensor_msgs::JointState>(plan, "effort");
  }
  const MessageOf<geometry_msgs::WrenchStamped>& wrenchOf(const ActivePlan& plan,
                                                          const std::string& name) const {
    return maker.message<geometry_msgs::WrenchStamped>(plan, "reaction/" + name);
  }

  SliderCrank slider_crank{0.5};
  Mechanism mechanism;
  Scene scene;
  PlanMaker maker;
};

const Topics kEverything{"effort", "reactions", "reaction/joint_2", "reaction/pin"};

/// The message of ~determinacy as it would be published.
class Determinacies {
 public:
  explicit Determinacies(const PlanMaker& maker)
      : places_(maker.reactions.size()),
        message_(assembledDeterminacy(maker.mechanism, maker.everything, maker.reactions,
                                      kLimits.condition)) {
    std::iota(places_.begin(), places_.end(), 0);
  }

  bool update(const ActivePlan& plan) {
    return message_.update(1, plan.workspace.results().loops, places_, places_);
  }
  const diagnostic_msgs::DiagnosticStatus& status(std::size_t i) const {
    return message_.message().status[i];
  }

 private:
  std::vector<std::size_t> places_;
  DeterminacyMessage message_;
};

TEST_F(LoopPlans, LeaveOutWhatHasNoValueAndTakeItInAgain) {
  const auto plan = compile(kEverything);
  const auto& reactions = maker.message<sensor_msgs::MultiDOFJointState>(*plan, "reactions");
  const Names joints{"joint_1", "joint_2", "joint_3"};
  for (const double angle : {0.7, 0.0, 0.8, 0.0, 0.9}) {
    ASSERT_EQ(compute(*plan, SliderCrank::motion(angle, 0, 0)), Outcome::kDone);
    const bool singular = angle == 0;
    EXPECT_EQ(plan->workspace.results().singular(), singular);
    const sensor_msgs::JointState& effort = effortOf(*plan).message();
    // Nothing bears what moves freely there, and so no effort has a value.
    EXPECT_EQ(effort.name, singular ? Names() : joints);
    for (const auto* values : {&effort.position, &effort.velocity, &effort.effort}) {
      EXPECT_EQ(values->size(), effort.name.size());
    }
    if (!singular) {
      EXPECT_EQ(effort.position[0], angle);
      EXPECT_EQ(effort.effort[0], 0);
    }
    const sensor_msgs::MultiDOFJointState& wrenches = reactions.message();
    EXPECT_EQ(wrenches.joint_names, singular ? Names() : maker.reactions);
    EXPECT_EQ(wrenches.wrench.size(), wrenches.joint_names.size());
    EXPECT_EQ(wrenches.transforms.size(), wrenches.joint_names.size());
    EXPECT_EQ(wrenches.twist.size(), wrenches.joint_names.size());
    EXPECT_EQ(wrenchOf(*plan, "joint_2").exists(), !singular);
    EXPECT_EQ(wrenchOf(*plan, "pin").exists(), !singular);
  }
  EXPECT_EQ(wrenchOf(*plan, "joint_2").message().header.frame_id, "left/link_2");
  EXPECT_EQ(wrenchOf(*plan, "pin").message().header.frame_id, "left/pin");
  const LoopRecord::Report report = maker.loops.take();
  EXPECT_TRUE(report.news);
  EXPECT_EQ(report.singular, 2u);
  EXPECT_EQ(report.violations, 0u);
  EXPECT_EQ(report.efforts, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(report.reactions, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_TRUE(maker.loops.take().efforts.empty());
  EXPECT_FALSE(maker.loops.take().news);
}

// Out of plane nothing is determined in any position, so nothing is left out.
TEST_F(LoopPlans, PublishWhatRedundantConstraintsLeaveOpen) {
  Topics topics = kEverything;
  topics.push_back("determinacy");
  const auto plan = compile(topics);
  ASSERT_EQ(compute(*plan, SliderCrank::motion(0.7, 0, 0)), Outcome::kDone);
  EXPECT_FALSE(plan->workspace.results().loops.root_axes_determined[0][2]);
  const auto& message = maker.message<sensor_msgs::MultiDOFJointState>(*plan, "reactions");
  EXPECT_EQ(message.message().joint_names, maker.reactions);
}

TEST_F(LoopPlans, FindWhatIsDeterminedOnRequestOnly) {
  const auto plan = compile(kEverything);
  ASSERT_EQ(compute(*plan, SliderCrank::motion(0.7, 0, 0)), Outcome::kDone);
  EXPECT_TRUE(plan->workspace.results().loops.root_axes_determined.empty());
}

TEST_F(LoopPlans, WrenchesAreThoseOfTheirJointsWithDeterminacyToo) {
  Topics topics = kEverything;
  const auto some = compile(topics);
  topics.push_back("determinacy");
  const auto all = compile(topics);
  EXPECT_EQ(all->dynamics.request().child_axes.size(), maker.reactions.size());
  EXPECT_EQ(some->dynamics.request().child_axes.size(), 2u);
  const Motion motion = SliderCrank::motion(0.7, 1, 2);
  ASSERT_EQ(compute(*some, motion), Outcome::kDone);
  ASSERT_EQ(compute(*all, motion), Outcome::kDone);
  for (const char* name : {"joint_2", "pin"}) {
    const geometry_msgs::Wrench& one = wrenchOf(*some, name).message().wrench;
    const geometry_msgs::Wrench& other = wrenchOf(*all, name).message().wrench;
    EXPECT_NE(one.force.x, 0);
    EXPECT_EQ(one.force.x, other.force.x);
    EXPECT_EQ(one.force.y, other.force.y);
    EXPECT_EQ(one.torque.z, other.torque.z);
  }
  // Reactions that are computed only for flags appear in no message.
  const auto flags = compile({"determinacy"});
  ASSERT_EQ(compute(*flags, motion), Outcome::kDone);
  EXPECT_EQ(flags->outputs.size(), 1u);
}

TEST_F(LoopPlans, DeterminacyChangesWithThePosition) {
  const auto plan = compile({"determinacy"});
  Determinacies determinacies(maker);
  const auto changed = [&](double angle) {
    EXPECT_EQ(compute(*plan, SliderCrank::motion(angle, 0, 0)), Outcome::kDone);
    return determinacies.update(*plan);
  };
  EXPECT_FALSE(changed(0.7));  // as assembled
  EXPECT_TRUE(changed(0));
  EXPECT_FALSE(changed(0));
  EXPECT_TRUE(changed(0.4));
}

// The slider holds the crank by a lever that is as long as the angle from the dead centre.
TEST_F(LoopPlans, ConditionGrowsTowardsDeadCentre) {
  const auto plan = compile({"effort", "determinacy"});
  Determinacies determinacies(maker);
  const auto computed = [&](double angle) {
    EXPECT_EQ(compute(*plan, SliderCrank::motion(angle, 0, 0)), Outcome::kDone);
    return maker.loops.take();
  };
  const auto changed = [&] { return determinacies.update(*plan); };
  const auto level = [&] { return determinacies.status(0).level; };
  LoopRecord::Report report = computed(0.7);
  EXPECT_LT(report.conditions[0], 100);
  EXPECT_EQ(report.close_to_singular, 0u);
  changed();
  EXPECT_EQ(level(), diagnostic_msgs::DiagnosticStatus::OK);
  for (const double angle : {1e-5, -1e-8}) {
    report = computed(angle);
    EXPECT_GT(report.conditions[0], 0.1 / std::abs(angle));
    EXPECT_LT(report.conditions[0], 100 / std::abs(angle));
    EXPECT_EQ(report.determinacy.free_motions, 0);
    EXPECT_EQ(changed(), angle > 0);  // later positions are not news
    EXPECT_EQ(level(), diagnostic_msgs::DiagnosticStatus::WARN);
  }
  EXPECT_EQ(report.close_to_singular, 2u);
  EXPECT_NE(determinacies.status(0).message.find("close to a singular position"),
            std::string::npos);
  report = computed(0);
  EXPECT_EQ(report.close_to_singular, 2u);
  EXPECT_EQ(report.singular, 1u);
  EXPECT_EQ(report.conditions[0], 0);
  report = computed(0.7);
  EXPECT_LT(report.conditions[0], 100);
  EXPECT_TRUE(changed());
  EXPECT_EQ(level(), diagnostic_msgs::DiagnosticStatus::OK);
}

TEST_F(LoopPlans, MotionsThatViolateALoopAreComputedAndCounted) {
  const auto plan = compile(kEverything);
  Motion motion = SliderCrank::motion(0.7, 0, 0);
  motion.q[2] += 0.01;
  ASSERT_EQ(compute(*plan, motion), Outcome::kDone);
  EXPECT_EQ(effortOf(*plan).message().position[2], motion.q[2]);
  const LoopRecord::Report report = maker.loops.take();
  EXPECT_EQ(report.violations, 1u);
  EXPECT_NEAR(report.residuals[0][0], 0.01, 1e-15);
  EXPECT_GT(report.relative[0][0], kLimits.tolerance);
}

TEST_F(LoopPlans, AreCertifiedOutOfSingularPositions) {
  const Topics only_wrenches{"reaction/joint_2", "reaction/pin"}, only_determinacy{"determinacy"};
  for (const Topics& topics : {kEverything, only_wrenches, only_determinacy}) {
    const auto plain = compile(topics);
    const auto plan = compile(topics, PlanChecks{false, true});
    ASSERT_TRUE(plan->certifier);
    EXPECT_EQ(plan->dynamics.request().child_axes.size(),
              plain->dynamics.request().child_axes.size() + 1);
    ASSERT_EQ(compute(*plan, SliderCrank::motion(0.7, 1.5, -2)), Outcome::kDone);
    auto found = maker.certificates.take();
    ASSERT_TRUE(found);
    EXPECT_LE(found->largest(), kSound);
    EXPECT_GT(found->power + found->ground_force + found->ground_moment, 0);
    ASSERT_EQ(compute(*plan, SliderCrank::motion(0, 1.5, 0)), Outcome::kDone);
    EXPECT_FALSE(maker.certificates.take());
    // A motion that violates a loop is certified as it is.
    Motion violating = SliderCrank::motion(0.7, 1.5, -2);
    violating.q[2] += 0.01;
    violating.qd[1] += 0.1;
    // Results that begin to exist again and a new message on determinacy allocate.
    ASSERT_EQ(compute(*plan, violating), Outcome::kDone);
    maker.samples.motion() = violating;
    const AllocationGuard guard;
    const Outcome outcome = maker.samples.compute(*plan, 1);
    const std::size_t allocations = guard.allocations();
    ASSERT_EQ(outcome, Outcome::kDone);
    EXPECT_EQ(allocations, 0u);
    found = maker.certificates.take();
    ASSERT_TRUE(found);
    EXPECT_LE(found->largest(), kSound);
    EXPECT_TRUE(maker.loops.take().news);
  }
}

TEST_F(LoopPlans, AreCrossCheckedOutOfSingularPositions) {
  EXPECT_FALSE(compile({}, PlanChecks{true, false})->cross_check);
  const Topics only_effort{"effort"}, only_wrenches{"reaction/pin"}, flags{"determinacy"};
  for (const Topics& topics : {kEverything, only_effort, only_wrenches, flags}) {
    const auto plan = compile(topics, PlanChecks{true, false});
    ASSERT_TRUE(plan->cross_check);
    Motion violating = SliderCrank::motion(0.7, 1.5, -2);
    violating.q[2] += 0.01;
    violating.qd[1] += 0.1;
    for (const Motion& motion : {SliderCrank::motion(0.7, 1.5, -2), violating}) {
      ASSERT_EQ(compute(*plan, motion), Outcome::kDone);
      const auto finding = plan->cross_check->check();
      ASSERT_TRUE(finding);
      EXPECT_LE(finding->largest, kSound);
      EXPECT_FALSE(finding->where.empty());
    }
    ASSERT_EQ(compute(*plan, SliderCrank::motion(0, 1.5, 0)), Outcome::kDone);
    EXPECT_FALSE(plan->cross_check->full());
    ASSERT_EQ(compute(*plan, violating), Outcome::kDone);
    maker.samples.motion() = violating;
    const AllocationGuard guard;
    const Outcome outcome = maker.samples.compute(*plan, 1);
    const std::size_t allocations = guard.allocations();
    EXPECT_EQ(outcome, Outcome::kDone);
    EXPECT_EQ(allocations, 0u);
    EXPECT_TRUE(plan->cross_check->full());
  }
}

// Plans come and go with subscribers, but which results exist depends only on the position.
TEST_F(LoopPlans, WhatExistsDoesNotDependOnWhatWasMetBefore) {
  const auto fresh = compile(kEverything), travelled = compile(kEverything);
  for (const double angle : {0.7, 1.9, -2.2}) {
    ASSERT_EQ(compute(*travelled, SliderCrank::motion(angle, 0, 0)), Outcome::kDone);
  }
  for (ActivePlan* plan : {fresh.get(), travelled.get()}) {
    ASSERT_EQ(compute(*plan, SliderCrank::motion(0, 0, 0)), Outcome::kDone);
  }
  EXPECT_EQ(effortOf(*fresh).message().name, effortOf(*travelled).message().name);
  EXPECT_EQ(fresh->workspace.results().loops.root_axes_exist,
            travelled->workspace.results().loops.root_axes_exist);
  EXPECT_EQ(fresh->workspace.results().loops.child_axes_exist,
            travelled->workspace.results().loops.child_axes_exist);
}

// A trajectory's message is complete or not at all, and its points are samples only where they are
// published as such.
TEST_F(LoopPlans, TrajectoriesAreAnsweredAsAWhole) {
  const auto plan = compile({"effort", "joint_trajectory"});
  const auto& answer = maker.message<trajectory_msgs::JointTrajectory>(*plan, "joint_trajectory");
  trajectory_msgs::JointTrajectory message;
  message.joint_names = mechanism.coordinateNames();
  message.points.resize(2);
  TrajectoryMotion motion;
  motion.columns = motion.coordinates = {0, 1, 2};
  motion.stamps_ns = {1, 2};
  motion.table.joints = mechanism.coordinateNames();
  motion.table.times = {0, 1};
  for (auto* values :
       {&motion.table.positions, &motion.table.velocities, &motion.table.accelerations}) {
    values->setZero(2, 3);
  }
  motion.table.positions.row(0) = SliderCrank::motion(0.7, 0, 0).q;
  motion.table.positions.row(1) = SliderCrank::motion(0.8, 0, 0).q;
  for (auto& point : message.points) {
    point.positions = point.velocities = point.accelerations = {0, 0, 0};
  }
  for (ActiveOutput& output : plan->outputs) output.message->begin(message, motion);
  ASSERT_EQ(maker.samples.computeNext(*plan, motion, 0, false), Outcome::kDone);
  EXPECT_FALSE(answer.exists());
  EXPECT_EQ(effortOf(*plan).message().header.stamp, ros::Time());
  ASSERT_EQ(maker.samples.computeNext(*plan, motion, 1, true), Outcome::kDone);
  EXPECT_TRUE(answer.exists());
  EXPECT_EQ(answer.message().points[1].effort, effortOf(*plan).message().effort);
}

class LoopPlansOfTheCrank : public LoopPlans {
 protected:
  LoopPlansOfTheCrank() : LoopPlans("joint_1") {}
};

TEST_F(LoopPlansOfTheCrank, CompleteAndComputeWithoutAllocation) {
  const auto plan = compile(kEverything);
  maker.samples.motion().q[0] = 0.7;
  maker.samples.motion().qd[0] = 0.3;
  ASSERT_EQ(maker.samples.compute(*plan, 1), Outcome::kDone);
  maker.samples.motion().q[0] = 2.9;  // far enough to be halved
  const AllocationGuard guard;
  const Outcome outcome = maker.samples.compute(*plan, 2);
  const std::size_t allocations = guard.allocations();
  EXPECT_EQ(outcome, Outcome::kDone);
  EXPECT_EQ(allocations, 0u);
  EXPECT_NEAR(effortOf(*plan).message().position[2], SliderCrank::motion(2.9, 0, 0).q[2], 1e-12);
}

TEST_F(LoopPlans, SayWhyAMotionCannotBeCompleted) {
  const auto plan = compile(kEverything);
  maker.samples.motion().q[2] = SliderCrank::kCrank + SliderCrank::kRod + 0.1;
  EXPECT_EQ(maker.samples.compute(*plan, 1), Outcome::kOpenLoop);
  EXPECT_NE(maker.completer.problem(plan->dynamics, plan->workspace)
                .find("closure 'pin' stays open by 0.1"),
            std::string::npos)
      << maker.completer.problem(plan->dynamics, plan->workspace);
  EXPECT_EQ(maker.counters.samples.value(), 1u);
  EXPECT_FALSE(maker.loops.take().news);
}

}  // namespace
}  // namespace virtual_work_dynamics
