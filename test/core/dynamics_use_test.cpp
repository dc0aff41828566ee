#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "pushed_mechanisms.h"
#include "result_differences.h"
#include "robot_builder.h"
#include "slider_crank.h"
#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kRounding = 1e-15;  // of lengths of a metre

std::string messageOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const MotionError& error) {
    return error.what();
  }
  return "nothing thrown";
}

void expectRefused(const Dynamics& dynamics, const Motion& motion, const Load& load,
                   Dynamics::Workspace& of_another) {
  const std::string refusal = "the workspace belongs to another Dynamics";
  Motion completed = motion;
  EXPECT_EQ(messageOf([&] { dynamics.compute(motion, of_another); }), refusal);
  EXPECT_EQ(messageOf([&] { dynamics.compute(motion, load, of_another); }), refusal);
  EXPECT_EQ(messageOf([&] { dynamics.complete(completed, of_another); }), refusal);
  EXPECT_EQ(messageOf([&] { dynamics.completeFromCloseBy(completed, of_another); }), refusal);
  EXPECT_EQ(messageOf([&] { dynamics.whyOpen(motion, of_another); }), refusal);
}

TEST(DynamicsUse, RefusesTheWorkspaceOfAnother) {
  OpenChain chain;
  const ClosedLinkage linkage;
  const Dynamics open(chain.mechanism, chain.scene), other_open(chain.mechanism, chain.scene);
  const Dynamics closed(linkage.cut.mechanism, linkage.cut.scene),
      other_closed(linkage.cut.mechanism, linkage.cut.scene);
  Dynamics::Workspace of_open = open.makeWorkspace(), of_closed = closed.makeWorkspace();
  const Motion chain_motion = chain.robot.motion(chain.mechanism);
  const Motion loop_motion = linkage.motion(0.7L);
  const Load chain_load(chain.scene), loop_load(linkage.cut.scene);
  for (Dynamics::Workspace* foreign : {&of_open, &of_closed}) {
    expectRefused(other_open, chain_motion, chain_load, *foreign);
    expectRefused(other_closed, loop_motion, loop_load, *foreign);
  }
  open.compute(chain_motion, of_open);
  closed.compute(loop_motion, of_closed);
}

TEST(DynamicsUse, RefusesMotionsAndLoadsOfAnother) {
  OpenChain chain;
  const ClosedLinkage linkage;
  const Dynamics open(chain.mechanism, chain.scene),
      closed(linkage.cut.mechanism, linkage.cut.scene);
  for (const Dynamics* dynamics : {&open, &closed}) {
    Dynamics::Workspace workspace = dynamics->makeWorkspace();
    Motion motion(dynamics->coordinates());
    const Load none;
    EXPECT_THROW(dynamics->compute(motion, none, workspace), SceneError);
    motion.qd.conservativeResize(2);
    const std::string refusal = "motion: qd has 2 entries, the mechanism has " +
                                std::to_string(dynamics->coordinates()) + " coordinates";
    EXPECT_EQ(messageOf([&] { dynamics->compute(motion, workspace); }), refusal);
    EXPECT_EQ(messageOf([&] { dynamics->complete(motion, workspace); }), refusal);
    EXPECT_EQ(messageOf([&] { dynamics->completeFromCloseBy(motion, workspace); }), refusal);
  }
}

// A workspace belongs to the plan, wherever the plan is moved.
TEST(DynamicsUse, WorkspacesFollowAPlanThatIsMoved) {
  const ClosedLinkage linkage;
  Dynamics before(linkage.cut.mechanism, linkage.cut.scene, linkage.request);
  Dynamics::Workspace workspace = before.makeWorkspace(), expected = before.makeWorkspace();
  before.compute(linkage.motion(0.7L), expected);
  const Dynamics after(std::move(before));
  Dynamics::Workspace moved(std::move(workspace));
  after.compute(linkage.motion(0.7L), moved);
  EXPECT_EQ(differences(moved.results(), expected.results()), "");
}

