#include <gtest/gtest.h>

#include <cmath>

#include "offline_linkage.h"

namespace virtual_work_dynamics {
namespace {

// A closed form evaluated in double against a recursion and a least-squares solution in double.
constexpr double kClosedForm = 1e-12;
// Residuals of a completed motion: Newton's method goes on to rounding, here of numbers near one.
constexpr double kClosed = 1e-13;
// Some thousand turns and the rounding of angles there, relative to numbers of some hundred.
constexpr double kWrapped = 1e-9;

// Drive's effort, and the force of the base on the rocker in root axes.
struct LinkageTruth {
  LinkageTruth(double q, double qd, double qdd) {
    constexpr double kGravity = 9.81, kLength = 0.3;
    constexpr double kCrank = 2, kCoupler = 3, kRocker = 4;
    constexpr double kCrankInertia = 0.03 + kCrank * 0.15 * 0.15;
    constexpr double kRockerInertia = 0.06 + kRocker * 0.15 * 0.15;  // both about their feet
    const double s = std::sin(q), c = std::cos(q);
    // Acceleration of the coupler, which moves in a circle without turning.
    const double ax = kLength * (c * qdd - s * qd * qd), az = -kLength * (s * qdd + c * qd * qd);
    effort = (kCrankInertia + kRockerInertia + kCoupler * kLength * kLength) * qdd -
             kGravity * kLength * (kCrank / 2 + kCoupler + kRocker / 2) * s;
    // Force of the coupler on the rocker: half of the coupler's vertical force; the rocker turns
    // freely.
    const double z = -kCoupler * (kGravity + az) / 2;
    const double x =
        (kRockerInertia * qdd - kLength / 2 * kRocker * kGravity * s + kLength * s * z) /
        (kLength * c);
    fx = kRocker * ax / 2 - x;
    fz = kRocker * (az / 2 + kGravity) - z;
  }
  double effort, fx, fz;
};

constexpr LinkageState kStates[] = {{0, 0, 0}, {0.3, -1.2, 2.5}, {-0.8, 3, -1}, {1.2, 0.5, 7}};

std::string driveMotion() {
  std::string text = "time,position.drive,velocity.drive,acceleration.drive\n";
  double time = 0;
  for (const LinkageState& state : kStates) {
    text += numberText(time) + "," + numberText(state.q) + "," + numberText(state.qd) + "," +
            numberText(state.qdd) + "\n";
    time += 0.1;
  }
  return text;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

void expectClose(double actual, double expected, double tolerance = kClosedForm) {
  ASSERT_TRUE(std::isfinite(actual));
  EXPECT_LE(std::abs(actual - expected), tolerance * std::max(1.0, std::abs(expected)));
}

TEST_F(OfflineLoops, ALinkageMatchesItsClosedForm) {
  write("m.csv", driveMotion());
  const NumberTable results = table("--scene s.yaml --motion m.csv", kFollow);
  ASSERT_EQ(results.rows.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto at = [&](const std::string& name) {
      const int column = results.column(name);
      EXPECT_GE(column, 0) << name;
      return results.rows[i][static_cast<std::size_t>(std::max(column, 0))];
    };
    const LinkageTruth truth(kStates[i].q, kStates[i].qd, kStates[i].qdd);
    expectClose(at("effort.drive"), truth.effort);
    EXPECT_EQ(at("effort.elbow"), 0);
    EXPECT_EQ(at("effort.wrist"), 0);
    expectClose(at("reaction.pin.fx"), truth.fx);
    expectClose(at("reaction.pin.fz"), truth.fz);
    expectClose(at("reaction.pin.ty"), 0);
    expectClose(at("reaction.drive.ty"), truth.effort);
    // All hinges are parallel: what is out of the plane is not determined.
    for (const std::string name : {"drive", "elbow", "wrist", "pin"}) {
      EXPECT_EQ(at("determined." + name + ".fx"), 1);
      EXPECT_EQ(at("determined." + name + ".fy"), 0);
      EXPECT_EQ(at("determined." + name + ".fz"), 1);
      EXPECT_EQ(at("determined." + name + ".tx"), 0);
      EXPECT_EQ(at("determined." + name + ".ty"), 1);
      EXPECT_EQ(at("determined." + name + ".tz"), 0);
      EXPECT_TRUE(std::isfinite(at("reaction." + name + ".fy"))) << "by the policy";
    }
    for (const std::string name : {"drive", "elbow", "wrist"}) {
      EXPECT_EQ(at("determined.effort." + name), 1);
    }
    for (const std::string level : {"position", "velocity", "acceleration"}) {
      expectClose(at("residual." + level + ".pin"), 0, 10 * kClosed);
    }
  }
}

TEST_F(OfflineLoops, ColumnsFollowWhatIsAskedFor) {
  write("m.csv", driveMotion());
  const auto header = [&](const std::string& options) {
    std::string text;
    for (const std::string& name :
         table("--scene s.yaml --motion m.csv " + options, kFollow).header)
      text += name + " ";
    return text;
  };
  EXPECT_EQ(header("--reactions none"),
            "time effort.drive effort.elbow effort.wrist determined.effort.drive "
            "determined.effort.elbow determined.effort.wrist residual.position.pin "
            "residual.velocity.pin residual.acceleration.pin ");
  EXPECT_EQ(header("--reactions pin --no-efforts --axes child"),
            "time reaction.pin.fx reaction.pin.fy reaction.pin.fz reaction.pin.tx reaction.pin.ty "
            "reaction.pin.tz determined.pin.fx determined.pin.fy determined.pin.fz "
            "determined.pin.tx determined.pin.ty determined.pin.tz residual.position.pin "
            "residual.velocity.pin residual.acceleration.pin ");
  EXPECT_TRUE(contains(header("--reactions all"), " reaction.wrist.tz reaction.pin.fx "));
}

// The flat parallelogram: nothing that the drive does holds it there.
TEST_F(OfflineLoops, TheLargestConditionIsToldWithItsTime) {
  const double flat = std::acos(0.0);
  write("m.csv", kAllColumns + row(0.5, {0.3, 0, 0}) + row(0.75, {flat - 1e-6, 0, 0}) +
                     row(1, {flat - 1e-3, 0, 0}) + row(1.25, {flat - 2e-6, 0, 0}));
  const Run checked = run("--urdf l.urdf --scene s.yaml --motion m.csv --check");
  const std::size_t found = checked.out.find("closed loops: condition ");
  ASSERT_NE(found, std::string::npos) << checked.out << checked.err;
  const double condition = std::stod(checked.out.substr(found + 24));
  EXPECT_GT(condition, 1e5);
  EXPECT_LT(condition, 1e8);
  EXPECT_TRUE(contains(checked.out, " at worst, line 3, at 0.75 s\n")) << checked.out;
  const Run result = run("--urdf l.urdf --scene s.yaml --motion m.csv");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.err, "warning: m.csv: 2 rows close to singular positions, condition"))
      << result.err;
}

TEST_F(OfflineLoops, AMotionOfAllJointsGivesTheSame) {
  write("m.csv", driveMotion());
  std::string text = kAllColumns;
  for (const LinkageState& state : kStates) text += row(0.1 * (&state - kStates), state);
  write("all.csv", text);
  const NumberTable all = table("--scene s.yaml --motion all.csv", "");
  const NumberTable completed = table("--scene s.yaml --motion m.csv", kFollow);
  EXPECT_EQ(all.header, completed.header);
  ASSERT_EQ(all.rows.size(), completed.rows.size());
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    for (std::size_t j = 1; j < all.header.size(); ++j) {
      expectClose(all.rows[i][j], completed.rows[i][j], 10 * kClosedForm);
    }
  }
}

