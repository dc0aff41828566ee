#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "offline_linkage.h"
#include "tested_build.h"

namespace virtual_work_dynamics {
namespace {

// Several blocks of rows for each of the threads, and a part of one.
constexpr int kRows = 700;

LinkageState swing(int i) {
  const double t = 0.01 * i;
  return {0.9 * std::sin(2 * t), 1.8 * std::cos(2 * t), -3.6 * std::sin(2 * t)};
}

std::string swingOfTheDrive(int rows = kRows) {
  std::string text = "time,position.drive\n";
  for (int i = 0; i < rows; ++i) {
    text += numberText(0.01 * i) + "," + numberText(swing(i).q) + "\n";
  }
  return text;
}

/// Writes a motion in which one row is off by an angle, or no row when it is -1.
std::string swingOfAll(int wrong_row = -1) {
  std::string text = kAllColumns;
  for (int i = 0; i < kRows; ++i) text += row(0.01 * i, swing(i), i == wrong_row ? 1e-3 : 0);
  return text;
}

class OfflineLoopThreads : public OfflineLoops {
 protected:
  Run runWith(const std::string& options, int threads) const {
    return run("--urdf l.urdf --scene s.yaml --motion m.csv --threads " + std::to_string(threads) +
               " " + options);
  }

  // Returns what one thread prints.
  Run expectSame(const std::string& options, int exit_code) {
    const Run one = run("--urdf l.urdf --scene s.yaml --motion m.csv " + options);
    EXPECT_EQ(one.exit_code, exit_code) << one.err;
    // With sanitizers a run takes seconds.
    for (const int threads : kSanitized ? std::vector<int>{3} : std::vector<int>{1, 2, 3, 7}) {
      const Run other = runWith(options, threads);
      EXPECT_EQ(other.exit_code, one.exit_code) << threads << " threads";
      EXPECT_EQ(other.out, one.out) << threads << " threads";
      EXPECT_EQ(other.err, one.err) << threads << " threads";
    }
    return one;
  }
};

TEST_F(OfflineLoopThreads, ChangeNoDigit) {
  for (const std::string& motion : {swingOfTheDrive(), swingOfAll(), swingOfTheDrive(3)}) {
    write("m.csv", motion);
    for (const std::string options : {"--certificates", "--no-efforts --axes child", "--check"}) {
      const Run one = expectSame(options, 0);
      EXPECT_FALSE(one.out.empty());
    }
  }
  write("m.csv", swingOfTheDrive(3));
  EXPECT_EQ(runWith("", 1024).out, runWith("", 1).out) << "more threads than rows";
  write("m.csv", swingOfAll());
  EXPECT_EQ(parseTable(expectSame("", 0).out).rows.size(), static_cast<std::size_t>(kRows));
}

TEST_F(OfflineLoopThreads, LagrangesEquationsTakeOne) {
  write("m.csv", swingOfAll());
  EXPECT_EQ(failure("--scene s.yaml --motion m.csv --method lagrange --threads 2", 2),
            "--threads: --method lagrange runs in one thread, not in 2");
}

// Whichever thread meets which first: a row that cannot be completed, in the same block as one
// before it that violates a loop.
TEST_F(OfflineLoopThreads, TheFirstRowThatIsWrongIsNamed) {
  write("s.yaml", pinned("0.7"));
  for (const int open : {0, 3, 300, kRows - 1}) {
    std::string text = "time,position.drive\n";
    for (int i = 0; i < kRows; ++i) {
      text += numberText(0.01 * i) + (i < open ? ",0\n" : ",-1.5\n");
    }
    write("m.csv", text);
    const Run one = expectSame("", 1);
    EXPECT_NE(one.err.find("m.csv: line " + std::to_string(open + 2) + ": the loops cannot be"),
              std::string::npos)
        << one.err;
  }
  write("s.yaml", pinned("0.5"));
  for (const int wrong : {0, 3, 300, kRows - 1}) {
    write("m.csv", swingOfAll(wrong));
    const Run one = expectSame("", 1);
    EXPECT_NE(one.err.find("m.csv: line " + std::to_string(wrong + 2) + ": the positions violate"),
              std::string::npos)
        << one.err;
  }
}

// Velocities follow from the closures, positions and accelerations are given: the positions of one
// row violate a loop, and a row behind it is singular.
TEST_F(OfflineLoopThreads, ARowThatViolatesALoopIsNamedBeforeOneThatIsSingular) {
  for (const bool violated : {true, false}) {
    std::string text =
        "time,position.drive,position.elbow,position.wrist,acceleration.drive,acceleration.elbow,"
        "acceleration.wrist\n";
    for (int i = 0; i < 200; ++i) {
      const double q = std::acos(0.0) + 0.001 * (i - 110);
      const double off = violated && i == 105 ? 1e-3 : 0;
      text += numberText(0.01 * i) + "," + numberText(q) + "," + numberText(-q + off) + "," +
              numberText(q) + ",0,0,0\n";
    }
    write("m.csv", text);
    const Run one = expectSame("", 1);
    EXPECT_NE(one.err.find(violated ? "line 107: the positions violate"
                                    : "line 112: the position is singular"),
              std::string::npos)
        << one.err;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
