#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "allocation_guard.h"
#include "ros/active_plan.h"
#include "ros/certificate_record.h"
#include "ros/closure_frames.h"
#include "ros/counters.h"
#include "ros/loop_samples.h"
#include "ros/sample_computation.h"
#include "slider_crank.h"
#include "virtual_work_dynamics/error.h"

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
        reactions(requestedReactions(mechanism, scene)),
        loops(mechanism, scene, reactions, kLimits),
        samples(3, false, counters, certificates, &loops) {}

  static Scene gravityOn(Scene scene) {
    scene.gravity << 0, -9.81, 0;
    return scene;
  }

  std::unique_ptr<ActivePlan> compile(const Audience& audience) const {
    return std::make_unique<ActivePlan>(mechanism, scene, requestFor(audience, reactions, true),
                                        audience, "left/", PlanChecks());
  }

  /// Of joint states that give all joints.
  Outcome compute(ActivePlan& plan, const Motion& motion) {
    const std::vector<int> all{0, 1, 2};
    loops.completer.saw(all.data(), 3);
    samples.motion() = motion;
    return samples.compute(plan, 1);
  }

  SliderCrank slider_crank{0.5};
  Mechanism mechanism;
  Scene scene;
  Names reactions;
  Counters counters;
  CertificateRecord certificates;
  LoopSamples loops;
  SampleComputation samples;
};

Audience everything() {
  Audience audience;
  audience.effort = audience.reactions = true;
  audience.wrenches = {1, 3};
  return audience;
}