TEST_F(OfflineLoops, TheMechanismStaysOnItsBranch) {
  // Far from one row to the next, and with the jumps of a driver that wraps: a linkage that is
  // closed from the row before in one step would turn inside out.
  std::string far = "time,position.drive,velocity.drive,acceleration.drive\n";
  std::string all = kAllColumns;
  const LinkageState states[] = {{1.3, 1, 2}, {-1.4, -2, 3}, {1.2, 0, 0}, {-0.2, 4, 1}};
  double time = 0;
  for (const LinkageState& state : states) {
    far += numberText(time) + "," + numberText(state.q + 6283.185307179586 * (1 + time)) + "," +
           numberText(state.qd) + "," + numberText(state.qdd) + "\n";
    all += row(time, state);
    time += 1;
  }
  write("m.csv", far);
  write("all.csv", all);
  const NumberTable of_drive = table(
      "--scene s.yaml --motion m.csv",
      "note: m.csv: whole turns that a driver left out are added to the positions of drive\n" +
          std::string(kFollow));
  const NumberTable of_all = table("--scene s.yaml --motion all.csv", "");
  ASSERT_EQ(of_drive.rows.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 1; j < of_all.header.size(); ++j) {
      expectClose(of_drive.rows[i][j], of_all.rows[i][j], kWrapped);
    }
  }
}

