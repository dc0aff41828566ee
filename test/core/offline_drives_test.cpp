// Drives and lengths of rams in the offline tool.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "offline_linkage.h"

namespace virtual_work_dynamics {
namespace {

// A plate of 1 kg on a guide, lifted by an actuator along it whose distance from the ground's
// marker grows steadily from 1 m on: Chrono's utest_JOINT_linactuator, whose data are of ADAMS.
constexpr char kLift[] = R"(<robot name="lift">
  <link name="ground_plate"/>
  <link name="plate"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="guide" type="prismatic"><parent link="ground_plate"/><child link="plate"/>
    <origin rpy="0 ANGLE 0"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
</robot>)";

constexpr char kLiftScene[] =
    "gravity: [0, 0, -9.80665]\nactuated: []\nmoments_about: [{name: guide, frame: parent}]\n"
    "cylinders: [{name: ram, link_a: ground_plate, link_b: plate, at_b: [0, 0, 1]}]\n";

// A slide and a hinge on it.
constexpr char kCart[] = R"(<robot name="cart">
  <link name="floor"/>
  <link name="cart"><inertial><mass value="3"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="bob"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
    <inertia ixx="0.03" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="floor"/><child link="cart"/>
    <axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="hinge" type="continuous"><parent link="cart"/><child link="bob"/>
    <axis xyz="0 1 0"/></joint>
</robot>)";

constexpr char kTilted[] = "0.7853981633974483";

class OfflineDrives : public OfflineLoops {
 protected:
  std::string results(const std::string& arguments) {
    const Run result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    notes_ = result.err;
    return result.out;
  }

  std::string wrong(const std::string& arguments, int exit_code = 1) {
    const Run result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.out, "");
    const std::string start = "inverse_dynamics_offline: error: ";
    // Of usage a second line tells more.
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), exit_code == 2 ? 2 : 1)
        << result.err;
    return result.err.substr(0, start.size()) == start ? result.err.substr(start.size())
                                                       : result.err;
  }

  void writeLift(const std::string& angle, const std::string& rest) {
    std::string urdf = kLift;
    write("lift.urdf", urdf.replace(urdf.find("ANGLE"), 5, angle));
    write("lift.yaml", kLiftScene + rest);
  }

  // A ram with a drive, and one whose length motions give.
  void writeDrivenAndGivenLift() {
    writeLift(kTilted, "drives: [{name: ram, law: polynomial, coefficients: [1, 0.5, 0.25]}]\n");
    write("given.yaml", kLiftScene);
  }

  // With a slide that moves as the columns of cartMotion() do.
  void writeCart() {
    write("cart.urdf", kCart);
    write("cart.yaml", "drives: [{name: slide, law: polynomial, coefficients: [1, 0.5, 0.25]}]\n");
  }

  static double at(const NumberTable& table, std::size_t row, const std::string& name) {
    const int column = table.column(name);
    EXPECT_GE(column, 0) << name;
    return table.rows.at(row).at(static_cast<std::size_t>(std::max(column, 0)));
  }

  std::string notes_;
};

// A row of the reference: forces of the actuator on the plate and of the plate on the guide, and
// the moment of the latter about the marker, N and N m, six digits.
struct AdamsRow {
  double time, actuator_x, actuator_z, guide_x, guide_z, guide_ty;
};
constexpr std::array<AdamsRow, 4> kAdams{{{0, 4.903325, 4.903325, 4.90332, -4.90332, 0},
                                          {0.29, 4.903325, 4.903325, 4.90332, -4.90332, 1.00548},
                                          {1.5, 4.903325, 4.903325, 4.90332, -4.90332, 5.20076},
                                          {2.8, 4.903325, 4.903325, 4.90332, -4.90332, 9.70809}}};

// Half a unit of the last of six digits.
void expectPrinted(double found, double printed) {
  const double unit =
      printed == 0 ? 1e-15 : std::pow(10, std::floor(std::log10(std::abs(printed))) - 5);
  // ADAMS cuts some digits off rather than rounding them.
  EXPECT_LE(std::abs(found - printed), 1.001 * unit) << found << " and " << printed;
}

