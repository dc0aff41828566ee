#include "ros/cross_check.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "allocation_guard.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/urdf_reader.h"
#include "wait_until.h"

namespace virtual_work_dynamics {
namespace {

// Both routes round: a few eps for each of the 12 links that a wrench has gone through.
constexpr double kSound = 1e-13;
// The planted error as a share of the sum of magnitudes, far above rounding errors.
constexpr double kTampered = 1e-6;
// Relative accuracy to which a planted share is found again despite rounding errors.
constexpr double kShare = 1e-5;

/// A sample of a random tree, right until something is changed.
struct Sample {
  explicit Sample(const Scene& wanted = Scene(), double scale = 1)
      : scene(wanted),
        robot(7, 12),
        mechanism(readUrdf(robot.urdf())),
        bound(mechanism, scene),
        motion(robot.motion(mechanism, scale)) {
    request.child_axes = requestedReactions(mechanism, scene);
    request.child_axes.push_back(kGround);
    request.root_axes = requestedReactions(mechanism, scene);
    recompute();
    slot = std::make_shared<CrossCheckSlot>(mechanism, Dynamics(mechanism, scene, request));
  }

  void recompute() {
    const InverseDynamics dynamics(mechanism, scene, request);
    Workspace workspace = dynamics.makeWorkspace();
    dynamics.compute(motion, workspace);
    results = workspace.results();
    bound.compute(motion);
  }

  bool offer() { return slot->offer(motion, Load(scene), results); }

  CrossCheckSlot::Finding check() {
    EXPECT_TRUE(offer());
    return slot->check().value_or(CrossCheckSlot::Finding());
  }

  const WrenchMagnitude& sumAt(const std::string& joint) const {
    const int index = joint == kGround ? -1 : mechanism.jointIndex(joint);
    return bound.wrenches()[static_cast<std::size_t>(index + 1)];
  }

