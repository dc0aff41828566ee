#include "virtual_work_dynamics/motion_csv.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

MotionTable read(const std::string& text, const std::vector<std::string>& joints = {},
                 std::vector<std::string>* unused = nullptr,
                 std::vector<std::size_t>* lines = nullptr) {
  std::istringstream stream(text);
  return readMotionCsv(stream, "m.csv", joints, unused, lines);
}

// The error of the reader for a text that it refuses.
std::string refusal(const std::string& text, const std::vector<std::string>& joints = {}) {
  try {
    read(text, joints);
  } catch (const FileError& error) {
    return error.what();
  }
  return "(not refused)";
}

// A file that is gone at the end of the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content)
      : path_(testing::TempDir() + "motion_csv_test_" + std::to_string(getpid()) + ".csv") {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

TEST(MotionCsv, ReadsAllThreeKindsInAnyColumnOrder) {
  const MotionTable table = read(
      "acceleration.b,position.a,velocity.b,time,velocity.a,position.b,acceleration.a\n"
      "6,1,4,0.5,3,2,5\n"
      "-6e-1,-1,+4,0.75,3.5,2,5\n");
  EXPECT_EQ(table.joints, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(table.times, (std::vector<double>{0.5, 0.75}));
  const Eigen::Matrix2d positions = (Eigen::Matrix2d() << 1, 2, -1, 2).finished();
  const Eigen::Matrix2d velocities = (Eigen::Matrix2d() << 3, 4, 3.5, 4).finished();
  const Eigen::Matrix2d accelerations = (Eigen::Matrix2d() << 5, 6, 5, -0.6).finished();
  EXPECT_EQ(table.positions, positions);
  EXPECT_EQ(table.velocities, velocities);
  EXPECT_EQ(table.accelerations, accelerations);
}

TEST(MotionCsv, TakesTheWantedJointsInTheWantedOrder) {
  std::vector<std::string> unused;
  const MotionTable table = read(
      "time,position.a,position.b,position.c,velocity.c\n0,1,2,3,no number\n", {"b", "a"}, &unused);
  EXPECT_EQ(table.joints, (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(table.positions, Eigen::RowVector2d(2, 1));
  EXPECT_FALSE(table.hasVelocities());
  EXPECT_FALSE(table.hasAccelerations());
  EXPECT_EQ(unused, (std::vector<std::string>{"position.c", "velocity.c"}));
}

TEST(MotionCsv, VelocitiesAndAccelerationsAreOptionalEachByItself) {
  const MotionTable no_velocities = read("time,position.a,acceleration.a\n0,1,2\n");
  EXPECT_FALSE(no_velocities.hasVelocities());
  ASSERT_TRUE(no_velocities.hasAccelerations());
  EXPECT_EQ(no_velocities.accelerations(0, 0), 2);
  const MotionTable no_accelerations = read("time,position.a,velocity.a\n0,1,2\n");
  EXPECT_FALSE(no_accelerations.hasAccelerations());
  ASSERT_TRUE(no_accelerations.hasVelocities());
  EXPECT_EQ(no_accelerations.velocities(0, 0), 2);
}

TEST(MotionCsv, JointNamesMayHoldPoints) {
  EXPECT_EQ(read("time,position.arm.1\n0,1\n").joints, (std::vector<std::string>{"arm.1"}));
}

TEST(MotionCsv, TimesAloneAreATableWithoutJoints) {
  const MotionTable table = read("time\n0\n1\n");
  EXPECT_TRUE(table.joints.empty());
  EXPECT_EQ(table.times.size(), 2u);
  EXPECT_EQ(table.positions.rows(), 2);
  EXPECT_EQ(table.positions.cols(), 0);
}

TEST(MotionCsv, ToleratesTheHabitsOfOtherPrograms) {
  std::vector<std::size_t> lines;
  const MotionTable table = read(
      "\xEF\xBB\xBF# made by hand\r\n\r\n time , position.a\t\r\n  # a comment\r\n0, 1 \r\n#\r\n"
      " 1 ,\t2\r\n\r\n\n",
      {}, nullptr, &lines);
  EXPECT_EQ(table.joints, (std::vector<std::string>{"a"}));
  EXPECT_EQ(table.times, (std::vector<double>{0, 1}));
  EXPECT_EQ(table.positions, Eigen::Vector2d(1, 2));
  EXPECT_EQ(lines, (std::vector<std::size_t>{5, 7}));
}

// R's write.csv and pandas quote names, and cells, too.
TEST(MotionCsv, ReadsQuotedNamesAndCells) {
  const MotionTable table = read(
      "\"\",\"time\" , \"position.a\"\"b\",\"position.c,d\",velocity.e\r\n"
      "\"1\",0,\"0.5\",-1,\"x, y\"\r\n2,1,0.25,\" 2 \",\r\n",
      {"c,d", "a\"b"});
  EXPECT_EQ(table.times, (std::vector<double>{0, 1}));
  EXPECT_EQ(table.positions, (Eigen::Matrix2d() << -1, 0.5, 2, 0.25).finished());
  const std::string header = "\"time\",\"position.a\"\n";
  EXPECT_EQ(refusal(header + "0,\"1\n"), "m.csv: line 2: its quotes do not match");
  EXPECT_EQ(refusal(header + "0,\"1\"2\n"), "m.csv: line 2: its quotes do not match");
  EXPECT_EQ(refusal(header + "0,1\"\n"), "m.csv: line 2: its quotes do not match");
  EXPECT_EQ(refusal("time,\"position.a\n0,1\n"), "m.csv: line 1: its quotes do not match");
  EXPECT_EQ(refusal(header + "0,\"1,2\"\n"),
            "m.csv: line 2, column 2 (position.a): '1,2' is not a finite number");
  EXPECT_EQ(refusal(header + "\"0\",\"1\",\"2\"\n"),
            "m.csv: line 2: 2 cells expected as in the header, 3 found");
}

TEST(MotionCsv, LinesMayEndWithACommaWhereTheHeaderDoes) {
  const MotionTable table = read("time,position.a,\n0,1,\n1,2\n");
  EXPECT_EQ(table.joints, (std::vector<std::string>{"a"}));
  EXPECT_EQ(table.positions, Eigen::Vector2d(1, 2));
  EXPECT_EQ(refusal("time,position.a,\n0,1,2,\n"),
            "m.csv: line 2: 2 cells expected as in the header, 3 found");
  EXPECT_EQ(refusal("time,position.a,\n0,\n"),
            "m.csv: line 2: 2 cells expected as in the header, 1 found");
}

TEST(MotionCsv, WhatResultsAndOtherProgramsHoldIsLeftOut) {
  std::vector<std::string> unused;
  const MotionTable table =
      read(",time,position.a,effort.a,reaction.a.fx\n0,0.5,1,x,\n1,0.75,2,y,\n", {}, &unused);
  EXPECT_EQ(table.times, (std::vector<double>{0.5, 0.75}));
  EXPECT_EQ(table.positions, Eigen::Vector2d(1, 2));
  EXPECT_EQ(unused, (std::vector<std::string>{"effort.a", "reaction.a.fx"}));
}

TEST(MotionCsv, SemicolonsInRowsAreSpokenOf) {
  EXPECT_EQ(refusal("time,position.a\n0;1\n"),
            "m.csv: line 2: 2 cells expected as in the header, 1 found; cells are separated by "
            "commas, not semicolons");
}

TEST(MotionCsv, TheLastLineNeedsNoLineEnd) {
  EXPECT_EQ(read("time,position.a\n0,1\n1,2").positions, Eigen::Vector2d(1, 2));
}

TEST(MotionCsv, NamesAMissingColumn) {
  EXPECT_EQ(refusal("position.a\n1\n"), "m.csv: line 1: column 'time' is missing");
  EXPECT_EQ(refusal("# c\ntime,position.a,position.bb\n0,1,2\n", {"a", "b"}),
            "m.csv: line 2: column 'position.b' is missing; there are 'position.bb'");
  EXPECT_EQ(refusal("time,position.slidr,velocity.slidr\n0,1,2\n", {"slider"}),
            "m.csv: line 1: column 'position.slider' is missing; is it 'position.slidr'?");
  EXPECT_EQ(refusal("time,velocity.a\n0,1\n"), "m.csv: line 1: no column position.<joint>");
}

TEST(MotionCsv, NamesTheJointWithoutVelocityOrAcceleration) {
  EXPECT_EQ(refusal("time,position.a,position.b,velocity.a\n0,1,2,3\n"),
            "m.csv: line 1: column 'velocity.b' is missing, though other joints have one: give all "
            "or none");
  EXPECT_EQ(refusal("time,position.a,position.b,acceleration.b\n0,1,2,3\n"),
            "m.csv: line 1: column 'acceleration.a' is missing, though other joints have one: give "
            "all or none");
}

TEST(MotionCsv, NamesADoubledColumn) {
  EXPECT_EQ(refusal("time,position.a,position.a\n0,1,2\n"),
            "m.csv: line 1, column 3: 'position.a' already stands in column 2");
  EXPECT_EQ(refusal("time,position.a,time\n0,1,2\n"),
            "m.csv: line 1, column 3: 'time' already stands in column 1");
}

TEST(MotionCsv, NamesAColumnThatIsMisspelt) {
  const std::string tail =
      " is not one of time, position.<joint>, velocity.<joint>, acceleration.<joint>";
  const std::pair<const char*, const char*> helped[] = {
      {"positon.a", "; did you mean 'position.a'?"},
      {"Velocity.a", "; did you mean 'velocity.a'?"},
      {"Time", "; did you mean 'time'?"},
      {"time;position.a",
       "; cells are separated by commas, not semicolons, and numbers have a decimal point"},
      {"time\tposition.a", "; cells are separated by commas"}};
  for (const auto& [column, help] : helped) {
    const std::string message = refusal("time," + std::string(column) + "\n0,1\n");
    EXPECT_EQ(message.substr(message.find(tail) + tail.size()), help) << message;
  }
}

TEST(MotionCsv, LeavesColumnsOutThatItDoesNotKnow) {
  std::istringstream text(
      "time,place.a,effort,effort.a,position,position.a,,x,x,temperature.a,\n"
      "0,high,1,2,3,4,,5,6,,\n");
  std::vector<std::string> unused;
  const MotionTable table = readMotionCsv(text, "m.csv", {}, &unused);
  EXPECT_EQ(table.joints, std::vector<std::string>{"a"});
  EXPECT_EQ(table.positions(0, 0), 4);
  EXPECT_EQ(unused, (std::vector<std::string>{"place.a", "effort", "effort.a", "position", "x", "x",
                                              "temperature.a"}));
}

TEST(MotionCsv, CountsTheCellsOfARaggedRow) {
  const std::string header = "time,position.a,position.b\n";
  EXPECT_EQ(refusal(header + "0,1,2\n1,2\n"),
            "m.csv: line 3: 3 cells expected as in the header, 2 found");
  EXPECT_EQ(refusal(header + "0,1,2,\n"),
            "m.csv: line 2: 3 cells expected as in the header, 4 found");
  EXPECT_EQ(refusal(header + "0,1,2,3\n", {"a"}),
            "m.csv: line 2: 3 cells expected as in the header, 4 found");
}

TEST(MotionCsv, QuotesWhatIsNoNumber) {
  const std::string start = "time,position.a,velocity.a\n0,1,2\n";
  EXPECT_EQ(refusal(start + "1,1.5x,2\n"),
            "m.csv: line 3, column 2 (position.a): '1.5x' is not a finite number");
  EXPECT_EQ(refusal(start + "1,2,nan\n"),
            "m.csv: line 3, column 3 (velocity.a): 'nan' is not a finite number");
  EXPECT_EQ(refusal(start + "1e999,2,3\n"),
            "m.csv: line 3, column 1 (time): '1e999' is not a finite number");
  EXPECT_EQ(refusal(start + "1,,2\n"), "m.csv: line 3, column 2 (position.a): the cell is empty");
}

TEST(MotionCsv, QuotesGarbageOnOneShortLine) {
  const std::string message = refusal("time,position.a\n0,\x01\x02" + std::string(500, 'z') + "\n");
  EXPECT_EQ(message, "m.csv: line 2, column 2 (position.a): '\\x01\\x02" + std::string(58, 'z') +
                         "...' is not a finite number");
}

TEST(MotionCsv, RefusesFilesWithoutRows) {
  EXPECT_EQ(refusal(""), "m.csv: the file is empty");
  EXPECT_EQ(refusal("# only\n\n"), "m.csv: no header, only comments or blank lines");
  EXPECT_EQ(refusal("time,position.a\n"), "m.csv: no rows after the header");
  EXPECT_EQ(refusal("time,position.a\n# none\n\n"), "m.csv: no rows after the header");
}

TEST(MotionCsv, RefusesRowsAfterABlankLine) {
  EXPECT_EQ(refusal("time,position.a\n0,1\n\n# x\n1,2\n"),
            "m.csv: line 3 is blank, but line 5 follows");
}

TEST(MotionCsv, ReadsFromAFile) {
  const TemporaryFile file("time,position.a\n0,1\n");
  EXPECT_EQ(readMotionCsv(file.path()).positions(0, 0), 1);
}

TEST(MotionCsv, TheHeaderMayDecideWhichJointsAreRead) {
  const TemporaryFile file("time,position.c,position.a,velocity.a,position.b\n0,3,1,4,2\n");
  std::vector<std::string> offered, unused;
  const auto choose = [&](const std::vector<std::string>& chosen) {
    return readMotionCsv(
        file.path(),
        [&, chosen](const std::vector<std::string>& with_positions) {
          offered = with_positions;
          return chosen;
        },
        &unused);
  };
  const MotionTable one = choose({"a"});
  EXPECT_EQ(offered, (std::vector<std::string>{"c", "a", "b"}));
  EXPECT_EQ(one.joints, (std::vector<std::string>{"a"}));
  EXPECT_EQ(one.positions(0, 0), 1);
  EXPECT_EQ(one.velocities(0, 0), 4);
  EXPECT_EQ(unused, (std::vector<std::string>{"position.c", "position.b"}));
  const MotionTable none = choose({});
  EXPECT_TRUE(none.joints.empty());
  EXPECT_EQ(none.times.size(), 1u);
  EXPECT_EQ(none.positions.rows(), 1);
  EXPECT_EQ(none.positions.cols(), 0);
  EXPECT_FALSE(none.hasVelocities());
  EXPECT_EQ(unused.size(), 4u);
}

TEST(MotionCsv, SaysWhyAFileCannotBeRead) {
  const auto refusalOfPath = [](const std::string& path) -> std::string {
    try {
      readMotionCsv(path);
    } catch (const FileError& error) {
      return error.what();
    }
    return "(not refused)";
  };
  EXPECT_EQ(refusalOfPath("/nowhere/m.csv"),
            "/nowhere/m.csv: cannot be read: No such file or directory");
  EXPECT_EQ(refusalOfPath("/tmp"), "/tmp: cannot be read: Is a directory");
}

TEST(MotionCsv, EveryCellOfALargeFileEndsUpInItsPlace) {
  constexpr int kRows = 2000;
  constexpr int kJoints = 13;
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> number(-10, 10);
  std::vector<std::vector<double>> expected(kRows);
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "time";
  for (const char* kind : {"velocity", "position", "acceleration"}) {
    for (int joint = 0; joint < kJoints; ++joint) text << "," << kind << ".j" << joint;
  }
  for (int row = 0; row < kRows; ++row) {
    text << "\n" << row;
    for (int column = 0; column < 3 * kJoints; ++column) {
      expected[row].push_back(number(generator));
      text << "," << expected[row].back();
    }
  }
  const MotionTable table = read(text.str());
  ASSERT_EQ(table.times.size(), static_cast<std::size_t>(kRows));
  ASSERT_EQ(table.positions.cols(), kJoints);
  for (int row = 0; row < kRows; ++row) {
    EXPECT_EQ(table.times[row], row);
    for (int joint = 0; joint < kJoints; ++joint) {
      EXPECT_EQ(table.velocities(row, joint), expected[row][joint]);
      EXPECT_EQ(table.positions(row, joint), expected[row][kJoints + joint]);
      EXPECT_EQ(table.accelerations(row, joint), expected[row][2 * kJoints + joint]);
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