TEST_F(OfflineLoops, AStaticSceneTakesPositionsOnly) {
  write("static.yaml", pinned("0.5") + "motion: static\n");
  write("m.csv", "time,position.drive\n0,0.3\n");
  const NumberTable results =
      table("--scene static.yaml --motion m.csv",
            "note: m.csv: of passive joints, computed from the closures: positions\n");
  const LinkageTruth truth(0.3, 0, 0);
  expectClose(results.rows.at(0).at(1), truth.effort);
  expectClose(results.rows[0][static_cast<std::size_t>(results.column("reaction.pin.fz"))],
              truth.fz);
}

TEST_F(OfflineLoops, DerivativesThatAreMissingKeepTheLoopsClosed) {
  std::string all = "time,position.wrist,position.drive,position.elbow\n";
  std::string drive = "time,position.drive\n";
  for (int i = 0; i < 30; ++i) {
    const double time = 0.01 * i, q = 0.7 * std::sin(5 * time);
    all +=
        numberText(time) + "," + numberText(q) + "," + numberText(q) + "," + numberText(-q) + "\n";
    drive += numberText(time) + "," + numberText(q) + "\n";
  }
  write("all.csv", all);
  write("m.csv", drive);
  const auto estimated = [this](const std::string& file, const std::string& last) {
    const Run result = run("--urdf l.urdf --scene s.yaml --motion " + file);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string first = "note: " + file + ": estimated: velocities, accelerations\n";
    EXPECT_EQ(result.err.find(first), 0u) << result.err;
    EXPECT_EQ(result.err.find(last, result.err.rfind("note: ")), result.err.rfind("note: "))
        << result.err;
    const NumberTable rows = parseTable(result.out);
    for (const std::string level : {"position", "velocity", "acceleration"}) {
      const auto column = static_cast<std::size_t>(rows.column("residual." + level + ".pin"));
      for (const auto& row : rows.rows) EXPECT_LE(std::abs(row[column]), 1e-12) << level;
    }
    return rows;
  };
  const NumberTable of_all =
      estimated("all.csv", "note: all.csv: 30 rows fitted to closures and couplings\n");
  const NumberTable of_drive = estimated("m.csv", kFollow);
  ASSERT_EQ(of_all.rows.size(), 30u);
  ASSERT_EQ(of_drive.rows.size(), 30u);
  const auto effort = static_cast<std::size_t>(of_all.column("effort.drive"));
  // The roundings of three columns in place of one, in estimates at 100 Hz.
  constexpr double kRoundings = 1e-8;
  for (std::size_t i = 0; i < 30; ++i) {
    expectClose(of_all.rows[i][effort], of_drive.rows[i][effort], kRoundings);
  }
}

// Components of reactions; the linkage moves in the plane of x and z.
bool isOutOfPlane(const std::string& column) {
  const std::string component = column.substr(column.size() - 2);
  return component == "fy" || component == "tx" || component == "tz";
}