TEST_F(LoopPlans, LeaveOutWhatHasNoValueAndTakeItInAgain) {
  const auto plan = compile(everything());
  const OutputMessages& messages = plan->messages;
  const Names joints{"joint_1", "joint_2", "joint_3"};
  for (const double angle : {0.7, 0.0, 0.8, 0.0, 0.9}) {
    ASSERT_EQ(compute(*plan, SliderCrank::motion(angle, 0, 0)), Outcome::kDone);
    const bool singular = angle == 0;
    EXPECT_EQ(plan->loops->singular(), singular);
    const sensor_msgs::JointState& effort = messages.effort();
    EXPECT_EQ(effort.name, singular ? Names(joints.begin(), joints.begin() + 2) : joints);
    for (const auto* values : {&effort.position, &effort.velocity, &effort.effort}) {
      EXPECT_EQ(values->size(), effort.name.size());
    }
    EXPECT_EQ(effort.position[0], angle);
    EXPECT_EQ(effort.effort[0], 0);
    const sensor_msgs::MultiDOFJointState& wrenches = messages.reactions();
    EXPECT_EQ(wrenches.joint_names, singular ? Names() : reactions);
    EXPECT_EQ(wrenches.wrench.size(), wrenches.joint_names.size());
    EXPECT_EQ(wrenches.transforms.size(), wrenches.joint_names.size());
    EXPECT_EQ(wrenches.twist.size(), wrenches.joint_names.size());
    EXPECT_EQ(messages.wrenchExists(0), !singular);
    EXPECT_EQ(messages.wrenchExists(1), !singular);
  }
  EXPECT_EQ(messages.wrenches()[0].header.frame_id, "left/link_2");
  EXPECT_EQ(messages.wrenches()[1].header.frame_id, "left/pin");
  const LoopRecord::Report report = loops.record.take();
  EXPECT_TRUE(report.news);
  EXPECT_EQ(report.singular, 2u);
  EXPECT_EQ(report.violations, 0u);
  EXPECT_EQ(report.efforts, std::vector<std::size_t>{2});
  EXPECT_EQ(report.reactions, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_TRUE(loops.record.take().efforts.empty());
  EXPECT_FALSE(loops.record.take().news);
}

// Out of plane nothing is determined anywhere: no reason to leave anything out.
TEST_F(LoopPlans, PublishWhatRedundantConstraintsLeaveOpen) {
  const auto plan = compile(everything());
  ASSERT_EQ(compute(*plan, SliderCrank::motion(0.7, 0, 0)), Outcome::kDone);
  EXPECT_FALSE(plan->loops->results().rootAxesDetermined()[0][2]);
  EXPECT_EQ(plan->messages.reactions().joint_names, reactions);
}

TEST_F(LoopPlans, WrenchesAreThoseOfTheirJointsWithDeterminacyToo) {
  Audience audience = everything();
  const auto some = compile(audience);
  audience.determinacy = true;
  const auto all = compile(audience);
  EXPECT_EQ(all->request().child_axes, reactions);
  EXPECT_EQ(some->request().child_axes.size(), 2u);
  const Motion motion = SliderCrank::motion(0.7, 1, 2);
  ASSERT_EQ(compute(*some, motion), Outcome::kDone);
  ASSERT_EQ(compute(*all, motion), Outcome::kDone);
  ASSERT_EQ(all->messages.wrenches().size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const geometry_msgs::Wrench& one = some->messages.wrenches()[i].wrench;
    const geometry_msgs::Wrench& other = all->messages.wrenches()[i].wrench;
    EXPECT_NE(one.force.x, 0);
    EXPECT_EQ(one.force.x, other.force.x);
    EXPECT_EQ(one.force.y, other.force.y);
    EXPECT_EQ(one.torque.z, other.torque.z);
  }
  // Reactions that only flags are computed for have no place in any message.
  Audience only_flags;
  only_flags.determinacy = true;
  const auto flags = compile(only_flags);
  ASSERT_EQ(compute(*flags, motion), Outcome::kDone);
  EXPECT_TRUE(flags->messages.reactions().joint_names.empty());
  EXPECT_TRUE(flags->messages.reactions().wrench.empty());
  EXPECT_TRUE(flags->messages.effort().name.empty());
}

TEST_F(LoopPlans, DeterminacyChangesWithThePosition) {
  Audience audience;
  audience.determinacy = true;
  const auto plan = compile(audience);
  const auto changed = [&](double angle) {
    EXPECT_EQ(compute(*plan, SliderCrank::motion(angle, 0, 0)), Outcome::kDone);
    return loops.determinacy.update(1, plan->loops->results());
  };
  EXPECT_FALSE(changed(0.7));  // as assembled
  EXPECT_TRUE(changed(0));
  EXPECT_FALSE(changed(0));
  EXPECT_TRUE(changed(0.4));
}

// The slider holds the crank by a lever that is as long as the angle from the dead centre.
TEST_F(LoopPlans, ConditionGrowsTowardsDeadCentre) {
  Audience audience;
  audience.effort = audience.determinacy = true;
  const auto plan = compile(audience);
  const auto computed = [&](double angle) {
    EXPECT_EQ(compute(*plan, SliderCrank::motion(angle, 0, 0)), Outcome::kDone);
    return loops.record.take();
  };
  const auto changed = [&] { return loops.determinacy.update(1, plan->loops->results()); };
  const auto level = [&] { return loops.determinacy.message().status[0].level; };
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
    EXPECT_EQ(changed(), angle > 0);  // no news afterwards
    EXPECT_EQ(level(), diagnostic_msgs::DiagnosticStatus::WARN);
  }
  EXPECT_EQ(report.close_to_singular, 2u);
  EXPECT_NE(loops.determinacy.message().status[0].message.find("close to a singular position"),
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
  const auto plan = compile(everything());
  Motion motion = SliderCrank::motion(0.7, 0, 0);
  motion.q[2] += 0.01;
  ASSERT_EQ(compute(*plan, motion), Outcome::kDone);
  EXPECT_EQ(plan->messages.effort().position[2], motion.q[2]);
  const LoopRecord::Report report = loops.record.take();
  EXPECT_EQ(report.violations, 1u);
  EXPECT_NEAR(report.residuals[0][0], 0.01, 1e-15);
  EXPECT_GT(report.relative[0][0], kLimits.tolerance);
}

TEST_F(LoopPlans, AreCertifiedOutOfSingularPositions) {
  Audience only_wrenches, only_determinacy;
  only_wrenches.wrenches = {1, 3};
  only_determinacy.determinacy = true;
  for (const Audience& audience : {everything(), only_wrenches, only_determinacy}) {
    const ActivePlan plain(mechanism, scene, requestFor(audience, reactions, true), audience, "",
                           PlanChecks());
    ActivePlan plan(mechanism, scene, requestFor(audience, reactions, true), audience, "",
                    PlanChecks{false, true});
    ASSERT_TRUE(plan.certifier);
    EXPECT_EQ(plan.request().child_axes.size(), plain.request().child_axes.size() + 1);
    ASSERT_EQ(compute(plan, SliderCrank::motion(0.7, 1.5, -2)), Outcome::kDone);
    auto found = certificates.take();
    ASSERT_TRUE(found);
    EXPECT_LE(found->largest(), kSound);
    EXPECT_GT(found->power + found->ground_force + found->ground_moment, 0);
    ASSERT_EQ(compute(plan, SliderCrank::motion(0, 1.5, 0)), Outcome::kDone);
    EXPECT_FALSE(certificates.take());
    if (audience.determinacy) loops.determinacy.update(1, plan.loops->results());
    // What violates a loop is certified as it is.
    Motion violating = SliderCrank::motion(0.7, 1.5, -2);
    violating.q[2] += 0.01;
    violating.qd[1] += 0.1;
    const AllocationGuard guard;
    const Outcome outcome = compute(plan, violating);
    const std::size_t allocations = guard.allocations();
    ASSERT_EQ(outcome, Outcome::kDone);
    EXPECT_LE(allocations, 1u) << "of the test's own";
    found = certificates.take();
    ASSERT_TRUE(found);
    EXPECT_LE(found->largest(), kSound);
    EXPECT_TRUE(loops.record.take().news);
    if (!audience.determinacy) continue;
    EXPECT_TRUE(loops.determinacy.update(1, plan.loops->results()));
    EXPECT_EQ(loops.determinacy.message().status[2].values.size(), 6 * reactions.size());
  }
}

TEST_F(LoopPlans, AreCrossCheckedOutOfSingularPositions) {
  Audience only_effort, only_wrenches, only_determinacy;
  only_effort.effort = true;
  only_wrenches.wrenches = {3};
  only_determinacy.determinacy = true;
  const auto compileChecked = [&](const Audience& audience) {
    return std::make_unique<ActivePlan>(mechanism, scene, requestFor(audience, reactions, true),
                                        audience, "", PlanChecks{true, false});
  };
  EXPECT_FALSE(compileChecked(Audience())->cross_check);
  for (const Audience& audience : {everything(), only_effort, only_wrenches, only_determinacy}) {
    const auto plan = compileChecked(audience);
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
    samples.motion() = violating;
    const AllocationGuard guard;
    const Outcome outcome = samples.compute(*plan, 1);
    const std::size_t allocations = guard.allocations();
    EXPECT_EQ(outcome, Outcome::kDone);
    EXPECT_EQ(allocations, 0u);
    EXPECT_TRUE(plan->cross_check->full());
  }
}

class LoopPlansOfTheCrank : public LoopPlans {
 protected:
  LoopPlansOfTheCrank() : LoopPlans("joint_1") {}
};

TEST_F(LoopPlansOfTheCrank, CompleteAndComputeWithoutAllocation) {
  const auto plan = compile(everything());
  samples.motion().q[0] = 0.7;
  samples.motion().qd[0] = 0.3;
  ASSERT_EQ(samples.compute(*plan, 1), Outcome::kDone);
  samples.motion().q[0] = 2.9;  // far enough to be halved
  const AllocationGuard guard;
  const Outcome outcome = samples.compute(*plan, 2);
  const std::size_t allocations = guard.allocations();
  EXPECT_EQ(outcome, Outcome::kDone);
  EXPECT_EQ(allocations, 0u);
  EXPECT_NEAR(plan->messages.effort().position[2], SliderCrank::motion(2.9, 0, 0).q[2], 1e-12);
}

TEST_F(LoopPlans, SayWhyAMotionCannotBeCompleted) {
  const auto plan = compile(everything());
  samples.motion().q[2] = SliderCrank::kCrank + SliderCrank::kRod + 0.1;
  EXPECT_EQ(samples.compute(*plan, 1), Outcome::kOpenLoop);
  EXPECT_NE(loops.completer.problem().find("closure 'pin' stays open by 0.1"), std::string::npos)
      << loops.completer.problem();
  EXPECT_EQ(counters.samples.value(), 1u);
  EXPECT_FALSE(loops.record.take().news);
}

TEST(ClosureFrames, AreThoseOfTheChildren) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  Scene scene = slider_crank.scene("joint_1");
  scene.closures[0].child.xyz << 1, 2, 3;
  scene.closures[0].child.rpy << 0.3, -0.5, 1.1;
  const auto message = closureFrames(mechanism, scene, {"joint_1", "pin"}, "left/");
  ASSERT_EQ(message.transforms.size(), 1u);
  EXPECT_EQ(message.transforms[0].header.frame_id, "left/link_3");
  EXPECT_EQ(message.transforms[0].child_frame_id, "left/pin");
  EXPECT_EQ(message.transforms[0].transform.translation.z, 3);
  const auto& turn = message.transforms[0].transform.rotation;
  const Eigen::Matrix3d R = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).matrix();
  // Of fixed axes: x stays in the plane that roll leaves alone, its height is that of the pitch.
  EXPECT_NEAR(R(2, 0), -std::sin(-0.5), 1e-15);
  EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), 1.1, 1e-15);
  EXPECT_NEAR(std::atan2(R(2, 1), R(2, 2)), 0.3, 1e-15);
  EXPECT_TRUE(closureFrames(mechanism, scene, {"joint_1"}, "").transforms.empty());
  scene.closures[0].name = "link_2";
  EXPECT_THROW(closureFrames(mechanism, scene, {"link_2"}, ""), SceneError);
}

}  // namespace
}  // namespace virtual_work_dynamics