TEST_F(OfflineDrives, LinearActuatorOfAdamsAtHalfAMetrePerSecond) {
  writeLift(kTilted, "drives: [{name: ram, law: polynomial, coefficients: [1, 0.5]}]\n");
  std::string motion = "time\n";
  for (const AdamsRow& row : kAdams) motion += numberText(row.time) + "\n";
  write("m.csv", motion);
  const NumberTable found =
      parseTable(results("--urdf lift.urdf --scene lift.yaml --motion m.csv --positions"));
  ASSERT_EQ(found.rows.size(), kAdams.size());
  for (std::size_t i = 0; i < kAdams.size(); ++i) {
    const AdamsRow& row = kAdams[i];
    EXPECT_NEAR(at(found, i, "position.guide"), 0.5 * row.time, 1e-14);
    EXPECT_NEAR(at(found, i, "velocity.guide"), 0.5, 1e-14);
    EXPECT_NEAR(at(found, i, "effort.ram"), 9.80665 * std::sqrt(0.5), 1e-12);
    expectPrinted(at(found, i, "reaction.ram.fx"), row.actuator_x);
    expectPrinted(at(found, i, "reaction.ram.fz"), row.actuator_z);
    expectPrinted(-at(found, i, "reaction.guide.fx"), row.guide_x);
    expectPrinted(-at(found, i, "reaction.guide.fz"), row.guide_z);
    expectPrinted(-at(found, i, "reaction.guide.ty"), row.guide_ty);
  }
}

TEST_F(OfflineDrives, LinearActuatorOfAdamsAtOneMetrePerSecond) {
  writeLift("0", "drives: [{name: ram, law: polynomial, coefficients: [1, 1]}]\n");
  write("m.csv", "time\n0\n2.5\n5\n");
  const NumberTable found =
      parseTable(results("--urdf lift.urdf --scene lift.yaml --motion m.csv --positions"));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(at(found, i, "position.guide"), 2.5 * static_cast<double>(i), 1e-14);
    expectPrinted(at(found, i, "reaction.ram.fz"), 9.80665);
    for (const char* none : {"fx", "fy", "fz", "tx", "ty", "tz"}) {
      EXPECT_NEAR(at(found, i, std::string("reaction.guide.") + none), 0, 1e-13);
    }
  }
}

// Dyadic numbers: the law and the columns have the same doubles.
std::string lengths(const std::string& header, bool closed_form) {
  std::string motion = header + "\n";
  for (int i = 0; i < 9; ++i) {
    const double t = i / 8.;
    motion += numberText(t);
    if (closed_form) {
      motion +=
          "," + numberText(1 + 0.5 * t + 0.25 * t * t) + "," + numberText(0.5 + 0.5 * t) + ",0.5";
    }
    motion += "\n";
  }
  return motion;
}

TEST_F(OfflineDrives, TheLengthOfARamMayStandInTheMotionInstead) {
  writeDrivenAndGivenLift();
  write("t.csv", lengths("time", false));
  write("l.csv", lengths("time,position.ram,velocity.ram,acceleration.ram", true));
  const std::string more = " --positions --certificates --method ";
  for (const std::string method : {"virtual_work", "lagrange"}) {
    const std::string driven =
        results("--urdf lift.urdf --scene lift.yaml --motion t.csv" + more + method);
    const std::string given =
        results("--urdf lift.urdf --scene given.yaml --motion l.csv" + more + method);
    EXPECT_EQ(driven, given);
    const NumberTable table = parseTable(driven);
    ASSERT_EQ(table.rows.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(at(table, i, "acceleration.guide"), 0.5, 1e-13);
      EXPECT_NEAR(at(table, i, "effort.ram"), 9.80665 * std::sqrt(0.5) + 0.5, 1e-12);
      EXPECT_LT(at(table, i, "certificate.power"), 1e-14);
    }
  }
  // What the motion says of what is driven is not used.
  const std::string both =
      results("--urdf lift.urdf --scene lift.yaml --motion l.csv --positions --certificates");
  EXPECT_EQ(both, results("--urdf lift.urdf --scene given.yaml --motion l.csv --positions "
                          "--certificates"));
}