// What is redundant in every position has the policy's value in singular ones, too.
TEST_F(OfflineLoops, SingularPositionsLeaveOutWhatTheyLeaveOpen) {
  // Crank, coupler and rocker in one line: the coupler could go on turning either way.
  const LinkageState dead{1.5707963267948966, 0, 0};
  write("all.csv", kAllColumns + row(0, kStates[1]) + row(0.1, dead) + row(0.2, kStates[3]));
  const NumberTable results =
      table("--scene s.yaml --motion all.csv",
            "warning: all.csv: 1 row in singular positions, first in line 3; cells of results "
            "without a value there are empty\n");
  ASSERT_EQ(results.rows.size(), 3u);
  int left_out = 0, redundant = 0;
  for (std::size_t j = 0; j < results.header.size(); ++j) {
    EXPECT_TRUE(std::isfinite(results.rows[0][j])) << results.header[j];
    EXPECT_TRUE(std::isfinite(results.rows[2][j])) << results.header[j];
    const std::string& name = results.header[j];
    if (name.compare(0, 7, "effort.") != 0 && name.compare(0, 9, "reaction.") != 0) continue;
    const std::string flag =
        "determined." + (name[0] == 'e' ? name : name.substr(std::string("reaction.").size()));
    ASSERT_GE(results.column(flag), 0) << flag;
    const auto column = static_cast<std::size_t>(results.column(flag));
    const bool determined = results.rows[1][column] == 1, usually = results.rows[0][column] == 1;
    EXPECT_EQ(results.rows[2][column] == 1, usually) << name;
    EXPECT_EQ(std::isfinite(results.rows[1][j]), determined || !usually) << name;
    left_out += !determined && usually;
    redundant += !usually;
    EXPECT_EQ(usually, !(name[0] == 'r' && isOutOfPlane(name))) << name;
  }
  EXPECT_GT(left_out, 0);
  EXPECT_EQ(redundant, 12) << "three components of four joints are never determined";
}

TEST_F(OfflineLoops, AnActuatedClosureHasAnEffort) {
  write("m.csv", driveMotion());
  write("s.yaml", pinned("0.5", "pin"));
  std::string text = kAllColumns;
  for (const LinkageState& state : kStates) text += row(0.1 * (&state - kStates), state);
  write("all.csv", text);
  const NumberTable results = table("--scene s.yaml --motion all.csv", "");
  ASSERT_GE(results.column("effort.pin"), 0);
  ASSERT_GE(results.column("determined.effort.pin"), 0);
  for (std::size_t i = 0; i < 4; ++i) {
    // The rocker turns as fast as the crank.
    const LinkageTruth truth(kStates[i].q, kStates[i].qd, kStates[i].qdd);
    expectClose(results.rows[i][static_cast<std::size_t>(results.column("effort.pin"))],
                truth.effort);
    EXPECT_EQ(results.rows[i][static_cast<std::size_t>(results.column("effort.drive"))], 0);
    EXPECT_EQ(results.rows[i][static_cast<std::size_t>(results.column("determined.effort.pin"))],
              1);
  }
  // The drive determines the others although the pin is what is actuated.
  const NumberTable of_drive = table("--scene s.yaml --motion m.csv",
                                     "note: m.csv: of elbow, wrist, computed from the closures: "
                                     "positions, velocities, accelerations\n");
  expectClose(of_drive.rows.at(1)[static_cast<std::size_t>(of_drive.column("effort.pin"))],
              LinkageTruth(kStates[1].q, kStates[1].qd, kStates[1].qdd).effort);
}

