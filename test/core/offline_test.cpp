#include <gtest/gtest.h>
#include <signal.h>
#include <sys/types.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

// A closed form evaluated in double, against a recursion in double.
constexpr double kClosedForm = 1e-12;

constexpr char kSwing[] =
    "time,position.hinge,velocity.hinge,acceleration.hinge\n"
    "0,0,0,0\n0.1,0.3,-1.2,2.5\n0.2,-1.9,0.7,-3.25\n0.3,3.1,2,0.125\n";

constexpr char kCraneMotion[] =
    "time,position.slide,position.shoulder,velocity.slide,velocity.shoulder,acceleration.slide,"
    "acceleration.shoulder\n0,0.1,0.2,0.3,0.4,0.5,0.6\n0.5,-0.1,-0.2,1,2,3,4\n";

// The pendulum's effort and the wrench of the stand on the bob, in root axes.
struct PendulumTruth {
  PendulumTruth(double q, double qd, double qdd) {
    constexpr double kMass = 2, kLength = 0.5, kInertia = 0.03, kGravity = 9.81;
    const double s = std::sin(q), c = std::cos(q);
    effort = (kInertia + kMass * kLength * kLength) * qdd + kMass * kGravity * kLength * s;
    fx = kMass * kLength * (s * qd * qd - c * qdd);
    fz = kMass * (kLength * (c * qd * qd + s * qdd) + kGravity);
    child_fx = c * fx - s * fz;
    child_fz = s * fx + c * fz;
  }
  double effort, fx, fz, child_fx, child_fz;
};

void expectClose(double actual, double expected) {
  ASSERT_TRUE(std::isfinite(actual));
  EXPECT_LE(std::abs(actual - expected), kClosedForm * std::max(1.0, std::abs(expected)));
}

