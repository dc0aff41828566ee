#include "offline_bags.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace virtual_work_dynamics {
namespace {

TEST_F(OfflineBags, HaveTheStampsAndPositionsThatRosbagWrote) {
  for (const char* compression : {"none.bag", "bz2.bag", "lz4.bag"}) {
    SCOPED_TRACE(compression);
    const Run result = positions(bag(compression));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "damaged"), 0) << result.err;
    expectRows(result.out, allMessages());
  }
}

TEST_F(OfflineBags, GiveTheResultsOfTheirMotionAsCsv) {
  std::ostringstream csv;
  csv.precision(17);
  csv << "time,position.hinge,velocity.hinge\n";
  for (int i = 0; i < kMessages; ++i) {
    csv << i / 100.0 << "," << positionOf(0, i) << "," << velocityOf(0, i) << "\n";
  }
  write("m.csv", csv.str());
  const Run expected = run("--urdf p.urdf --motion m.csv");
  const Run result = run("--urdf p.urdf --motion " + bag("none.bag"));
  ASSERT_EQ(expected.exit_code, 0) << expected.err;
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::string> a = linesOf(expected.out), b = linesOf(result.out);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::vector<std::string> cells = cellsOf(b[i]);
    cells.erase(cells.begin() + 1);  // the stamp
    if (i == 0) {
      EXPECT_EQ(cells, cellsOf(a[i]));
      continue;
    }
    const std::vector<std::string> wanted = cellsOf(a[i]);
    ASSERT_EQ(cells.size(), wanted.size());
    for (std::size_t k = 0; k < cells.size(); ++k) {
      // Python rounds squares once, the test twice.
      EXPECT_NEAR(std::stod(cells[k]), std::stod(wanted[k]), 1e-9) << "row " << i << " cell " << k;
    }
  }
}

