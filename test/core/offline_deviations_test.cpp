#include <cmath>
#include <string>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kGiven[] =
    "time,position.hinge,velocity.hinge,acceleration.hinge\n0,0.5,0,0\n0.1,0.5,0,2\n";
// 1e-12 is a few roundings of the numbers of these tests.
constexpr double kClose = 1e-12;

class OfflineDeviations : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("p.urdf", kPendulum);
    write("m.csv", kGiven);
    write("s.yaml", "tolerances: {mass: 0.2, inertia: 0.5}\n");
    write("mass.yaml", "tolerances: {mass: 0.05}\n");
  }
  const std::string start_ = "--urdf p.urdf --motion m.csv ";
};

TEST_F(OfflineDeviations, MotionsThatAreGivenHaveOnlyTheDescriptionsShare) {
  const Run result = run(start_ + "--scene s.yaml --deviations --axes child");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  const std::vector<std::string> expected = {"time",
                                             "effort.hinge",
                                             "reaction.hinge.fx",
                                             "reaction.hinge.fy",
                                             "reaction.hinge.fz",
                                             "reaction.hinge.tx",
                                             "reaction.hinge.ty",
                                             "reaction.hinge.tz",
                                             "tolerance.effort.hinge",
                                             "tolerance.hinge.fx",
                                             "tolerance.hinge.fy",
                                             "tolerance.hinge.fz",
                                             "tolerance.hinge.tx",
                                             "tolerance.hinge.ty",
                                             "tolerance.hinge.tz"};
  EXPECT_EQ(table.header, expected);
  ASSERT_EQ(table.rows.size(), 2u);
  // m l^2 qdd + m g l sin q and I qdd.
  const double weight = 2 * 9.81 * 0.5 * std::sin(0.5);
  const auto column = static_cast<std::size_t>(table.column("tolerance.effort.hinge"));
  EXPECT_NEAR(table.rows[0][column], 0.2 * weight, kClose);
  EXPECT_NEAR(table.rows[1][column], std::hypot(0.2 * (weight + 2 * 0.25 * 2), 0.5 * 0.03 * 2),
              kClose);
}

TEST_F(OfflineDeviations, NotesEffortsThatAreInDoubtWithTheirCause) {
  const std::string doubt = "note: m.csv: effort of 'hinge': deviation ";
  const std::string cause =
      ", 20 % of its rms, mostly from the tolerances of masses and inertias\n";
  const Run noted = run(start_ + "--scene s.yaml --deviations");
  EXPECT_NE(noted.err.find(doubt), std::string::npos) << noted.err;
  EXPECT_NE(noted.err.find(cause), std::string::npos) << noted.err;
  for (const char* fine :
       {"--scene s.yaml --deviations --deviation-warn 0.3", "--scene mass.yaml --deviations",
        "--scene s.yaml --deviations --no-efforts", "--scene s.yaml"}) {
    const Run quiet = run(start_ + fine);
    EXPECT_EQ(quiet.exit_code, 0);
    EXPECT_EQ(quiet.err.find("effort of"), std::string::npos) << fine << quiet.err;
  }
  const Run strict = run(start_ + "--scene mass.yaml --deviations --deviation-warn=0.04");
  EXPECT_NE(strict.err.find(doubt), std::string::npos) << strict.err;
}

TEST_F(OfflineDeviations, WithoutEffortsThereAreColumnsOfReactionsOnly) {
  const Run result = run(start_ + "--scene s.yaml --deviations --no-efforts");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  EXPECT_EQ(table.header.size(), 1u + 6 + 6);
  EXPECT_EQ(table.header.size(), table.rows[0].size());
  EXPECT_EQ(table.column("tolerance.hinge.fx"), 7);
}

TEST_F(OfflineDeviations, AreRefusedWhereNothingIsUncertain) {
  const Run result = run(start_ + "--deviations --output out.csv");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("m.csv: --deviations: the error of this motion is not known"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
  EXPECT_FALSE(exists("out.csv"));
}

TEST_F(OfflineDeviations, ThresholdsNeedDeviationsAndArePositive) {
  EXPECT_EQ(run(start_ + "--deviation-warn 0.2").exit_code, 2);
  for (const char* wrong : {"0", "-1", "much", "inf"}) {
    const Run result = run(start_ + "--deviations --deviation-warn " + wrong);
    EXPECT_EQ(result.exit_code, 2) << wrong;
    EXPECT_NE(result.err.find("--deviation-warn: '" + std::string(wrong) + "'"), std::string::npos);
  }
}

TEST_F(OfflineDeviations, CertificatesSayThatTheyJudgeArithmetic) {
  const Run result = run(start_ + "--certificates");
  EXPECT_NE(result.err.find("certificates judge arithmetic, not input"), std::string::npos);
}

}  // namespace
}  // namespace virtual_work_dynamics
