#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/number_text.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

// Terms of four bodies are rounded a dozen times each; relative to their magnitudes.
constexpr double kRounding = 2e-15;

std::string craneMotion(int rows) {
  std::string text =
      "time,position.slide,position.shoulder,velocity.slide,velocity.shoulder,acceleration.slide,"
      "acceleration.shoulder\n";
  for (int i = 0; i < rows; ++i) {
    text += numberText(0.01 * i);
    for (int j = 1; j <= 6; ++j) text += "," + numberText((i * 7 + j * 13) % 29 / 8. - 1.6);
    text += "\n";
  }
  return text;
}

TEST_F(OfflineTool, CertificatesFollowUnchangedColumns) {
  write("c.urdf", kCrane);
  write("m.csv", craneMotion(700));
  for (const std::string options :
       {"", "--no-efforts", "--axes child", "--axes child --reactions elbow,ground",
        "--reactions none", "--reactions none --no-efforts", "--threads 3 --reactions ground",
        "--method lagrange --axes child --reactions slide --no-efforts"}) {
    const std::string start = "--urdf c.urdf --motion m.csv " + options;
    const Run plain = run(start), certified = run(start + " --certificates");
    ASSERT_EQ(certified.exit_code, 0) << certified.err;
    EXPECT_NE(certified.out.find(kCertificateColumns), std::string::npos) << options;
    EXPECT_EQ(withoutCertificates(certified.out), plain.out) << options;
    const NumberTable table = parseTable(certified.out);
    ASSERT_EQ(table.rows.size(), 700u);
    double largest = 0;
    for (const std::vector<double>& row : table.rows) {
      ASSERT_EQ(row.size(), table.header.size());
      for (std::size_t i = row.size() - 3; i < row.size(); ++i) {
        ASSERT_TRUE(row[i] >= 0 && row[i] <= kRounding) << row[i];
        largest = std::max(largest, row[i]);
      }
    }
    EXPECT_GT(largest, 0);
  }
}

TEST_F(OfflineTool, NotesTheWorstCertificateAndItsLine) {
  write("c.urdf", kCrane);
  write("m.csv", "# a comment\n" + craneMotion(50));
  const Run result = run("--urdf c.urdf --motion m.csv --certificates");
  const NumberTable table = parseTable(result.out);
  std::size_t worst_row = 0, worst_column = table.header.size() - 3;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    for (std::size_t column = table.header.size() - 3; column < table.header.size(); ++column) {
      if (table.rows[row][column] <= table.rows[worst_row][worst_column]) continue;
      worst_row = row;
      worst_column = column;
    }
  }
  std::ostringstream expected;
  expected.precision(2);
  expected << "note: m.csv: certificates judge arithmetic, not input: "
           << table.header[worst_column] << " is " << table.rows[worst_row][worst_column]
           << " at worst, line " << worst_row + 3 << "\n";
  // Behind the doubt about the crane's tool.
  EXPECT_EQ(result.err.substr(result.err.find("note: ")), expected.str());
}

TEST_F(OfflineTool, CertificatesAtRestHaveNoPower) {
  write("c.urdf", kCrane);
  write("s.yaml", "motion: static\n");
  write("m.csv", craneMotion(20));
  const Run result = run("--urdf c.urdf --motion m.csv --scene s.yaml --certificates");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  ASSERT_EQ(table.rows.size(), 20u);
  for (const std::vector<double>& row : table.rows) {
    EXPECT_EQ(row[row.size() - 3], 0);
    EXPECT_LE(std::max(row[row.size() - 2], row.back()), kRounding);
  }
}

TEST_F(OfflineTool, RowsThatOverflowAreNotCertified) {
  write("p.urdf", kPendulum);
  write("m.csv",
        "time,position.hinge,velocity.hinge,acceleration.hinge\n0,0.5,1,2\n1,0.5,1e200,2\n");
  const Run result = run("--urdf p.urdf --motion m.csv --certificates");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_LE(table.rows[0].back(), kRounding);
  EXPECT_TRUE(std::isnan(table.rows[1].back()));
  EXPECT_NE(result.err.find("; 1 row not certified: not finite\n"), std::string::npos)
      << result.err;
}

TEST_F(OfflineTool, ExplainsWhatCertificatesTake) {
  write("c.urdf", kCrane);
  const std::string nothing = "--urdf c.urdf --explain --no-efforts --reactions none";
  EXPECT_NE(run(nothing).out.find("efforts: not requested"), std::string::npos);
  const Run result = run(nothing + " --certificates");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.find("efforts: not requested"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace virtual_work_dynamics