TEST_F(OfflineLoops, SpringsBetweenLinksNeedNoClosure) {
  write("p.urdf", kPendulum);
  write("spring.yaml",
        "springs: [{name: s, link_a: stand, at_a: [0.5, 0, 1], link_b: bob, at_b: [0, 0, -0.5], "
        "stiffness: 100, rest_length: 0.2}]\n");
  write("p.csv", "time,position.hinge,velocity.hinge,acceleration.hinge\n0,0.4,-3,2\n");
  const Run result = run("--urdf p.urdf --scene spring.yaml --motion p.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const NumberTable results = parseTable(result.out);
  // The bob's end, from the hinge, and the pull towards the stand's point half a metre beside it.
  const double x = -0.5 * std::sin(0.4), z = -0.5 * std::cos(0.4);
  const double length = std::hypot(0.5 - x, z), pull = 100 * (length - 0.2);
  const double moment = (z * (0.5 - x) + x * z) / length * pull;
  expectClose(results.rows.at(0).at(1),
              (0.03 + 2 * 0.25) * 2 + 2 * 9.81 * 0.5 * std::sin(0.4) - moment);
  EXPECT_EQ(results.header.size(), 1u + 7u + 7u);
  for (std::size_t j = 8; j < 15; ++j) EXPECT_EQ(results.rows[0][j], 1) << results.header[j];
}

TEST_F(OfflineLoops, CheckTellsOfTheLoops) {
  write("m.csv", driveMotion());
  const Run result = run("--urdf l.urdf --scene s.yaml --check --motion m.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, kFollow);
  for (const char* line :
       {"closures:     pin (revolute, base to rocker)\n", "springs:      none\n",
        "actuated:     drive\n", "passive:      elbow, wrist\n", "  degrees of freedom: 1\n",
        "  conditions of the closures: 5\n", "  redundant constraints: 3\n",
        "undetermined: drive (fy tx tz), elbow (fy tx tz), wrist (fy tx tz), pin (fy tx tz)\n",
        "reactions:    drive, elbow, wrist, pin\n", "motion:       4 rows from 0 s to ",
        "The robot can run.\n"}) {
    EXPECT_TRUE(contains(result.out, line)) << line << "in\n" << result.out;
  }
}

TEST_F(OfflineLoops, ExplainSaysThatLoopsAreSolved) {
  const Run result = run("--urdf l.urdf --scene s.yaml --explain");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "multiplications")) << result.out;
  EXPECT_TRUE(
      contains(result.out, "closed loops are solved, sample by sample: 5 conditions of 1 closure"))
      << result.out;
}

// Where the ends of a spring meet, its force has no direction, and what it reaches no value.
TEST_F(OfflineLoops, SpringsWithoutDirectionLeaveOutWhatTheyReach) {
  write("spring.yaml",
        pinned("0.5") +
            "springs:\n  - {name: s, link_a: base, at_a: [0, 0, 0.3], link_b: coupler, "
            "at_b: [0, 0, 0], stiffness: 100, rest_length: 0.1}\n");
  write("all.csv", kAllColumns + row(0, kStates[1]) + row(0.1, {0, 0, 0}));
  const NumberTable results =
      table("--scene spring.yaml --motion all.csv",
            "warning: all.csv: the ends of a spring meet in 1 row, first in line 3, so that its "
            "force has no direction; cells of results that it reaches are empty\n");
  ASSERT_EQ(results.rows.size(), 2u);
  for (std::size_t j = 0; j < results.header.size(); ++j) {
    const std::string& name = results.header[j];
    EXPECT_TRUE(std::isfinite(results.rows[0][j])) << name;
    const bool reached =
        name.compare(0, 7, "effort.") == 0 ||
        (name.compare(0, 9, "reaction.") == 0 && name.find(".ground.") == std::string::npos);
    EXPECT_EQ(std::isfinite(results.rows[1][j]), !reached) << name;
  }
}

// The start may have been meant for another branch.
TEST_F(OfflineLoops, JointsThatAreAssembledFarFromTheirStartAreNamed) {
  write("far.yaml", pinned("0.5") + "assembly:\n  - {name: elbow, position: 3}\n");
  write("all.csv", kAllColumns + row(0, kStates[1]));
  write("m.csv", driveMotion());
  for (const char* arguments : {"--scene far.yaml --motion m.csv", "--scene far.yaml --check"}) {
    const Run result = run(std::string("--urdf l.urdf ") + arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(contains(result.out + result.err, "warning: assembly: 'elbow' ends "))
        << result.err;
    EXPECT_TRUE(contains(result.out + result.err, " rad from its start, at ")) << result.err;
  }
  EXPECT_FALSE(contains(run("--urdf l.urdf --scene s.yaml --motion m.csv").err, "assembly"));
  // A motion of all joints says itself where they start.
  EXPECT_FALSE(contains(run("--urdf l.urdf --scene far.yaml --motion all.csv").err, "assembly"));
}

}  // namespace
}  // namespace virtual_work_dynamics
