#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "offline_tool.h"
#include "transmitting_robot.h"

namespace virtual_work_dynamics {
namespace {

// Roundings of some ten operations.
constexpr double kWritten = 1e-12;

class OfflineTransmissions : public OfflineTool {
 protected:
  static bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
};

TEST_F(OfflineTransmissions, EffortsAreThoseOfTheMotors) {
  write("r.urdf",
        transmittingRobot(transmissionText(
            "wrist", "transmission_interface/DifferentialTransmission",
            endText("joint", "pitch", "", "joint1") + endText("joint", "roll", "2", "joint2") +
                endText("actuator", "left", "10", "actuator1") +
                endText("actuator", "right", "10", "actuator2"))));
  write("s.yaml", "urdf_transmissions: [wrist]\n");
  std::string header = "time", first = "0", second = "0.1";
  for (const char* quantity : {"position", "velocity", "acceleration"}) {
    for (const char* joint : {"slide", "shoulder", "elbow", "pitch", "roll"}) {
      header += std::string(",") + quantity + "." + joint;
    }
    first += ",0.1,0.2,0.3,0.4,0.5";
    second += ",0.1,0.2,0.3,0.5,0.7";
  }
  write("m.csv", header + "\n" + first + "\n" + second + "\n");
  const Run joints = run("--urdf r.urdf --motion m.csv");
  ASSERT_EQ(joints.exit_code, 0) << joints.err;
  EXPECT_TRUE(says(joints.err, "urdf_transmissions in the scene says so")) << joints.err;
  const Run motors = run("--urdf r.urdf --motion m.csv --scene s.yaml --positions --certificates");
  ASSERT_EQ(motors.exit_code, 0) << motors.err;
  EXPECT_FALSE(says(motors.err, "is not read")) << motors.err;
  EXPECT_TRUE(says(motors.err,
                   "transmissions 'wrist' are read: efforts are those of their "
                   "actuators 'left' and 'right'"))
      << motors.err;
  const NumberTable before = parseTable(joints.out), after = parseTable(motors.out);
  ASSERT_EQ(after.rows.size(), 2u);
  const auto number = [](const NumberTable& table, std::size_t row, const std::string& name) {
    const int column = table.column(name);
    EXPECT_GE(column, 0) << name;
    return table.rows[row][static_cast<std::size_t>(std::max(column, 0))];
  };
  for (std::size_t row = 0; row < 2; ++row) {
    const double pitch = number(before, row, "effort.pitch");
    const double roll = number(before, row, "effort.roll") / 2;
    EXPECT_NEAR(number(after, row, "effort.left"), (pitch + roll) / 20, kWritten);
    EXPECT_NEAR(number(after, row, "effort.right"), (pitch - roll) / 20, kWritten);
    EXPECT_EQ(number(after, row, "effort.pitch"), 0);
    EXPECT_NEAR(number(after, row, "effort.elbow"), number(before, row, "effort.elbow"),
                100 * kWritten);
    EXPECT_LE(number(after, row, "certificate.power"), 1e-12);
  }
  EXPECT_NEAR(number(after, 1, "position.left"), 10 * (0.5 + 2 * 0.7), kWritten * 20);
  EXPECT_EQ(after.column("reaction.left.fx"), -1);
  EXPECT_GE(after.column("reaction.pitch.fx"), 0);
}

// Measured efforts of joints whose motors carry the load are compared with nothing.
TEST_F(OfflineTransmissions, MeasuredEffortsAreThoseOfTheMotors) {
  write("r.urdf", transmittingRobot(transmissionText(
                      "lead", "SimpleTransmission",
                      endText("joint", "slide", "") + endText("actuator", "spindle", "250"))));
  write("s.yaml", "urdf_transmissions: all\n");
  write("m.csv",
        "time,position.slide,position.shoulder,position.elbow,position.pitch,position.roll,"
        "effort.slide\n0,0,0,0,0,0,1\n0.1,0,0,0,0,0,1\n0.2,0,0,0,0,0,1\n");
  const Run refused = run("--urdf r.urdf --scene s.yaml --motion m.csv --residuals");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(says(refused.err,
                   "no measured effort is one of an actuator: they are of 'slide', and as "
                   "transmissions are read, those of "))
      << refused.err;
  EXPECT_TRUE(says(refused.err, "'spindle'")) << refused.err;
}

TEST_F(OfflineTransmissions, WhatIsWrongIsNamedWithTheScene) {
  write("r.urdf", transmittingRobot(""));
  write("s.yaml", "urdf_transmissions: all\n");
  const Run refused = run("--urdf r.urdf --scene s.yaml --check");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(says(refused.err, "s.yaml: urdf_transmissions: the description has none"))
      << refused.err;
}

// The pin that closes a four-bar linkage, geared to a motor: its axis has the columns of a joint.
TEST_F(OfflineTransmissions, AxesOfClosuresHaveColumns) {
  const auto link = [](const std::string& name) {
    return "<link name='" + name +
           "'><inertial><mass value='1'/><origin xyz='0.2 0 0'/><inertia ixx='1e-2' iyy='1e-2' "
           "izz='1e-2' ixy='0' ixz='0' iyz='0'/></inertial></link>";
  };
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child, const std::string& xyz) {
    return "<joint name='" + name + "' type='continuous'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='" + xyz + "'/><axis xyz='0 0 1'/></joint>";
  };
  // A parallelogram: the pin turns against the coupler as the crank does against the base.
  write("r.urdf", "<robot name='bars'><link name='base'/>" + link("crank") + link("coupler") +
                      link("rocker") + "<link name='rotor'/>" +
                      joint("crank", "base", "crank", "0 0 0") +
                      joint("knee", "crank", "coupler", "0.3 0 0") +
                      joint("rocker", "base", "rocker", "0.5 0 0") +
                      joint("motor", "base", "rotor", "0 1 0") + "</robot>");
  write("s.yaml",
        "closures: [{name: pin, type: revolute, parent: {link: coupler, xyz: [0.5, 0, 0]}, child: "
        "{link: rocker, xyz: [0.3, 0, 0]}}]\n"
        "assembly: [{name: crank, position: 1}, {name: knee, position: -1}, {name: rocker, "
        "position: 1}]\n"
        "couplings: [{name: gear, offset: 0, terms: [{name: motor, factor: 1}, {name: pin, factor: "
        "-30}]}]\nactuated: [motor]\ngiven: [pin]\n");
  write("m.csv", "time,position.pin,velocity.pin,acceleration.pin\n0,1,0.4,2\n0.1,1.1,0.5,1\n");
  const Run done =
      run("--urdf r.urdf --motion m.csv --scene s.yaml --positions --certificates --axes child");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const NumberTable table = parseTable(done.out);
  const auto number = [&](std::size_t row, const std::string& name) {
    const int column = table.column(name);
    EXPECT_GE(column, 0) << name;
    return table.rows[row][static_cast<std::size_t>(std::max(column, 0))];
  };
  for (std::size_t row = 0; row < 2; ++row) {
    const double angle = row == 0 ? 1 : 1.1, rate = row == 0 ? 2 : 1;
    EXPECT_NEAR(number(row, "position.crank"), angle, 1e-9);
    EXPECT_NEAR(number(row, "position.motor"), 30 * angle, 1e-8);
    // Crank and rocker turn about their ends, the coupler moves along with the crank's end.
    const double inertia = 2 * (0.01 + 0.04) + 0.09;
    EXPECT_NEAR(number(row, "effort.motor"), inertia * rate / 30, 1e-9);  // the axes are vertical
    EXPECT_EQ(number(row, "effort.pin"), 0);
    EXPECT_NEAR(number(row, "reaction.pin.tz"), -30 * number(row, "effort.gear"), 1e-9);
    EXPECT_EQ(table.column("reaction.pin.fixed.fx"), -1);
    EXPECT_LE(number(row, "certificate.power"), 1e-10);
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