TEST_F(OfflineBags, SplitInPartsAreOneMotion) {
  const Run result =
      positions(bag("part_2.bag") + " " + bag("part_0.bag") + " " + bag("part_1.bag"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<int> messages = allMessages();
  for (int& message : messages) message *= 10;  // so far apart that their order matters
  expectRows(result.out, messages);
}

TEST_F(OfflineBags, GiveTheTopicAskedFor) {
  const Run result = positions(bag("two_robots.bag") + " --topic /right/joint_states");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expectRows(result.out, allMessages(), 1);
}

TEST_F(OfflineBags, NameTheirTopicsWhereItIsNotClearWhichIsMeant) {
  const struct {
    std::string motion, message;
  } kCases[] = {
      {bag("two_robots.bag"),
       "has several topics of sensor_msgs/JointState, '/left/joint_states' and "
       "'/right/joint_states': --topic says which"},
      {bag("two_robots.bag") + " --topic /joint_states",
       "has no topic '/joint_states'; known are '/left/joint_states' and '/right/joint_states'"},
      {bag("two_robots.bag") + " --topic /note",
       "topic '/note' is of 'std_msgs/String', and a motion is read from sensor_msgs/JointState"},
      {bag("notes.bag"), "has no topic of sensor_msgs/JointState; its topics are '/note'"},
  };
  for (const auto& [motion, message] : kCases) {
    SCOPED_TRACE(motion);
    const Run result = positions(motion);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(OfflineBags, TakeJointsByNameInAnyOrderAndLeaveOtherMessagesOut) {
  const Run result = positions(bag("mixed.bag"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expectRows(result.out, allMessages());
  EXPECT_EQ(countLines(result.err, "40 messages not used, which have other joints only"), 1)
      << result.err;
}

TEST_F(OfflineBags, NameJointsThatNoMessageHasWithTheOthers) {
  std::string urdf = kPendulum;
  const std::string finger =
      R"(<link name="tip"/>
         <joint name="finger" type="continuous"><parent link="bob"/><child link="tip"/>
         </joint></robot>)";
  urdf.replace(urdf.find("</robot>"), 8, finger);
  write("f.urdf", urdf);
  const std::string arguments = "--urdf f.urdf --scene static.yaml --motion " + bag("mixed.bag");
  const Run apart = run(arguments);
  EXPECT_EQ(apart.exit_code, 1);
  EXPECT_NE(apart.err.find(
                "no message has all joints: those with the most lack 'finger', which others have"),
            std::string::npos)
      << apart.err;
  const Run nowhere = run("--urdf f.urdf --motion " + bag("none.bag"));
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_NE(nowhere.err.find("no message has 'finger'; they have 'hinge'"), std::string::npos)
      << nowhere.err;
  const Run resting = run(arguments + " --rest finger=0");
  EXPECT_EQ(resting.exit_code, 0) << resting.err;
  EXPECT_EQ(linesOf(resting.out).size(), kMessages + 1U);
}

TEST_F(OfflineBags, AreReadAsRostopicEchoesThem) {
  const Run result = positions(bag("echo.csv"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expectRows(result.out, allMessages());
  EXPECT_EQ(countLines(result.err, "40 messages not used, which have other joints only"), 1)
      << result.err;
  const std::string whole = readFile(bag("echo.csv"));
  const std::size_t stamp = whole.find("1600000000123456789");
  write("stamp.csv", whole.substr(0, stamp) + "now" + whole.substr(stamp + 19));
  EXPECT_NE(positions("stamp.csv").err.find("stamp.csv: line 2: 'now' is not a stamp"),
            std::string::npos);
  const std::string two_names = whole.substr(0, whole.rfind('\n', whole.size() - 2));
  write("cells.csv", two_names.substr(0, two_names.rfind(',')) + "\n");
  EXPECT_NE(positions("cells.csv").err.find("cells.csv: line 80: 2 names, but 5 values"),
            std::string::npos);
}

TEST_F(OfflineBags, AreReadAsPlotJugglerExportsThem) {
  // Series of other topics have other times, and their own cells in rows of their own.
  std::string csv =
      "__time,/joint_states/arm/position,/joint_states/hinge/effort,"
      "/joint_states/hinge/position,/joint_states/hinge/velocity,/tf/x\n";
  for (int i = 0; i < kMessages; ++i) {
    std::ostringstream row;
    row.precision(17);
    row << stampOf(i) << ",0.5,7," << positionOf(0, i) << "," << velocityOf(0, i) << ",\n"
        << stampOf(i).substr(0, 14) << "9999,,,,,3.5\n";
    csv += row.str();
  }
  write("juggled.csv", csv);
  const Run result = positions("juggled.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expectRows(result.out, allMessages());
  write("twice.csv", "__time,/a/hinge/position,/b/hinge/position\n1,2,3\n");
  EXPECT_NE(positions("twice.csv")
                .err.find("twice.csv: line 1: columns 2 and 3 are both the position of 'hinge'"),
            std::string::npos);
}

TEST_F(OfflineBags, HaveTheirJointsRenamed) {
  std::string urdf = kPendulum;
  urdf.replace(urdf.find("\"hinge\""), 7, "\"panda_joint7\"");
  write("r.urdf", urdf);
  const std::string arguments =
      "--urdf r.urdf --scene static.yaml --no-efforts --positions --motion ";
  const Run result =
      run(arguments + bag("none.bag") + " --rename 'x=y' --rename 'h(.)nge=" + "panda_jo\\1nt7'");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("position.panda_joint7"), std::string::npos) << result.out;
  write("m.csv", "time,position.fer_joint7,velocity.fer_joint7\n0,0.25,1\n1,0.5,1\n");
  const Run csv = run(arguments + "m.csv --rename 'fer_joint(.*)=panda_joint\\1'");
  EXPECT_EQ(csv.exit_code, 0) << csv.err;
  EXPECT_NE(csv.out.find("\n1,0.5,0,0\n"), std::string::npos) << csv.out;
  const Run whole = run(arguments + "m.csv --rename 'fer_joint=panda_joint7'");
  EXPECT_EQ(whole.exit_code, 1) << "a part of a name is not the name";
  for (const char* rule : {"'a(=b'", "a", "=b", "a="}) {
    const Run bad = run(arguments + "m.csv --rename " + rule);
    EXPECT_EQ(bad.exit_code, 2) << rule;
    EXPECT_EQ(countLines(bad.err, "error: --rename: "), 1) << bad.err;
  }
}

TEST_F(OfflineBags, HaveAnglesInDegreesAndSlidesInMetres) {
  write("crane.urdf", kCrane);
  write("m.csv",
        "time,position.shoulder,position.slide,velocity.shoulder,velocity.slide,"
        "acceleration.shoulder,acceleration.slide\n0,90,0.5,180,0.25,-360,1\n");
  const Run result =
      run("--urdf crane.urdf --motion m.csv --degrees --no-efforts --reactions none"
          " --positions");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  ASSERT_EQ(table.rows.size(), 1U);
  const double pi = std::acos(-1.0);
  const std::pair<const char*, double> wanted[] = {
      {"position.shoulder", pi / 2}, {"velocity.shoulder", pi}, {"acceleration.shoulder", -2 * pi},
      {"position.slide", 0.5},       {"velocity.slide", 0.25},  {"acceleration.slide", 1}};
  for (const auto& [name, value] : wanted) {
    const int column = table.column(name);
    ASSERT_GE(column, 0) << name;
    EXPECT_NEAR(table.rows[0][static_cast<std::size_t>(column)], value, 1e-14) << name;
  }
}

TEST_F(OfflineBags, SayWhatElseAFileIs) {
  const std::string whole = readFile(bag("none.bag"));
  const struct {
    std::string content, message;
  } kCases[] = {
      {"#ROSBAG V1.2\n" + whole.substr(13),
       "m.bag: is a bag of 'ROSBAG V1.2', and only format 2.0 is read; rosbag fix converts it"},
      {"#ROSBAG V2.0\n", "m.bag: is cut off before its first message"},
      {whole.substr(0, 2000), "m.bag: is cut off before its first message"},
      {std::string("\x89MCAP0\r\n", 8), "is a recording of ROS 2, and only bags of ROS 1 are read"},
      {std::string("SQLite format 3\0", 16), "is a recording of ROS 2"},
      {whole.substr(0, 4117), "m.bag: has no topic of sensor_msgs/JointState"},
  };
  for (const auto& [content, message] : kCases) {
    SCOPED_TRACE(message);
    copy("m.bag", content);
    const Run result = positions("m.bag");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
  }
  write("m.csv", "time,position.hinge\n0,0\n");
  const Run csv = positions("m.csv --topic /joint_states");
  EXPECT_EQ(csv.exit_code, 1);
  EXPECT_NE(csv.err.find("m.csv: is not a bag, and --topic is the topic of one"), std::string::npos)
      << csv.err;
}

}  // namespace
}  // namespace virtual_work_dynamics
