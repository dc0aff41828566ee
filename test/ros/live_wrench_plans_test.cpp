#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "allocation_guard.h"
#include "plan_maker.h"
#include "ros/message_copies.h"
#include "ros/topic_names.h"
#include "ros/wrench_conversion.h"
#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

using Outcome = SampleComputation::Outcome;

// Both routes round: a few eps for each of the 9 links that a wrench may have gone through.
constexpr double kSound = 1e-13;
constexpr std::int64_t kStamp = 1600000000123456789;

Scene sceneOf(bool live) {
  Scene scene;
  scene.applied_wrenches.resize(1);
  AppliedWrench& push = scene.applied_wrenches[0];
  push.name = "push";
  push.link = "link_5";
  push.live = live;
  if (live) return scene;
  push.force << 10, 20, -30;
  push.torque << 1, -2, 3;
  return scene;
}

geometry_msgs::WrenchStamped pushMessage(std::int64_t stamp_ns) {
  geometry_msgs::WrenchStamped message;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  message.header.frame_id = "link_5";
  const Wrench push{{10, 20, -30}, {1, -2, 3}};
  copyWrench(push, message.wrench);
  return message;
}

/// A plan with a live wrench, and one in which the scene applies it.
class LiveWrenchPlans : public testing::Test {
 protected:
  LiveWrenchPlans()
      : robot(3, 9),
        mechanism(readUrdf(robot.urdf())),
        fixed_scene(sceneOf(false)),
        live_scene(sceneOf(true)),
        fixed(mechanism, fixed_scene),
        live(mechanism, live_scene),
        conversion(mechanism, "", live.wrenches),
        motion(robot.motion(mechanism)) {}

  const Eigen::VectorXd& effortOf(const ActivePlan& plan) {
    return plan.workspace.results().effort;
  }

  RandomRobot robot;
  Mechanism mechanism;
  Scene fixed_scene, live_scene;
  PlanMaker fixed, live;
  WrenchConversion conversion;
  Motion motion;
};

TEST_F(LiveWrenchPlans, ComputeAndCheckAsWithTheScenes) {
  const auto expected = fixed.compile({"effort"});
  const auto plan = live.compile({"effort"}, {true, true});
  fixed.samples.motion() = live.samples.motion() = motion;
  ASSERT_EQ(fixed.samples.compute(*expected, kStamp), Outcome::kDone);
  EXPECT_EQ(live.samples.compute(*plan, kStamp), Outcome::kNoWrench);
  EXPECT_EQ(live.samples.unknownWrench(), 0u);
  ASSERT_FALSE(conversion.take(0, pushMessage(kStamp - 1000000)));
  ASSERT_FALSE(conversion.take(0, pushMessage(kStamp + 1000000)));
  ASSERT_EQ(live.samples.compute(*plan, kStamp), Outcome::kDone);
  EXPECT_EQ(effortOf(*plan), effortOf(*expected));
  EXPECT_EQ(live.counters.wrench_held.value(), 0u);
  const auto finding = plan->cross_check->check();
  ASSERT_TRUE(finding);
  EXPECT_LE(finding->largest, kSound);
  const auto certified = live.certificates.take();
  ASSERT_TRUE(certified);
  EXPECT_LE(certified->largest(), kSound);
}

TEST_F(LiveWrenchPlans, TakeMessagesAndComputeWithoutAllocation) {
  const auto plan = live.compile({"effort"}, {true, true});
  geometry_msgs::WrenchStamped message = pushMessage(kStamp);
  ASSERT_FALSE(conversion.take(0, message));
  live.samples.motion() = motion;
  message.header.stamp.nsec += 1000000;
  const AllocationGuard guard;
  const bool rejected = conversion.take(0, message).has_value();
  const Outcome outcome = live.samples.compute(*plan, kStamp + 500000);
  const std::size_t allocations = guard.allocations();
  EXPECT_FALSE(rejected);
  EXPECT_EQ(outcome, Outcome::kDone);
  EXPECT_EQ(allocations, 0u);
}

// Points of a trajectory that are computed at once have the wrench of their instants.
TEST_F(LiveWrenchPlans, PointsOfTrajectoriesHaveTheirOwn) {
  const auto plan = live.compile({"effort"});
  const auto expected = fixed.compile({"effort"});
  geometry_msgs::WrenchStamped later = pushMessage(kStamp + 50000000);
  later.wrench.force.x = 60;
  ASSERT_FALSE(conversion.take(0, pushMessage(kStamp)));
  ASSERT_FALSE(conversion.take(0, later));
  TrajectoryMotion trajectory;
  const std::int64_t offsets[] = {0, 10000000, 40000000, 300000000};
  for (Eigen::MatrixXd* columns : {&trajectory.table.positions, &trajectory.table.velocities,
                                   &trajectory.table.accelerations}) {
    columns->resize(4, motion.q.size());
  }
  for (int i = 0; i < 4; ++i) {
    trajectory.table.times.push_back(static_cast<double>(offsets[i]) * 1e-9);
    trajectory.stamps_ns.push_back(kStamp + offsets[i]);
    trajectory.table.positions.row(i) = motion.q;
    trajectory.table.velocities.row(i) = motion.qd;
    trajectory.table.accelerations.row(i) = motion.qdd;
  }
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(live.samples.computeNext(*plan, trajectory, static_cast<std::size_t>(i), true),
              Outcome::kDone);
    const auto& message = live.message<sensor_msgs::JointState>(*plan, "effort").message();
    Scene scene = fixed_scene;
    scene.applied_wrenches[0].force.x() = 10 + 50 * static_cast<double>(offsets[i]) / 5e7;
    PlanMaker maker(mechanism, scene);
    const auto constant = maker.compile({"effort"});
    maker.samples.motion() = motion;
    ASSERT_EQ(maker.samples.compute(*constant, kStamp), Outcome::kDone);
    for (std::size_t j = 0; j < message.effort.size(); ++j) {
      EXPECT_NEAR(message.effort[j], effortOf(*constant)[static_cast<Eigen::Index>(j)],
                  kSound * 100);
    }
  }
  EXPECT_EQ(live.samples.computeNext(*plan, trajectory, 3, true), Outcome::kNoWrench);
}

TEST_F(LiveWrenchPlans, RefuseMessagesByName) {
  const auto refusal = [&](const geometry_msgs::WrenchStamped& message) {
    const auto rejection = conversion.take(0, message);
    return rejection ? kDropReasonNames[index(rejection->reason)] + (": " + rejection->text)
                     : std::string("taken");
  };
  auto message = pushMessage(kStamp);
  message.wrench.torque.y = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(message), "not finite: its torque.y is inf");
  message = pushMessage(kStamp);
  message.header.frame_id = "link_55";
  EXPECT_EQ(refusal(message).find("unknown frame: its frame 'link_55' is not a link of robot "
                                  "'random_3'"),
            0u);
  message.header.frame_id = "link_0";
  EXPECT_EQ(refusal(message), "taken");
  message.header.stamp = ros::Time();
  EXPECT_EQ(refusal(message), "zero stamp: its stamp is zero");
}

TEST(WrenchTopics, ThatCollideAreRefused) {
  EXPECT_EQ(wrenchTopics({"left foot", "right"}), (std::vector<std::string>{"left_foot", "right"}));
  try {
    wrenchTopics({"foot.1", "foot-1"});
    ADD_FAILURE() << "accepted";
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()),
              "applied_wrenches: 'foot.1' and 'foot-1' would share the topic ~wrench/foot_1");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
