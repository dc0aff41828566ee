#include <gtest/gtest.h>

#include <string>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

// 10 kg, half a metre out on a beam that turns about y.
constexpr char kBeam[] = R"(<robot name="beam">
  <link name="base"/>
  <link name="beam"><inertial><origin xyz="0.5 0 0"/><mass value="10"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="pin" type="continuous"><parent link="base"/><child link="beam"/>
    <axis xyz="0 1 0"/></joint>
</robot>)";

class OfflineConditions : public OfflineTool {};

// At rest the cable holds 10 kg; accelerated downwards by more than gravity, the beam needs a push.
TEST_F(OfflineConditions, CablesThatWouldPushAreNamedInTheEnd) {
  write("r.urdf", kBeam);
  write(
      "s.yaml",
      "gravity: [0, 0, -10]\nactuated: []\ncylinders: [{name: cable, link_a: base, at_a: [0.5, 0, "
      "1], link_b: beam, at_b: [0.5, 0, 0], pulls_only: true}]\n");
  write("m.csv",
        "time,position.pin,velocity.pin,acceleration.pin\n0,0,0,0\n0.1,0,0,100\n0.2,0,0,90\n"
        "0.3,0,0,0\n");
  const Run result = run("--urdf r.urdf --scene s.yaml --motion m.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err,
            "warning: m.csv: the force of 'cable' would have to act the other way in 2 rows, first "
            "in line 3\n");
  const NumberTable table = parseTable(result.out);
  const int effort = table.column("effort.cable");
  ASSERT_GE(effort, 0);
  EXPECT_NEAR(table.rows.at(0).at(static_cast<std::size_t>(effort)), -100, 1e-10);
  // (1 + 10 0.25) kg m^2 100 rad/s^2 - 50 N m over a lever of 0.5 m, the other way.
  EXPECT_NEAR(table.rows.at(1).at(static_cast<std::size_t>(effort)), -100 + 350 / 0.5, 1e-10);
}

// Of contacts that nobody can tell of, a note says so.
TEST_F(OfflineConditions, WhatIsNotDecidableIsNoted) {
  write("r.urdf", kBeam);
  write("s.yaml",
        "gravity: [0, 0, -10]\nactuated: [pin]\ncontacts: [{name: rest, link: beam, at: [1, 0, 0], "
        "slip: all, plane: {link: base}}]\n");
  write("m.csv", "time,position.pin,velocity.pin,acceleration.pin\n0,0,0,0\n");
  const Run result = run("--urdf r.urdf --scene s.yaml --motion m.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err,
            "note: m.csv: the force of 'rest' is not determined, so that nothing can be said of it "
            "in 1 row, first in line 2\n");
}

constexpr char kSkate[] = R"(<robot name="skate">
  <link name="ice"/><link name="sledge"/><link name="cart"/>
  <link name="skate"><inertial><origin xyz="0 0 0"/><mass value="2"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="x" type="prismatic"><parent link="ice"/><child link="sledge"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" effort="9" velocity="9"/></joint>
  <joint name="y" type="prismatic"><parent link="sledge"/><child link="cart"/><axis xyz="0 1 0"/>
    <limit lower="-9" upper="9" effort="9" velocity="9"/></joint>
  <joint name="turn" type="continuous"><parent link="cart"/><child link="skate"/>
    <axis xyz="0 0 1"/></joint>
</robot>)";

// The blade tells nothing of positions, so that the motion gives them all, with rates that fit.
TEST_F(OfflineConditions, MotionsOfBladesGiveAllJoints) {
  write("r.urdf", kSkate);
  write("s.yaml",
        "actuated: [turn]\nfree_motion: true\nassembly: [{name: turn, position: "
        "1.57}]\nknife_edges: [{name: blade, link: skate, direction: "
        "[1, 0, 0], normal: false, plane: {link: ice}}]\n");
  const std::string names[] = {"x", "y", "turn"};
  std::string header = "time";
  for (const char* kind : {"position.", "velocity.", "acceleration."}) {
    for (const std::string& name : names) header += "," + std::string(kind) + name;
  }
  // On a circle of 2 m, at 2 m/s.
  header += "\n0,2,0,1.5707963267948966,0,2,1,-2,0,0\n";
  write("m.csv", header);
  const std::string command = "--urdf r.urdf --scene s.yaml --reactions blade --motion ";
  const Run result = run(command + "m.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  const auto cell = [&](const std::string& name) {
    const int column = table.column(name);
    EXPECT_GE(column, 0) << name;
    return column < 0 ? 1e9 : table.rows.at(0).at(static_cast<std::size_t>(column));
  };
  EXPECT_NEAR(cell("reaction.blade.fx"), -4, 1e-12);
  EXPECT_NEAR(cell("reaction.blade.fy"), 0, 1e-12);
  EXPECT_LE(cell("residual.velocity.blade"), 1e-15);
  // And then with 0.1 m/s across.
  write("across.csv", header + "0.1,2,0,1.5707963267948966,0.1,2,1,-2,0,0\n");
  const Run across = run(command + "across.csv");
  EXPECT_EQ(across.exit_code, 1);
  EXPECT_EQ(across.err,
            "inverse_dynamics_offline: error: across.csv: line 3: the velocities violate closure "
            "'blade' by 0.1 m/s or rad/s, 0.05 relative; the tolerance is 1e-06\n");
}

}  // namespace
}  // namespace virtual_work_dynamics