// Joint states that a driver made, with a transducer's length and the pins' encoders, which jitter.
TEST_F(OfflineDrives, JointStatesHaveTheLengthsOfRamsOrTheirDrivesDo) {
  writeDrivenAndGivenLift();
  std::string both = "__time,/joint_states/ram/position,/joint_states/guide/position\n";
  std::string length = "__time,/joint_states/ram/position\n";
  for (int i = 0; i < 200; ++i) {
    const double t = i / 128.;
    const int ns = i * 7812500 % 1000000000;
    const std::string stamp =
        std::to_string(1600000000 + i / 128) + "." + std::to_string(1000000000 + ns).substr(1);
    const std::string ram = numberText(1 + 0.5 * t + 0.25 * t * t);
    length += stamp + "," + ram + "\n";
    both += stamp + "," + ram + "," + numberText(0.5 * t + (i % 2 ? 1e-3 : -1e-3)) + "\n";
  }
  write("ram.csv", length);
  write("both.csv", both);
  const NumberTable given =
      parseTable(results("--urdf lift.urdf --scene given.yaml --motion ram.csv --positions"));
  const NumberTable driven =
      parseTable(results("--urdf lift.urdf --scene lift.yaml --motion both.csv --positions"));
  ASSERT_EQ(given.rows.size(), 200u);
  ASSERT_EQ(driven.rows.size(), 200u);
  const double force = 9.80665 * std::sqrt(0.5) + 0.5;
  for (std::size_t i = 0; i < 200; ++i) {
    // Estimated, and near the ends from one side.
    EXPECT_NEAR(at(given, i, "effort.ram"), force, 1e-3) << i;
    EXPECT_NEAR(at(driven, i, "effort.ram"), force, 1e-12) << i;
    EXPECT_NEAR(at(driven, i, "position.guide"),
                at(driven, i, "time") * (0.5 + 0.25 * at(driven, i, "time")), 1e-13);
  }
}

std::string cartMotion(bool slide, bool rates, double off = 0) {
  std::string motion = "time,position.hinge";
  if (slide) motion += ",position.slide";
  if (rates) motion += ",velocity.hinge,acceleration.hinge";
  if (slide && rates) motion += ",velocity.slide,acceleration.slide";
  motion += "\n";
  for (int i = 0; i < 40; ++i) {
    const double t = i / 64.;
    motion += numberText(t) + "," + numberText(std::sin(3 * t));
    if (slide) motion += "," + numberText(1 + 0.5 * t + 0.25 * t * t + (i == 7 ? off : 0));
    if (rates)
      motion += "," + numberText(3 * std::cos(3 * t)) + "," + numberText(-9 * std::sin(3 * t));
    if (slide && rates) motion += "," + numberText(0.5 + 0.5 * t) + ",0.5";
    motion += "\n";
  }
  return motion;
}

TEST_F(OfflineDrives, AnOpenChainWithADrivenJoint) {
  writeCart();
  write("all.csv", cartMotion(true, true));
  write("hinge.csv", cartMotion(false, true));
  write("differs.csv", cartMotion(true, true, 0.25));
  const std::string expected =
      results("--urdf cart.urdf --motion all.csv --positions --certificates");
  EXPECT_EQ(notes_.find("drive"), std::string::npos);
  const std::string scene =
      "--urdf cart.urdf --scene cart.yaml --positions --certificates --motion ";
  EXPECT_EQ(results(scene + "hinge.csv"), expected);
  EXPECT_EQ(results(scene + "all.csv"), expected);
  EXPECT_NE(notes_.find("note: all.csv: the motion of 'slide' is not used, as it has a drive\n"),
            std::string::npos)
      << notes_;
  EXPECT_EQ(results(scene + "differs.csv"), expected);
  EXPECT_NE(notes_.find("note: differs.csv: the motion of 'slide' is not used, as it has a drive; "
                        "its positions differ by up to 0.25 m, line 9\n"),
            std::string::npos)
      << notes_;
}

