#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "offline_linkage.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

// That the tool makes load reports; what is in them, test/scripts/load_report_test.py knows.
class OfflineReport : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("pendulum.urdf", kPendulum);
    std::string motion = "time,position.hinge,velocity.hinge,acceleration.hinge\n";
    for (int i = 0; i < 50; ++i) {
      motion += std::to_string(0.01 * i) + "," + std::to_string(0.01 * i * i) + "," +
                std::to_string(2.0 * i) + ",200\n";
    }
    write("swing.csv", motion);
  }

  Run report(const std::string& more, const std::string& before = "") const {
    return run("--urdf pendulum.urdf --motion swing.csv --report loads " + more, before);
  }

  // Whether reports can be made here: not beside the tool of other tests, nor without the packages.
  static bool possible() {
    return !kSanitized &&
           std::system("/usr/bin/python3 -c 'import matplotlib, scipy.signal' 2>/dev/null") == 0;
  }
};

TEST_F(OfflineReport, IsMadeOfResultsThatItKeeps) {
  if (!possible()) GTEST_SKIP() << "without scipy or matplotlib, or with sanitizers";
  const Run result = report("");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "report: loads/report.html\n");
  for (const char* name : {"report.html", "report.md", "loads.csv", "sums.json", "results.npz"}) {
    EXPECT_TRUE(exists(std::string("loads/") + name)) << name;
  }
  EXPECT_FALSE(exists("loads/mechanism.json"));
  // In child axes, with the axis of the hinge, which turns.
  EXPECT_NE(readFile(path("loads/loads.csv")).find("\nhinge,radial_force,N,"), std::string::npos);
}

TEST_F(OfflineReport, OfACsvHasTheMechanismBesideIt) {
  if (!possible()) GTEST_SKIP() << "without scipy or matplotlib, or with sanitizers";
  const Run npz = report("");
  const std::string loads = readFile(path("loads/loads.csv"));
  const Run csv = report("--output r.csv");
  ASSERT_EQ(csv.exit_code, 0) << csv.err;
  EXPECT_TRUE(exists("r.csv"));
  EXPECT_TRUE(exists("loads/mechanism.json"));
  EXPECT_EQ(readFile(path("loads/loads.csv")), loads);
}

TEST_F(OfflineReport, NamesRowsThatWereEstimatedFromOneSide) {
  if (!possible()) GTEST_SKIP() << "without scipy or matplotlib, or with sanitizers";
  std::string motion = "time,position.hinge\n";
  for (int i = 0; i < 400; ++i) {
    const double time = 0.01 * i + (i < 250 ? 0 : 1);  // with a gap
    motion += std::to_string(time) + "," + std::to_string(0.5 * std::sin(3 * time)) + "\n";
  }
  write("swing.csv", motion);
  const Run result = report("--output r.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(readFile(path("r.csv")));
  const int column = table.column("one_sided");
  ASSERT_GE(column, 0);
  std::string marks;
  for (const auto& cells : table.rows)
    marks += cells[static_cast<std::size_t>(column)] == 1 ? '1' : '0';
  // At both ends and on both sides of the gap, and nowhere else: as many as the note counts.
  const std::size_t first = marks.find('0'), gap = marks.find('1', first);
  const std::size_t after = marks.find('0', gap), last = marks.find('1', after);
  EXPECT_GT(first, 0U);
  EXPECT_LT(gap, 250U);
  EXPECT_GT(after, 250U);
  ASSERT_NE(last, std::string::npos);
  EXPECT_EQ(marks.find('0', last), std::string::npos);
  const auto count = std::count(marks.begin(), marks.end(), '1');
  EXPECT_NE(result.err.find(std::to_string(count) + " of 400 rows are estimated from rows of one"),
            std::string::npos)
      << result.err;
  EXPECT_NE(readFile(path("loads/report.md"))
                .find("estimated from rows of one side: " + std::to_string(count) + " of 400 rows"),
            std::string::npos);
  // A motion that lacks nothing has no such column, nor has a result without a report.
  write("swing.csv", "time,position.hinge,velocity.hinge,acceleration.hinge\n0,0,1,0\n1,1,1,0\n");
  ASSERT_EQ(report("--output r.csv").exit_code, 0);
  EXPECT_EQ(parseTable(readFile(path("r.csv"))).column("one_sided"), -1);
}

TEST_F(OfflineReport, OfLoopsKnowsConditionAndHowClosuresTurn) {
  write("linkage.urdf", kLinkage);
  write("loops.yaml", pinned("0.5"));
  write("m.csv", "time,position.drive,velocity.drive,acceleration.drive\n0,0.5,-0.75,0\n");
  run("--urdf linkage.urdf --scene loops.yaml --motion m.csv --report loads --output r.csv");
  const NumberTable table = parseTable(readFile(path("r.csv")));
  ASSERT_GE(table.column("condition"), 0);
  EXPECT_GE(table.rows.at(0)[static_cast<std::size_t>(table.column("condition"))], 1);
  EXPECT_GE(table.column("velocity.wrist"), 0);
  // The rocker turns like the crank, about the axis of the pin, against the base that does not.
  ASSERT_GE(table.column("turning.pin"), 0);
  EXPECT_NEAR(table.rows.at(0)[static_cast<std::size_t>(table.column("turning.pin"))], -0.75,
              1e-12);
  run("--urdf linkage.urdf --scene loops.yaml --motion m.csv --output r.csv");
  EXPECT_EQ(parseTable(readFile(path("r.csv"))).column("condition"), -1);
}

TEST_F(OfflineReport, RefusesInOneLineWhatItCannotBeMadeOf) {
  const struct {
    std::string words, message;
    int status;
  } kCases[] = {
      {"--axes root", "--axes root: a report needs reactions in the axes of the child links", 2},
      {"--output r.bag", "--report: it is made of results as .npz or CSV, not of a bag", 2},
      {"--check", "--report cannot be used with --check or --explain", 2},
  };
  for (const auto& [words, message, status] : kCases) {
    SCOPED_TRACE(words);
    const Run result = report(words);
    EXPECT_EQ(result.exit_code, status);
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_FALSE(exists("loads"));
  }
  write("taken", "");
  const Run result = run("--urdf pendulum.urdf --motion swing.csv --report taken");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("--report: taken: cannot be made"), std::string::npos) << result.err;
}

TEST_F(OfflineReport, WithoutItsProgramIsRefusedBeforeAnyRow) {
  const std::string copy = path("alone");
  std::filesystem::copy_file(kOfflineTool, copy);
  const std::string command = "cd '" + folder() +
                              "' && ./alone --urdf pendulum.urdf --motion swing.csv --report loads "
                              "2>said";
  EXPECT_NE(std::system(command.c_str()), 0);
  const std::string said = readFile(path("said"));
  if (said.find("loading shared libraries") != std::string::npos) GTEST_SKIP() << said;
  EXPECT_NE(said.find("load_report.py is not beside this program"), std::string::npos) << said;
  EXPECT_FALSE(exists("loads/results.npz"));
}

}  // namespace
}  // namespace virtual_work_dynamics