TEST_F(OfflineTool, PendulumMatchesItsClosedFormInRootAxes) {
  write("p.urdf", kPendulum);
  const NumberTable motion = parseTable(readFile(write("m.csv", kSwing)));
  const Run result = run("--urdf p.urdf --motion m.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // Its rows are positions here and there.
  EXPECT_EQ(
      result.err,
      "note: m.csv: whole turns that a driver left out are added to the positions of hinge\n");
  const NumberTable table = parseTable(result.out);
  EXPECT_EQ(table.header,
            (std::vector<std::string>{"time", "effort.hinge", "reaction.hinge.fx",
                                      "reaction.hinge.fy", "reaction.hinge.fz", "reaction.hinge.tx",
                                      "reaction.hinge.ty", "reaction.hinge.tz"}));
  ASSERT_EQ(table.rows.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<double>& row = table.rows[i];
    const PendulumTruth truth(motion.rows[i][1], motion.rows[i][2], motion.rows[i][3]);
    ASSERT_EQ(row.size(), 8u);
    EXPECT_EQ(row[0], motion.rows[i][0]);
    const double expected[] = {truth.effort, truth.fx, 0, truth.fz, 0, truth.effort, 0};
    for (std::size_t j = 0; j < 7; ++j) expectClose(row[j + 1], expected[j]);
  }
}

TEST_F(OfflineTool, ChildAxesAreThoseOfTheChildLink) {
  write("p.urdf", kPendulum);
  write("m.csv", kSwing);
  const Run result = run("--urdf p.urdf --motion m.csv --axes child");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  const PendulumTruth truth(0.3, -1.2, 2.5);
  ASSERT_EQ(table.rows.size(), 4u);
  expectClose(table.rows[1][2], truth.child_fx);
  expectClose(table.rows[1][4], truth.child_fz);
}

TEST_F(OfflineTool, OutputFileHoldsWhatStandardOutputWouldGet) {
  write("p.urdf", kPendulum);
  write("m.csv", kSwing);
  write("r.csv", "an older result");
  const Run to_output = run("--urdf p.urdf --motion m.csv");
  const Run to_file = run("--urdf=p.urdf --motion=m.csv --output=r.csv");
  EXPECT_EQ(to_file.exit_code, 0) << to_file.err;
  EXPECT_EQ(to_file.out, "");
  EXPECT_GT(to_output.out.size(), 100u);
  EXPECT_EQ(readFile(path("r.csv")), to_output.out);
  EXPECT_EQ(partialFile(folder()), "");
}

TEST_F(OfflineTool, ALinkToTheOutputStaysALink) {
  write("p.urdf", kPendulum);
  write("m.csv", kSwing);
  write("real.csv", "old");
  std::filesystem::create_symlink("real.csv", path("link.csv"));
  ASSERT_EQ(run("--urdf p.urdf --motion m.csv --output link.csv").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.csv")));
  EXPECT_EQ(readFile(path("real.csv")).substr(0, 5), "time,");
}

TEST_F(OfflineTool, DevicesAreWrittenToAndNotReplaced) {
  write("p.urdf", kPendulum);
  write("m.csv", kSwing);
  EXPECT_EQ(run("--urdf p.urdf --motion m.csv --output /dev/null").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(OfflineTool, ColumnOrderOfTheMotionDoesNotMatter) {
  write("c.urdf", kCrane);
  write("m.csv", kCraneMotion);
  write("shuffled.csv",
        "acceleration.shoulder,position.shoulder,velocity.slide,time,acceleration.slide,"
        "position.slide,velocity.shoulder\n.6,.2,.3,0,.5,.1,.4\n4,-0.2,1,0.5,3,-0.1,2\n");
  const Run result = run("--urdf c.urdf --motion m.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(run("--urdf c.urdf --motion shuffled.csv").out, result.out);
}

TEST_F(OfflineTool, ReactionsAreNamedInMechanismOrder) {
  write("c.urdf", kCrane);
  write("m.csv", kCraneMotion);
  const auto header = [&](const std::string& options) {
    const Run result = run("--urdf c.urdf --motion m.csv " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::string joints;
    for (const std::string& name : parseTable(result.out).header) {
      const bool first = name.size() > 3 && name.compare(name.size() - 3, 3, ".fx") == 0;
      if (first) joints += name.substr(9, name.size() - 12) + " ";
    }
    return joints;
  };
  EXPECT_EQ(header(""), "slide shoulder elbow ");
  EXPECT_EQ(header("--reactions all"), "slide shoulder elbow ");
  EXPECT_EQ(header("--reactions none"), "");
  EXPECT_EQ(header("--reactions 'flange, ground,slide'"), "ground slide flange ");
  EXPECT_EQ(header("--reactions=elbow --axes child"), "elbow ");
}

TEST_F(OfflineTool, GroundCarriesTheWeightOfARobotAtRest) {
  write("c.urdf", kCrane);
  write("m.csv", "time,position.slide,position.shoulder\n0,0.1,0.2\n");
  write("s.yaml", "motion: static\n");
  const Run result =
      run("--urdf c.urdf --motion m.csv --scene s.yaml --reactions ground --gravity '0 0 -10'");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  ASSERT_EQ(table.rows.size(), 1u);
  ASSERT_GE(table.column("reaction.ground.fz"), 0);
  expectClose(table.rows[0][static_cast<std::size_t>(table.column("reaction.ground.fz"))], 62.5);
  expectClose(table.rows[0][static_cast<std::size_t>(table.column("effort.slide"))], 62.5);
}

TEST_F(OfflineTool, TheCommandLineOverridesTheScene) {
  write("c.urdf", kCrane);
  write("m.csv", kCraneMotion);
  write("s.yaml", "gravity: [1, 2, 3]\nreactions: [elbow]\n");
  write("t.yaml", "gravity: [0, 0, -3.72]\nreactions: [ground, slide]\n");
  const std::string common = "--urdf c.urdf --motion m.csv ";
  const Run scene = run(common + "--scene t.yaml");
  const Run overridden =
      run(common + "--scene s.yaml --gravity '0 0 -3.72' --reactions slide,ground");
  ASSERT_EQ(scene.exit_code, 0) << scene.err;
  EXPECT_EQ(overridden.out, scene.out);
  EXPECT_NE(run(common + "--scene s.yaml").out, scene.out);
}

TEST_F(OfflineTool, MissingDerivativesAreEstimatedWithoutLag) {
  write("p.urdf", kPendulum);
  std::ostringstream csv;
  csv.precision(17);
  csv << "time,position.hinge\n";
  constexpr int kRows = 200;
  const auto q = [](double t) { return 0.8 * std::sin(3 * t); };
  for (int i = 0; i < kRows; ++i) csv << 0.01 * i << "," << q(0.01 * i) << "\n";
  write("m.csv", csv.str());
  const Run result = run("--urdf p.urdf --motion m.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err.find("note: m.csv: estimated: velocities, accelerations\n"
                            "note: m.csv: hinge: 100 Hz, position noise "),
            0u)
      << result.err;
  const NumberTable table = parseTable(result.out);
  ASSERT_EQ(table.rows.size(), static_cast<std::size_t>(kRows));
  // The smoother's error at the ends dies out over its time constants. A row of lag would err by
  // dt q''' = 0.2.
  constexpr double kTruncation = 1e-6;
  for (int i = 20; i + 20 < kRows; ++i) {
    const double t = 0.01 * i;
    const PendulumTruth truth(q(t), 2.4 * std::cos(3 * t), -7.2 * std::sin(3 * t));
    EXPECT_NEAR(table.rows[static_cast<std::size_t>(i)][1], truth.effort, kTruncation);
    EXPECT_NEAR(table.rows[static_cast<std::size_t>(i)][4], truth.fz, kTruncation);
  }
}

TEST_F(OfflineTool, StaticScenesNeedPositionsOnly) {
  write("p.urdf", kPendulum);
  write("m.csv", "time,position.hinge,velocity.hinge\n5,0.3,99\n5,-1,99\n");
  write("s.yaml", "motion: static\n");
  const Run result = run("--urdf p.urdf --motion m.csv --scene s.yaml");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const NumberTable table = parseTable(result.out);
  ASSERT_EQ(table.rows.size(), 2u);
  expectClose(table.rows[0][1], PendulumTruth(0.3, 0, 0).effort);
  expectClose(table.rows[1][1], PendulumTruth(-1, 0, 0).effort);
}

TEST_F(OfflineTool, ARobotWithoutMovableJointsNeedsTimesOnly) {
  write("f.urdf", R"(<robot name="frame"><link name="a"/>
    <link name="b"><inertial><mass value="2"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="weld" type="fixed"><parent link="a"/><child link="b"/></joint></robot>)");
  write("m.csv", "time\n0\n");
  for (const std::string method : {"virtual_work", "lagrange"}) {
    const Run result =
        run("--urdf f.urdf --motion m.csv --reactions weld --gravity '0 0 -10' --method " + method);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const NumberTable table = parseTable(result.out);
    ASSERT_EQ(table.rows.size(), 1u);
    ASSERT_EQ(table.rows[0].size(), 7u);
    expectClose(table.rows[0][3], 20);
  }
}

TEST_F(OfflineTool, ColumnsOfOtherJointsAreNamedAndIgnored) {
  write("p.urdf", kPendulum);
  write("m.csv",
        "time,position.hinge,velocity.hinge,acceleration.hinge,position.gripper,velocity.gripper,"
        "position.lid\n0,1,2,3,?,?,?\n");
  const Run result = run("--urdf p.urdf --motion m.csv");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err,
            "note: m.csv: ignored, not coordinates of the robot: 'gripper' and 'lid'; they are "
            "'hinge'\n");
}

TEST_F(OfflineTool, DoubtsAboutTheRobotAreWarnings) {
  write("c.urdf", kCrane);
  write("m.csv", kCraneMotion);
  const Run result = run("--urdf c.urdf --motion m.csv");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err.compare(0, 20, "warning: link 'tool'"), 0) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
}

TEST_F(OfflineTool, WhatOverflowsIsAnEmptyCellAndOneWarning) {
  write("p.urdf", kPendulum);
  write("m.csv",
        "# two of these overflow\ntime,position.hinge,velocity.hinge,acceleration.hinge\n"
        "0,1,0,0\n1,1,1e200,0\n2,1,-1e300,1e300\n");
  for (const std::string method : {"virtual_work", "lagrange"}) {
    const Run result = run("--urdf p.urdf --motion m.csv --method " + method);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(
        result.err,
        "warning: m.csv: results of 2 rows overflow, first in line 4; their cells are empty\n");
    const NumberTable table = parseTable(result.out);
    ASSERT_EQ(table.rows.size(), 3u);
    EXPECT_TRUE(std::isfinite(table.rows[0][2]));
    EXPECT_TRUE(std::isnan(table.rows[1][2]));
    EXPECT_TRUE(std::isnan(table.rows[2][2]));
    EXPECT_EQ(result.out.substr(result.out.find('\n')).find_first_of("nif"), std::string::npos);
  }
}

TEST_F(OfflineTool, CheckSaysWhatTheRobotIs) {
  write("c.urdf", kCrane);
  const Run result = run("--check --urdf c.urdf --reactions all");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  for (const char* line :
       {"robot:        crane\n", "links:        5, root base\n",
        "joints:       2 revolute, 1 prismatic, 1 fixed\n", "total mass:   6.25 kg\n",
        "mimic joints: elbow = -2 shoulder + 0.1\n", "coordinates:  2\n",
        "  slide     prismatic   m\n  shoulder  revolute    rad\n",
        "reactions:    slide, shoulder, elbow\n", "\nwarning: link 'tool'"}) {
    EXPECT_NE(result.out.find(line), std::string::npos) << line << "in\n" << result.out;
  }
}

TEST_F(OfflineTool, CheckReadsTheMotionToo) {
  write("c.urdf", kCrane);
  write("m.csv", kCraneMotion);
  write("bad.csv", "time,position.slide\n0,0\n");
  const Run good = run("--check --urdf c.urdf --motion m.csv --output r.csv");
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_NE(good.out.find("motion:       2 rows from 0 s to 0.5 s\n"), std::string::npos);
  EXPECT_FALSE(exists("r.csv"));
  EXPECT_EQ(run("--check --urdf c.urdf --motion bad.csv").exit_code, 1);
}

TEST_F(OfflineTool, CheckFailsARobotThatCannotRun) {
  write("c.urdf", kCrane);
  write("s.yaml", "strict_inertia: true\n");
  const Run strict = run("--check --urdf c.urdf --scene s.yaml");
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_NE(strict.out.find("warning: link 'tool'"), std::string::npos) << strict.out;
  EXPECT_NE(strict.err.find("tool"), std::string::npos) << strict.err;
  EXPECT_EQ(run("--check --urdf c.urdf --reactions elbo").exit_code, 1);
}

TEST_F(OfflineTool, HelpAndVersion) {
  const Run help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.err, "");
  for (const char* option :
       {"--urdf", "--motion", "--scene", "--gravity", "--axes", "--reactions", "--output",
        "--check", "--explain", "--threads", "--no-efforts", "--help", "--version", "Example"}) {
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
  }
  const Run version = run("--version");
  EXPECT_EQ(version.exit_code, 0);
  int parts[3] = {-1, -1, -1};
  EXPECT_EQ(std::sscanf(version.out.c_str(), "inverse_dynamics_offline %d.%d.%d\n", &parts[0],
                        &parts[1], &parts[2]),
            3)
      << version.out;
}

}  // namespace
}  // namespace virtual_work_dynamics
