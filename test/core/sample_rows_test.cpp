#include "dynamics/sample_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "four_bar.h"
#include "loop_examples.h"
#include "motion/table_row.h"
#include "motion_tables.h"
#include "plain_results.h"
#include "result_differences.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr std::size_t kRows = 47, kCapacity = 10;

std::string messageOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const MotionError& error) {
    return error.what();
  }
  return "nothing thrown";
}

/// A mechanism and rows of its motion.
struct Recorded {
  Mechanism mechanism;
  Scene scene;
  std::vector<Motion> motions;
};

Recorded openChain() {
  RobotBuilder builder = chainOf(4);
  std::vector<Motion> motions = builder.motions(kRows);
  return {builder.build(), Scene(), std::move(motions)};
}

// Through its change point, in the middle of a block.
Recorded closedLinkage() {
  FourBar four_bar;
  four_bar.lengths = {0.3L, 0.8L, 0.3L, 0.8L};
  const FourBar::Cut cut = four_bar.cut('D');
  Recorded recorded{cut.mechanism, cut.scene, {}};
  recorded.scene.assembly = {{"A", 1.0}, {"B", -1.0}, {"C", 1.0}};
  for (std::size_t n = 0; n < kRows; ++n) {
    const long double angle = 0.04L * (static_cast<long double>(n) - 16);
    recorded.motions.push_back(cut.motion({{{angle, 2, 1}, {0, 0, 0}, {angle, 2, 1}}}));
  }
  return recorded;
}

Request wrenchesOf(const Recorded& recorded) {
  Request request;
  request.child_axes = request.root_axes = requestedReactions(recorded.mechanism, recorded.scene);
  request.determinacy = false;
  return request;
}

Request everythingOf(const Recorded& recorded) {
  Request request = wrenchesOf(recorded);
  request.poses = request.twists = request.determinacy = true;
  return request;
}

// What is found beside wrenches of loops decides how rows are computed.
std::vector<Request> requestsOf(const Recorded& recorded) {
  std::vector<Request> requests = {everythingOf(recorded), wrenchesOf(recorded)};
  for (std::size_t i = 0; i < 2; ++i) {
    requests.push_back(requests[i]);
    requests.back().residuals = false;
  }
  return requests;
}

TEST(SampleRows, AreComputedLikeSingleSamples) {
  for (const Recorded& recorded : {openChain(), closedLinkage()}) {
    const MotionTable table = tableOfMotions(recorded.motions);
    for (const Request& request : requestsOf(recorded)) {
      const Dynamics dynamics(recorded.mechanism, recorded.scene, request);
      for (const int threads : {1, 3}) {
        SampleRows rows(dynamics, kCapacity, threads);
        EXPECT_EQ(rows.capacity(), kCapacity);
        Dynamics::Workspace expected = dynamics.makeWorkspace();
        for (std::size_t first = 0; first < kRows; first += kCapacity) {
          const std::size_t count = std::min(kCapacity, kRows - first);
          rows.compute(table, first, count);
          for (std::size_t i = 0; i < count; ++i) {
            Motion motion(dynamics.coordinates());
            takeRow(table, first + i, motion);
            EXPECT_EQ(motion.q, recorded.motions[first + i].q);
            EXPECT_EQ(motion.qd, recorded.motions[first + i].qd);
            EXPECT_EQ(motion.qdd, recorded.motions[first + i].qdd);
            dynamics.compute(motion, expected);
            EXPECT_EQ(differences(rows.read(i), expected.results()), "") << first + i;
          }
        }
      }
    }
  }
}

// Loops of every kind of group, without a position in doubt, on a motion that the tables of rows
// jump about in.
TEST(SampleRows, LoopsSideBySideAreThoseOfSingleSamples) {
  for (const char* name :
       {"four_bar", "slider_crank", "planar_3rrr", "stewart_gough", "spatial_parallelogram"}) {
    const LoopExample example(name);
    for (const Request& request : requestsOf({example.mechanism, example.scene, {}})) {
      const Dynamics dynamics(example.mechanism, example.scene, request);
      Dynamics::Workspace workspace = dynamics.makeWorkspace();
      std::vector<Motion> motions;
      for (int n = 0; n < 16; ++n) {
        Motion motion(dynamics.coordinates());
        motion.q = dynamics.assembly();
        for (Eigen::Index i = 0; i < motion.q.size(); ++i) {
          if (!dynamics.actuated()[static_cast<std::size_t>(i)]) continue;
          motion.q[i] += 0.01 * std::sin(n + static_cast<double>(i));
          motion.qd[i] = std::cos(2 * n + static_cast<double>(i));
          motion.qdd[i] = std::sin(3 * n - static_cast<double>(i));
        }
        ASSERT_TRUE(dynamics.complete(motion, workspace)) << name;
        motions.push_back(motion);
      }
      SampleRows rows(dynamics, motions.size());
      for (int round = 0; round < 2; ++round) {
        rows.compute(tableOfMotions(motions), 0, motions.size());
        for (std::size_t i = 0; i < motions.size(); ++i) {
          dynamics.compute(motions[i], workspace);
          EXPECT_EQ(differences(rows.read(i), workspace.results()), "") << name << ' ' << i;
        }
      }
    }
  }
}

