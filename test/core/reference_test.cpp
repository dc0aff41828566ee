#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "newton_euler_oracle.h"
#include "offline_tool.h"
#include "tested_build.h"
#include "virtual_work_dynamics/motion_csv.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

// The reference is a 113-bit evaluation rounded to double. The tool rounds about 100 times on the
// way through a tree of this depth; 2e-14 is 90 eps of the largest number of the kind in the state.
constexpr double kReference = 2e-14;

enum Kind { kMomentEffort, kForceEffort, kForce, kMoment, kKinds };
constexpr std::array<const char*, kKinds> kKindNames{"efforts, N m", "efforts, N", "forces",
                                                     "moments"};

Kind kindOf(const std::string& column, const std::set<std::string>& prismatic) {
  if (column.compare(0, 7, "effort.") == 0) {
    return prismatic.count(column.substr(7)) > 0 ? kForceEffort : kMomentEffort;
  }
  return column[column.size() - 2] == 'f' ? kForce : kMoment;
}

class Reference : public OfflineTool {
 protected:
  /// False, and the test skipped, when the shared folder lacks the robot.
  bool find(const std::string& robot) {
    const std::string shared = kSharedData;
    reference_ = shared + "/reference/" + robot + "/";
    urdf_ = shared + "/robots/" + robot + ".urdf";
    return std::filesystem::exists(reference_) && std::filesystem::exists(urdf_);
  }

  NumberTable results(const std::string& axes) {
    const Run result = run("--urdf '" + urdf_ + "' --motion '" + reference_ +
                           "motion.csv' --gravity '0 0 -9.81' --axes " + axes);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parseTable(result.out);
  }

  NumberTable reference() const { return parseTable(readFile(reference_ + "expected.csv")); }

  /// What `--axes root` should give, by Newton's and Euler's equations in long double.
  NumberTable rootAxesReference() const {
    const Mechanism mechanism = readUrdfFile(urdf_);
    const MotionTable motions =
        readMotionCsv(reference_ + "motion.csv", mechanism.coordinateNames());
    NumberTable table;
    table.header = reference().header;
    Motion motion(motions.positions.cols());
    for (Eigen::Index row = 0; row < motions.positions.rows(); ++row) {
      motion.q = motions.positions.row(row);
      motion.qd = motions.velocities.row(row);
      motion.qdd = motions.accelerations.row(row);
      const NewtonEulerOracle oracle(mechanism, Scene(), motion);
      std::vector<double> numbers{motions.times[static_cast<std::size_t>(row)]};
      for (const long double effort : oracle.efforts()) {
        numbers.push_back(static_cast<double>(effort));
      }
      for (const int joint : mechanism.coordinates()) {
        const auto wrench = oracle.reaction(joint);
        for (const Vector3l* vector : {&wrench.force, &wrench.torque}) {
          for (int i = 0; i < 3; ++i) numbers.push_back(static_cast<double>((*vector)[i]));
        }
      }
      table.rows.push_back(numbers);
    }
    return table;
  }

 private:
  std::string reference_;
  std::string urdf_;
};

// Largest error of each kind, relative to the largest number of the kind in the same row.
void expectAgreement(const NumberTable& actual, const NumberTable& expected,
                     const std::set<std::string>& prismatic) {
  ASSERT_GT(expected.header.size(), 1u);
  ASSERT_GT(expected.rows.size(), 0u);
  ASSERT_EQ(actual.header, expected.header);
  ASSERT_EQ(actual.rows.size(), expected.rows.size());
  std::array<double, kKinds> worst{};
  for (std::size_t row = 0; row < expected.rows.size(); ++row) {
    std::array<double, kKinds> largest{};
    std::array<double, kKinds> error{};
    ASSERT_EQ(actual.rows[row].size(), expected.header.size());
    ASSERT_EQ(expected.rows[row].size(), expected.header.size());
    EXPECT_EQ(actual.rows[row][0], expected.rows[row][0]);
    for (std::size_t i = 1; i < expected.header.size(); ++i) {
      const Kind kind = kindOf(expected.header[i], prismatic);
      const double value = actual.rows[row][i];
      ASSERT_TRUE(std::isfinite(value)) << expected.header[i];
      largest[kind] = std::max(largest[kind], std::abs(expected.rows[row][i]));
      error[kind] = std::max(error[kind], std::abs(value - expected.rows[row][i]));
    }
    for (int kind = 0; kind < kKinds; ++kind) {
      if (largest[kind] > 0) worst[kind] = std::max(worst[kind], error[kind] / largest[kind]);
      EXPECT_LE(error[kind], kReference * largest[kind]) << kKindNames[kind] << ", row " << row;
    }
  }
  for (int kind = 0; kind < kKinds; ++kind) {
    if (worst[kind] == 0) continue;
    std::cout << "  largest relative error of " << kKindNames[kind] << ": " << worst[kind] << "\n";
  }
}

TEST_F(Reference, Ur5InChildAxes) {
  if (!find("ur5")) GTEST_SKIP() << "no reference results in " << kSharedData;
  expectAgreement(results("child"), reference(), {});
}

TEST_F(Reference, Ur5InRootAxes) {
  if (!find("ur5")) GTEST_SKIP() << "no reference results in " << kSharedData;
  expectAgreement(results("root"), rootAxesReference(), {});
}

TEST_F(Reference, TiagoInChildAxes) {
  if (!find("tiago_no_hand")) GTEST_SKIP() << "no reference results in " << kSharedData;
  expectAgreement(results("child"), reference(), {"torso_lift_joint"});
}

TEST_F(Reference, TiagoInRootAxes) {
  if (!find("tiago_no_hand")) GTEST_SKIP() << "no reference results in " << kSharedData;
  expectAgreement(results("root"), rootAxesReference(), {"torso_lift_joint"});
}

}  // namespace
}  // namespace virtual_work_dynamics