TEST_F(OfflineDrives, EstimatesAreThoseOfTheOtherJoints) {
  writeCart();
  write("hinge.csv", cartMotion(false, false));
  write("both.csv", cartMotion(true, false));
  const std::string scene = "--urdf cart.urdf --scene cart.yaml --positions --motion ";
  const std::string hinge = results(scene + "hinge.csv");
  EXPECT_EQ(notes_.find("slide"), std::string::npos) << notes_;
  const NumberTable table = parseTable(hinge);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(at(table, i, "acceleration.slide"), 0.5);
    EXPECT_NE(at(table, i, "acceleration.hinge"), 0);
  }
  EXPECT_EQ(results(scene + "both.csv"), hinge);
  // The law is exact: only the hinge has errors.
  const NumberTable deviations = parseTable(results(scene + "hinge.csv --deviations"));
  for (std::size_t i = 0; i < 40; ++i) {
    const double deviation = at(deviations, i, "deviation.effort.slide");
    EXPECT_GE(deviation, 0);
    EXPECT_TRUE(std::isfinite(deviation));
  }
}

TEST_F(OfflineDrives, AMotionOfTimesAloneDrivesEverything) {
  write("crank.yaml",
        pinned("0.5", "") + "drives: [{name: drive, law: polynomial, coefficients: [0.25, 2]}]\n");
  std::string times = "time\n", all = kAllColumns;
  for (int i = 0; i < 17; ++i) {
    const double t = i / 8.;
    times += numberText(t) + "\n";
    all += row(t, {0.25 + 2 * t, 2, 0});
  }
  write("t.csv", times);
  write("all.csv", all);
  const NumberTable driven =
      parseTable(results("--urdf l.urdf --scene crank.yaml --motion t.csv --positions"));
  const NumberTable expected =
      parseTable(results("--urdf l.urdf --scene s.yaml --motion all.csv --positions"));
  ASSERT_EQ(driven.rows.size(), 17u);
  for (std::size_t i = 0; i < 17; ++i) {
    for (const char* name : {"position.elbow", "velocity.wrist", "acceleration.wrist",
                             "effort.drive", "reaction.pin.fx", "reaction.drive.fz"}) {
      EXPECT_NEAR(at(driven, i, name), at(expected, i, name), 1e-11 * 100) << name;
    }
  }
}

// Generated code knows no time.
TEST_F(OfflineDrives, GeneratedCodeTakesTheMotionOfWhatIsDriven) {
  write("cart.urdf", kCart);
  write("cart.yaml", "drives: [{name: slide, law: polynomial, coefficients: [1, 0.5]}]\n");
  results("--urdf cart.urdf --scene cart.yaml --generate cart.c");
  EXPECT_NE(notes_.find("note: --generate: the code takes the motion of all joints, driven ones, "
                        "too\n"),
            std::string::npos)
      << notes_;
  write("plain.yaml", "gravity: [0, 0, -9.81]\n");
  results("--urdf cart.urdf --scene plain.yaml --generate plain.c");
  EXPECT_EQ(notes_.find("driven"), std::string::npos) << notes_;
}

TEST_F(OfflineDrives, WhatIsWrongIsOneLine) {
  write("cart.urdf", kCart);
  const auto with = [&](const std::string& drive) {
    write("cart.yaml", "drives: [{name: slide, " + drive + "}]\n");
    return "--urdf cart.urdf --scene cart.yaml --motion all.csv ";
  };
  write("all.csv", cartMotion(false, true));
  EXPECT_EQ(wrong(with("law: table, times: [0, 0.25, 0.5], positions: [0, 1, 2]")),
            "all.csv: line 35: drives: 'slide' has no motion at 0.515625 s: it still moves when "
            "its function ends, at 0.5 s\n");
  EXPECT_EQ(wrong(with("law: polynomial, times: [0, 1], coefficients: [[0], [1]]")),
            "cart.yaml: drives: 'slide': position jumps by 1 rad or m at 1 s\n");
  EXPECT_EQ(wrong(with("law: polynomial, coefficients: [0]") + std::string("--rest slide=1"), 2)
                .find("--rest: 'slide' has a drive, which says how it moves"),
            0u);
  const std::string check =
      results(with("law: polynomial, coefficients: [0]") + std::string("--check"));
  EXPECT_NE(check.find("slide"), std::string::npos);
  EXPECT_NE(check.find("driven"), std::string::npos) << check;
}

}  // namespace
}  // namespace virtual_work_dynamics