  Scene scene;
  RandomRobot robot;
  Mechanism mechanism;
  ErrorBound bound;
  Motion motion;
  Request request;
  Results results;
  std::shared_ptr<CrossCheckSlot> slot;
};

// Adds the share of a sum to a value, checks that it is found, and removes it. Returns false when
// the sum is zero.
bool expectFound(Sample& sample, double& value, double sum, const std::string& where) {
  if (sum == 0) return false;
  const double before = value;
  value += kTampered * sum;
  const CrossCheckSlot::Finding finding = sample.check();
  EXPECT_EQ(finding.where, where);
  EXPECT_NEAR(finding.largest, kTampered, kShare * kTampered);
  value = before;
  return true;
}

TEST(CrossCheckSlot, SoundResultsDifferByRoundingErrors) {
  Sample sample;
  const CrossCheckSlot::Finding finding = sample.check();
  EXPECT_LE(finding.largest, kSound);
  EXPECT_GT(finding.largest, 0);
  EXPECT_FALSE(finding.where.empty());
}

TEST(CrossCheckSlot, NamesTheResultThatWasTamperedWith) {
  Sample sample;
  int found = 0;
  for (Eigen::Index i = 0; i < sample.results.effort.size(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    found += expectFound(sample, sample.results.effort[i], sample.bound.efforts()[place],
                         "effort of " + sample.mechanism.coordinateNames()[place]);
  }
  const auto tamper = [&](std::vector<Wrench>& wrenches, const std::vector<std::string>& joints) {
    for (std::size_t i = 0; i < wrenches.size(); ++i) {
      const WrenchMagnitude& sum = sample.sumAt(joints[i]);
      found += expectFound(sample, wrenches[i].force[0], sum.force, "force at " + joints[i]);
      found += expectFound(sample, wrenches[i].torque[2], sum.moment, "moment at " + joints[i]);
    }
  };
  tamper(sample.results.child_axes, sample.request.child_axes);
  tamper(sample.results.root_axes, sample.request.root_axes);
  // All are found except those of massless ends.
  EXPECT_GE(found, 40);
}

TEST(CrossCheckSlot, WhatIsNotFiniteDiffersInfinitely) {
  Sample sample;
  sample.results.child_axes[1].torque[1] = std::numeric_limits<double>::quiet_NaN();
  const CrossCheckSlot::Finding finding = sample.check();
  EXPECT_EQ(finding.largest, std::numeric_limits<double>::infinity());
  EXPECT_EQ(finding.where, "moment at " + sample.request.child_axes[1]);
}

TEST(CrossCheckSlot, NothingAgainstNothingIsNoDifference) {
  Scene scene;
  scene.gravity.setZero();
  Sample sample(scene, 0);
  EXPECT_EQ(sample.check().largest, 0);
}

TEST(CrossCheckSlot, IsEmptyUntilOfferedAndOnceChecked) {
  Sample sample;
  EXPECT_FALSE(sample.slot->full());
  EXPECT_FALSE(sample.slot->check());
  EXPECT_TRUE(sample.offer());
  EXPECT_TRUE(sample.slot->full());
  EXPECT_TRUE(sample.slot->check());
  EXPECT_FALSE(sample.slot->full());
  EXPECT_FALSE(sample.slot->check());
}

TEST(CrossCheckSlot, ChecksEachOfTheSamplesOfferedAsOften) {
  constexpr int kSamples = 5, kRounds = 1000;
  // Six standard deviations of a binomial distribution.
  const double kSpread = 6 * std::sqrt(kRounds * 0.2 * 0.8);
  Sample sample;
  const double sound = sample.results.effort[0];
  std::array<int, kSamples> checked{};
  for (int round = 0; round < kRounds; ++round) {
    // How much is wrong identifies the sample.
    for (int i = 0; i < kSamples; ++i) {
      sample.results.effort[0] = sound + (i + 1) * kTampered * sample.bound.efforts()[0];
      sample.offer();
    }
    const auto finding = sample.slot->check();
    ASSERT_TRUE(finding);
    const long which = std::lround(finding->largest / kTampered) - 1;
    ASSERT_GE(which, 0);
    ASSERT_LT(which, kSamples);
    ++checked[static_cast<std::size_t>(which)];
  }
  for (const int count : checked) EXPECT_NEAR(count, kRounds / kSamples, kSpread);
}

TEST(CrossCheckSlot, KeepsSamplesOfTwoThreadsWhole) {
  constexpr int kChecks = 300;
  Sample one, other;
  other.motion = one.robot.motion(one.mechanism);
  other.recompute();
  std::atomic<bool> done{false};
  // Each sample by itself is sound; a mixture of both is not.
  std::thread computing([&] {
    while (!done) {
      one.offer();
      one.slot->offer(other.motion, Load(one.scene), other.results);
    }
  });
  for (int i = 0; i < kChecks;) {
    const auto finding = one.slot->check();
    if (!finding) continue;
    ++i;
    EXPECT_LE(finding->largest, kSound);
  }
  done = true;
  computing.join();
}

TEST(CrossCheckSlot, OfferDoesNotAllocate) {
  Sample sample;
  const AllocationGuard guard;
  const bool first = sample.offer();
  int others = 0;
  for (int i = 0; i < 100; ++i) others += sample.offer();
  const std::size_t allocations = guard.allocations();
  EXPECT_TRUE(first);
  EXPECT_GE(others, 1);
  EXPECT_EQ(allocations, 0u);
}

TEST(CrossCheck, ReportsOnceWhatItFinds) {
  Sample sample;
  CrossCheck cross_check(1000);
  EXPECT_FALSE(cross_check.takeReport().news);
  cross_check.watch(sample.slot);
  sample.results.effort[1] += kTampered * sample.bound.efforts()[1];
  ASSERT_TRUE(sample.offer());
  CrossCheck::Report report;
  waitUntil([&] { return (report = cross_check.takeReport()).news; });
  EXPECT_EQ(report.done, 1u);
  EXPECT_EQ(report.finding.where, "effort of " + sample.mechanism.coordinateNames()[1]);
  EXPECT_NEAR(report.finding.largest, kTampered, kShare * kTampered);
  report = cross_check.takeReport();
  EXPECT_FALSE(report.news);
  EXPECT_EQ(report.done, 1u);
}

TEST(CrossCheck, KeepsTheLargestUntilAsked) {
  Sample sample;
  CrossCheck cross_check(1000);
  cross_check.watch(sample.slot);
  const double sound = sample.results.effort[0];
  // The third check begins after the findings of the second one have been kept.
  for (int i = 0; i < 4; ++i) {
    sample.results.effort[0] = sound + (i == 1 ? kTampered * sample.bound.efforts()[0] : 0);
    waitUntil([&] { return sample.offer(); });
    waitUntil([&] { return !sample.slot->full(); });
  }
  const CrossCheck::Report report = cross_check.takeReport();
  EXPECT_GE(report.done, 3u);
  EXPECT_NEAR(report.finding.largest, kTampered, kShare * kTampered);
}

TEST(CrossCheck, ChecksTheSlotItWasToldLast) {
  Sample replaced, current;
  CrossCheck cross_check(1000);
  cross_check.watch(replaced.slot);
  cross_check.watch(current.slot);
  replaced.results.effort[0] += kTampered * replaced.bound.efforts()[0];
  ASSERT_TRUE(replaced.offer());
  ASSERT_TRUE(current.offer());
  CrossCheck::Report report;
  waitUntil([&] { return (report = cross_check.takeReport()).news; });
  EXPECT_LE(report.finding.largest, kSound);
  EXPECT_TRUE(replaced.slot->full());
  cross_check.watch(nullptr);
  cross_check.watch(replaced.slot);
  waitUntil([&] { return (report = cross_check.takeReport()).news; });
  EXPECT_NEAR(report.finding.largest, kTampered, kShare * kTampered);
}

}  // namespace
}  // namespace virtual_work_dynamics