void expectLoads(const Dynamics& dynamics, const std::vector<Motion>& motions,
                 std::vector<Load> loads, int threads) {
  const MotionTable table = tableOfMotions(motions);
  Dynamics::Workspace expected = dynamics.makeWorkspace(), own = dynamics.makeWorkspace();
  SampleRows rows(dynamics, kCapacity, threads);
  for (std::size_t first = 0; first < kRows; first += kCapacity) {
    const std::size_t count = std::min(kCapacity, kRows - first);
    rows.compute(table, first, count, &loads[first]);
    for (std::size_t i = 0; i < count; ++i) {
      dynamics.compute(motions[first + i], loads[first + i], expected);
      for (Wrench& wrench : loads[first + i].wrenches) wrench = {};  // rows keep what they had
      EXPECT_EQ(differences(rows.read(i), expected.results()), "") << first + i;
    }
  }
  rows.compute(table, 0, 9);
  dynamics.compute(motions[2], own);
  EXPECT_EQ(differences(rows.read(2), own.results()), "");
  loads[2].wrenches.pop_back();
  EXPECT_THROW(rows.compute(table, 0, 3, loads.data()), SceneError);
}

// Rows with loads of their own, on a link in its axes and on another one in those of the root.
TEST(SampleRows, MayHaveLoadsOfTheirOwn) {
  for (Recorded recorded : {openChain(), closedLinkage()}) {
    const std::vector<Link>& links = recorded.mechanism.links();
    recorded.scene.applied_wrenches.resize(2);
    recorded.scene.applied_wrenches[0].link = links.back().name;
    recorded.scene.applied_wrenches[0].at << 0.1, 0.2, 0;
    recorded.scene.applied_wrenches[1].link = links[2].name;
    recorded.scene.applied_wrenches[1].axes = Axes::kRoot;
    std::vector<Load> loads(kRows, Load(recorded.scene));
    RobotBuilder numbers(9);
    for (Load& load : loads) {
      for (Wrench& wrench : load.wrenches) {
        wrench.force = numbers.vector(20).cast<double>();
        wrench.torque = numbers.vector(5).cast<double>();
      }
    }
    for (const Request& request : requestsOf(recorded)) {
      for (const int threads : {1, 3}) {
        expectLoads(Dynamics(recorded.mechanism, recorded.scene, request), recorded.motions, loads,
                    threads);
      }
    }
  }
}

TEST(SampleRows, AreMovedWithTheirMemory) {
  const Recorded recorded = closedLinkage();
  const Dynamics dynamics(recorded.mechanism, recorded.scene, everythingOf(recorded));
  SampleRows before(dynamics, kCapacity, 2);
  SampleRows rows(std::move(before));
  rows.compute(tableOfMotions(recorded.motions), 3, 4);
  Dynamics::Workspace expected = dynamics.makeWorkspace();
  dynamics.compute(recorded.motions[5], expected);
  EXPECT_EQ(differences(rows.read(2), expected.results()), "");
}

TEST(SampleRows, RefuseWhatDoesNotFit) {
  for (const Recorded& recorded : {openChain(), closedLinkage()}) {
    const Dynamics dynamics(recorded.mechanism, recorded.scene);
    EXPECT_THROW(SampleRows(dynamics, kCapacity, 0), Error);
    const MotionTable table = tableOfMotions(recorded.motions);
    SampleRows rows(dynamics, kCapacity, 2);
    EXPECT_EQ(messageOf([&] { rows.read(0); }), "block: there is no sample 0, it has 0");
    EXPECT_EQ(messageOf([&] { rows.compute(table, 0, kCapacity + 1); }),
              "block: 11 rows are more than its capacity, 10");
    EXPECT_NE(messageOf([&] { rows.compute(table, kRows - 4, 5); }), "nothing thrown");
    for (Eigen::MatrixXd MotionTable::*missing :
         {&MotionTable::positions, &MotionTable::velocities, &MotionTable::accelerations}) {
      MotionTable narrow = table;
      (narrow.*missing).conservativeResize(Eigen::NoChange, 2);
      EXPECT_NE(messageOf([&] { rows.compute(narrow, 0, 4); }), "nothing thrown");
      (narrow.*missing).resize(0, 0);
      EXPECT_NE(messageOf([&] { rows.compute(narrow, 0, 4); }), "nothing thrown");
    }
    rows.compute(table, kRows - 4, 4);
    EXPECT_EQ(messageOf([&] { rows.read(4); }), "block: there is no sample 4, it has 4");
    rows.read(3);
  }
}

// A table without columns has no rows, and yet as many instants as the caller says.
TEST(SampleRows, MechanismsWithoutCoordinatesHaveSpringsToo) {
  RobotBuilder builder(1);
  builder.add(JointType::kFixed, 0, Vector3l::Zero(), Matrix3l::Identity(), Vector3l(1, 0, 0));
  Scene scene;
  PointSpring spring;
  spring.name = "spring";
  spring.link_a = "link_0";
  spring.link_b = "link_1";
  spring.stiffness = 100;
  scene.springs = {spring};
  Request request;
  request.root_axes = {"joint_1"};
  const Dynamics dynamics(builder.build(), scene, request);
  ASSERT_TRUE(dynamics.closed());
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  dynamics.compute(Motion(0), workspace);
  SampleRows rows(dynamics, 4);
  rows.compute(MotionTable(), 0, 3);
  EXPECT_EQ(rows.read(2).root_axes[0].force, workspace.results().root_axes[0].force);
  EXPECT_NE(rows.read(2).root_axes[0].force.x(), 0);
}

}  // namespace
}  // namespace virtual_work_dynamics
