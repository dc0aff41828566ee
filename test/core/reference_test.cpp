#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <set>
#include <string>

#include "offline_tool.h"

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
  // Largest error of each kind, relative to the largest number of the kind in the same row.
  void expectAgreement(const std::string& robot, const std::set<std::string>& prismatic) {
    const std::string shared = VWD_SHARED_DATA;
    const std::string reference = shared + "/reference/" + robot + "/";
    const std::string urdf = shared + "/robots/" + robot + ".urdf";
    if (!std::filesystem::exists(reference) || !std::filesystem::exists(urdf)) {
      GTEST_SKIP() << "no reference results of " << robot << " in '" << shared << "'";
    }
    const Run result = run("--urdf '" + urdf + "' --motion '" + reference +
                           "motion.csv' --axes child --gravity '0 0 -9.81'");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const NumberTable expected = parseTable(readFile(reference + "expected.csv"));
    const NumberTable actual = parseTable(result.out);
    ASSERT_GT(expected.header.size(), 1u);
    ASSERT_GT(expected.rows.size(), 0u);
    ASSERT_EQ(actual.header, expected.header);
    ASSERT_EQ(actual.rows.size(), expected.rows.size());

    std::array<double, kKinds> worst{};
    for (std::size_t row = 0; row < expected.rows.size(); ++row) {
      std::array<double, kKinds> largest{};
      std::array<double, kKinds> error{};
      ASSERT_EQ(actual.rows[row].size(), expected.header.size());
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
      std::cout << "  largest relative error of " << kKindNames[kind] << ": " << worst[kind]
                << "\n";
    }
  }
};

TEST_F(Reference, Ur5) {
  expectAgreement("ur5", {});
}

TEST_F(Reference, Tiago) {
  expectAgreement("tiago_no_hand", {"torso_lift_joint"});
}

}  // namespace
}  // namespace virtual_work_dynamics
