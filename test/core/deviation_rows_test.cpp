#include "offline/deviation_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dynamics/sample_rows.h"
#include "motion/table_row.h"
#include "random_motions.h"
#include "robot_builder.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Two rows of a chain of three joints, with covariances.
class DeviationRowsOf : public testing::Test {
 protected:
  DeviationRowsOf() : builder_(chainOf(3)), mechanism_(builder_.build()) {
    table_.joints = mechanism_.coordinateNames();
    table_.times = {0, 1};
    for (auto* columns : {&table_.positions, &table_.velocities, &table_.accelerations}) {
      columns->resize(2, 3);
    }
    for (Eigen::Index row = 0; row < 2; ++row) {
      const Motion motion = builder_.motion();
      table_.positions.row(row) = motion.q;
      table_.velocities.row(row) = motion.qd;
      table_.accelerations.row(row) = motion.qdd;
      const MotionCovariance covariance = randomCovariance(7 + static_cast<unsigned>(row), 3, 1e-4);
      table_.covariances.insert(table_.covariances.end(), covariance.coordinates.begin(),
                                covariance.coordinates.end());
    }
    request_.child_axes = {"joint_2", "joint_3"};
    columns_.efforts = table_.joints;
    columns_.reactions = request_.child_axes;
  }

  RobotBuilder builder_;
  const Mechanism mechanism_;
  MotionTable table_;
  Request request_;
  Columns columns_;
};

TEST_F(DeviationRowsOf, CellsAreThoseOfTheirColumnsAndRows) {
  Scene scene;
  scene.tolerances.mass = 0.1;
  DeviationRows rows(mechanism_, scene, request_, table_, "m.csv");
  const std::vector<std::string> names = rows.columns(columns_);
  ASSERT_EQ(names.size(), 2u * (3 + 2 * 6));
  EXPECT_EQ(names[0], "deviation.effort.joint_1");
  EXPECT_EQ(names[3], "deviation.joint_2.fx");
  EXPECT_EQ(names[14], "deviation.joint_3.tz");
  EXPECT_EQ(names[15], "tolerance.effort.joint_1");
  const Deviations deviations(mechanism_, scene, request_);
  Deviations::Workspace workspace = deviations.makeWorkspace();
  const Dynamics dynamics(mechanism_, scene, request_);
  Dynamics::Workspace computed = dynamics.makeWorkspace();
  Motion motion(3);
  for (std::size_t row = 0; row < 2; ++row) {
    takeRow(table_, row, motion);
    dynamics.compute(motion, computed);
    std::vector<double> cells{42};
    rows.add(row, motion, Load(scene), computed.results(), cells);
    deviations.computeMotion(motion, randomCovariance(7 + static_cast<unsigned>(row), 3, 1e-4),
                             workspace);
    deviations.computeDescription(motion, workspace);
    std::vector<double> expected{42};
    for (const auto* share : {&workspace.motion(), &workspace.description()}) {
      const std::vector<double> numbers = numbersOf(*share);
      expected.insert(expected.end(), numbers.begin(), numbers.end());
    }
    EXPECT_EQ(cells, expected);
  }
  const std::string notes = rows.notes(1e-9);
  EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 3);
  EXPECT_EQ(notes.find("note: m.csv: effort of 'joint_1': deviation "), 0u);
  EXPECT_EQ(rows.notes(1e9), "");
}

TEST_F(DeviationRowsOf, LoopsThatTheMotionViolatesAreSaidWithTheirLargestViolation) {
  const Dynamics dynamics(mechanism_, Scene(), request_);
  Dynamics::Workspace workspace = dynamics.makeWorkspace();
  Motion motion(3);
  takeRow(table_, 0, motion);
  dynamics.compute(motion, workspace);
  for (double ClosureResidual::*level :
       {&ClosureResidual::position, &ClosureResidual::velocity, &ClosureResidual::acceleration}) {
    DeviationRows rows(mechanism_, Scene(), request_, table_, "m.csv");
    std::vector<double> cells;
    Results results = workspace.results();
    results.loops.relative_residuals.assign(2, ClosureResidual());
    results.loops.relative_residuals[1].*level = 9e-7;
    rows.add(0, motion, Load(Scene()), results, cells);
    EXPECT_EQ(rows.notes(1e9), "");
    results.loops.relative_residuals[1].*level = 0.25;
    rows.add(0, motion, Load(Scene()), results, cells);
    results.loops.relative_residuals[1].*level = 0;
    rows.add(0, motion, Load(Scene()), results, cells);
    EXPECT_EQ(rows.notes(1e9),
              "note: m.csv: the motion violates loops by up to 0.25 relative, of which deviations "
              "know nothing: errors of results may be larger\n");
  }
}

TEST_F(DeviationRowsOf, WithoutTolerancesThereAreNoColumnsOfThem) {
  const DeviationRows rows(mechanism_, Scene(), request_, table_, "m.csv");
  EXPECT_EQ(rows.columns(columns_).size(), 3u + 2 * 6);
  table_.covariances.clear();
  EXPECT_THROW(DeviationRows(mechanism_, Scene(), request_, table_, "m.csv"), Error);
}

}  // namespace
}  // namespace virtual_work_dynamics