TEST(DynamicsUse, ThreadsWithWorkspacesOfTheirOwnGiveTheSameBits) {
  constexpr std::size_t kThreads = 4, kSamples = 200;
  const ClosedLinkage linkage;
  const Dynamics dynamics(linkage.cut.mechanism, linkage.cut.scene, linkage.request);
  const auto angleOf = [](std::size_t i) { return 0.8L + 0.03L * static_cast<long double>(i); };
  const Load load = otherLoad(linkage.cut.scene);
  const auto computeAll = [&](std::vector<Results>& results, std::vector<Motion>& motions) {
    Dynamics::Workspace workspace = dynamics.makeWorkspace();
    for (std::size_t i = 0; i < kSamples; ++i) {
      motions[i] = linkage.incomplete(angleOf(i));
      dynamics.complete(motions[i], workspace);
      if (i % 3 == 0) dynamics.compute(motions[i], load, workspace);
      if (i % 3 != 0) dynamics.compute(motions[i], workspace);
      results[i] = workspace.results();
    }
  };
  std::vector<Results> expected(kSamples);
  std::vector<Motion> expected_motions(kSamples);
  computeAll(expected, expected_motions);
  std::vector<std::vector<Results>> results(kThreads, std::vector<Results>(kSamples));
  std::vector<std::vector<Motion>> motions(kThreads, std::vector<Motion>(kSamples));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] { computeAll(results[t], motions[t]); });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < kThreads; ++t) {
    for (std::size_t i = 0; i < kSamples; ++i) {
      ASSERT_EQ(differences(results[t][i], expected[i]), "") << t << ", " << i;
      ASSERT_EQ(motions[t][i].q, expected_motions[i].q) << t << ", " << i;
      ASSERT_EQ(motions[t][i].qdd, expected_motions[i].qdd) << t << ", " << i;
    }
  }
  EXPECT_NE(differences(expected[0], expected[1]), "");
}

/// Compares computing and completing in a workspace that has seen other samples with fresh ones.
class History {
 public:
  explicit History(const Dynamics& dynamics)
      : dynamics_(dynamics), workspace_(dynamics.makeWorkspace()) {}

  void compute(const Motion& motion, const Load* load = nullptr) {
    Dynamics::Workspace fresh = dynamics_.makeWorkspace();
    for (Dynamics::Workspace* workspace : {&workspace_, &fresh}) {
      if (load) dynamics_.compute(motion, *load, *workspace);
      if (!load) dynamics_.compute(motion, *workspace);
    }
    EXPECT_EQ(differences(workspace_.results(), fresh.results()), "") << motion.q.transpose();
  }

  bool complete(Motion& motion) {
    Dynamics::Workspace fresh = dynamics_.makeWorkspace();
    Motion expected = motion;
    const bool closes = dynamics_.complete(motion, workspace_);
    EXPECT_EQ(dynamics_.complete(expected, fresh), closes);
    EXPECT_FALSE(Bits().add(motion.q) != Bits().add(expected.q)) << motion.q.transpose();
    EXPECT_FALSE(Bits().add(motion.qd) != Bits().add(expected.qd)) << motion.q.transpose();
    EXPECT_FALSE(Bits().add(motion.qdd) != Bits().add(expected.qdd)) << motion.q.transpose();
    return closes;
  }

 private:
  const Dynamics& dynamics_;
  Dynamics::Workspace workspace_;
};

TEST(DynamicsUse, WhatCameBeforeDoesNotMatter) {
  const ClosedLinkage linkage;
  const Dynamics dynamics(linkage.cut.mechanism, linkage.cut.scene, linkage.request);
  const Load load = otherLoad(linkage.cut.scene);
  History history(dynamics);
  for (long double angle = 0.8L; angle < 8; angle += 0.35L) {
    Motion motion = linkage.incomplete(angle);
    EXPECT_TRUE(history.complete(motion));
    history.compute(motion);
    history.compute(motion, &load);
    motion.qd *= -2;  // the same position
    history.compute(motion);
    history.compute(linkage.motion(2 * angle));
    EXPECT_TRUE(history.complete(motion));
    history.compute(linkage.motion(angle), &load);
  }
}

