#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

// The methods' difference relative to the largest number of the crane's table, some thousand.
constexpr double kMethods = 1e-14;

// A motion of the crane that is longer than what one thread takes at once.
std::string longCraneMotion() {
  std::string text =
      "time,position.slide,position.shoulder,velocity.slide,velocity.shoulder,acceleration.slide,"
      "acceleration.shoulder\n";
  for (int i = 0; i < 2000; ++i) {
    text += numberText(0.01 * i);
    for (int j = 1; j <= 6; ++j) text += "," + numberText((i * 7 + j * 13) % 29 / 8. - 1.5);
    text += "\n";
  }
  return text;
}

TEST_F(OfflineTool, ThreadsChangeNoDigit) {
  write("c.urdf", kCrane);
  write("m.csv", longCraneMotion());
  const Run one = run("--urdf c.urdf --motion m.csv");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(parseTable(one.out).rows.size(), 2000u);
  for (const char* threads : {"1", "2", "3"}) {
    const Run run_with = run(std::string("--urdf c.urdf --motion m.csv --threads ") + threads);
    ASSERT_EQ(run_with.exit_code, 0) << run_with.err;
    EXPECT_EQ(run_with.out, one.out) << threads << " threads";
  }
}

TEST_F(OfflineTool, MethodsAgree) {
  write("c.urdf", kCrane);
  write("m.csv", longCraneMotion());
  for (const std::string options :
       {"", "--axes child --reactions ground,elbow,flange", "--no-efforts --reactions slide"}) {
    const std::string start = "--urdf c.urdf --motion m.csv " + options;
    const Run by_default = run(start), virtual_work = run(start + " --method virtual_work"),
              lagrange = run(start + " --method=lagrange --threads 1");
    ASSERT_EQ(lagrange.exit_code, 0) << lagrange.err;
    EXPECT_EQ(by_default.out, virtual_work.out);
    EXPECT_NE(lagrange.out, virtual_work.out) << "which rounds otherwise";
    const NumberTable expected = parseTable(virtual_work.out), table = parseTable(lagrange.out);
    EXPECT_EQ(table.header, expected.header);
    ASSERT_EQ(table.rows.size(), expected.rows.size());
    double largest = 0, difference = 0;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      EXPECT_EQ(table.rows[row][0], expected.rows[row][0]);
      for (std::size_t column = 1; column < table.header.size(); ++column) {
        const double value = table.rows[row][column];
        ASSERT_TRUE(std::isfinite(value));
        largest = std::max(largest, std::abs(value));
        difference = std::max(difference, std::abs(value - expected.rows[row][column]));
      }
    }
    EXPECT_LE(difference, kMethods * largest) << options;
  }
}

TEST_F(OfflineTool, WithoutEffortsTheReactionsStay) {
  write("c.urdf", kCrane);
  write("m.csv", longCraneMotion());
  const NumberTable all = parseTable(run("--urdf c.urdf --motion m.csv").out);
  const NumberTable reactions = parseTable(run("--urdf c.urdf --motion m.csv --no-efforts").out);
  ASSERT_EQ(reactions.header.size() + 2, all.header.size());
  ASSERT_EQ(reactions.rows.size(), all.rows.size());
  for (std::size_t column = 0; column < reactions.header.size(); ++column) {
    const int same = all.column(reactions.header[column]);
    ASSERT_GE(same, 0) << reactions.header[column];
    for (std::size_t row = 0; row < all.rows.size(); ++row) {
      ASSERT_EQ(reactions.rows[row][column], all.rows[row][static_cast<std::size_t>(same)]);
    }
  }
}

TEST_F(OfflineTool, ExplainsWhatIsLeftOut) {
  write("c.urdf", kCrane);
  const Run all = run("--urdf c.urdf --explain");
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(all.err, "");
  EXPECT_EQ(all.out.rfind("one sample: ", 0), 0u) << all.out;
  EXPECT_NE(all.out.find(" multiplications, "), std::string::npos) << all.out;
  EXPECT_EQ(all.out.find("efforts: not requested"), std::string::npos) << all.out;
  const Run slide = run("--urdf c.urdf --explain --no-efforts --reactions none");
  EXPECT_EQ(slide.out.rfind("one sample: 0 multiplications, 0 additions, ", 0), 0u) << slide.out;
  EXPECT_NE(slide.out.find("left out: efforts: not requested\n"), std::string::npos) << slide.out;
  EXPECT_NE(slide.out.find("shoulder"), std::string::npos) << slide.out;
  const Run nothing_run = run("--urdf c.urdf --explain --check");
  EXPECT_NE(nothing_run.out.find("The robot can run."), std::string::npos) << nothing_run.out;
  EXPECT_NE(nothing_run.out.find("one sample: "), std::string::npos) << nothing_run.out;
}

}  // namespace
}  // namespace virtual_work_dynamics