// Failures, singular positions, what is not a number, and the other of the two zeros.
TEST(DynamicsUse, WhatFailedBeforeDoesNotMatter) {
  const SliderCrank slider_crank(1.5);
  Scene scene = slider_crank.scene("joint_3");
  scene.gravity << 0, -9.81, 0;
  Request request;
  request.child_axes = request.root_axes = {"joint_1", "joint_2", "joint_3", "pin", kGround};
  request.poses = request.twists = true;
  const Dynamics dynamics(slider_crank.mechanism(), scene, request);
  History history(dynamics);
  const auto dead_centre = SliderCrank::motion(0, 1, 0);
  Motion out_of_reach = SliderCrank::motion(0.3, 1, 0);
  out_of_reach.q[2] = SliderCrank::kCrank + SliderCrank::kRod + 0.1;
  Motion nothing = dead_centre;
  nothing.q[1] = std::numeric_limits<double>::quiet_NaN();
  Motion negative = dead_centre;
  negative.q[0] = negative.q[1] = -0.0;
  Motion positive = dead_centre;
  positive.q[0] = positive.q[1] = 0.0;
  for (const double angle : {0.5, -1.0, 2.0}) {
    const Motion regular = SliderCrank::motion(angle, 1, 2);
    for (const Motion& before : {dead_centre, out_of_reach, nothing, negative, positive}) {
      Motion motion = before;
      EXPECT_FALSE(history.complete(motion));
      history.compute(regular);
      motion = regular;
      motion.q[0] += 1e-3;
      EXPECT_TRUE(history.complete(motion));
      history.compute(motion);
      history.compute(before);
      history.compute(motion);
      motion = before;
      EXPECT_FALSE(history.complete(motion));
      history.compute(before);
    }
  }
  for (const Motion& one : {negative, positive}) {
    for (const Motion& other : {positive, negative}) {
      history.compute(one);
      history.compute(other);
    }
  }
}

TEST(DynamicsUse, SaysWhyLoopsAreOpen) {
  const SliderCrank slider_crank;
  const Mechanism mechanism = slider_crank.mechanism();
  const Dynamics dynamics(mechanism, slider_crank.scene("joint_3"));
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  const double reach = SliderCrank::kCrank + SliderCrank::kRod;
  Motion motion = SliderCrank::motion(0.1, 0, 0);
  motion.q[2] = reach + 0.25;
  ASSERT_FALSE(dynamics.complete(motion, workspace));
  const std::string why = dynamics.whyOpen(motion, workspace);
  dynamics.compute(motion, workspace);
  const double open = workspace.results().loops.residuals[0].position;
  EXPECT_EQ(why, "the loops cannot be closed: closure 'pin' stays open by " + numberText(open) +
                     " m or rad");
  EXPECT_GE(open, 0.25 - kRounding);
  EXPECT_LE(open, 0.251);  // Newton's method ends near the best position
  motion = SliderCrank::motion(0, 0, 0);
  ASSERT_FALSE(dynamics.complete(motion, workspace));
  EXPECT_EQ(dynamics.whyOpen(motion, workspace),
            "the position is singular: the closures do not determine how the other joints move; "
            "give the motion of all joints");
}

// The message names the one of two closures that is open furthest.
TEST(DynamicsUse, NamesTheClosureThatStaysOpenFurthest) {
  RobotBuilder builder(1);
  const Matrix3l R = Matrix3l::Identity();
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), R, Vector3l::Zero());
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), R, Vector3l::Zero());
  const Mechanism mechanism = builder.build();
  Scene scene;
  scene.actuated.emplace();
  for (const char* link : {"link_1", "link_2"}) {
    Closure rod;
    rod.name = std::string("rod_of_") + link;
    rod.type = ClosureType::kDistance;
    rod.parent = {"link_0", {2, 0, 0}, {0, 0, 0}};
    rod.child.link = link;
    scene.closures.push_back(rod);
  }
  const Dynamics dynamics(mechanism, scene);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(2);
  for (const bool first : {true, false}) {
    motion.q << (first ? 0.5 : 0.125), (first ? 0.125 : 0.5);
    EXPECT_EQ(dynamics.whyOpen(motion, workspace),
              std::string("the loops cannot be closed: closure 'rod_of_link_") +
                  (first ? "1" : "2") + "' stays open by 0.5 m or rad");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
