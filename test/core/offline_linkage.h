#pragma once

#include <string>

#include "base/number_text.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {

/// A parallelogram in the plane of x and z: crank and rocker stand up at zero, the coupler lies on
/// both. All axes are along y, and the pin that closes the loop holds the rocker's foot.
constexpr char kLinkage[] = R"(<robot name="linkage">
  <link name="base"/>
  <link name="crank"><inertial><origin xyz="0 0 0.15"/><mass value="2"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="coupler"><inertial><origin xyz="0.25 0 0"/><mass value="3"/>
    <inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rocker"><inertial><origin xyz="0 0 -0.15"/><mass value="4"/>
    <inertia ixx="0.05" iyy="0.06" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="drive" type="continuous"><parent link="base"/><child link="crank"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="elbow" type="continuous"><parent link="crank"/><child link="coupler"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 1 0"/></joint>
  <joint name="wrist" type="continuous"><parent link="coupler"/><child link="rocker"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 1 0"/></joint>
</robot>)";

/// A scene with a pin at that distance from the crank's foot.
inline std::string pinned(const std::string& distance, const std::string& actuated = "drive") {
  return "closures:\n  - name: pin\n    type: revolute\n    parent: {link: base, xyz: [" +
         distance +
         ", 0, 0], rpy: [-1.5707963267948966, 0, 0]}\n"
         "    child: {link: rocker, xyz: [0, 0, -0.3], rpy: [-1.5707963267948966, 0, 0]}\n"
         "actuated: [" +
         actuated + "]\n";
}

struct LinkageState {
  double q, qd, qdd;
};

constexpr char kAllColumns[] =
    "time,position.drive,position.elbow,position.wrist,velocity.drive,velocity.elbow,"
    "velocity.wrist,acceleration.drive,acceleration.elbow,acceleration.wrist\n";

/// A line of these columns. The coupler does not turn, the rocker turns like the crank; the elbow
/// may be off by an angle.
inline std::string row(double time, const LinkageState& state, double off = 0) {
  const auto joints = [&](double value) {
    return "," + numberText(value) + "," + numberText(-value) + "," + numberText(value);
  };
  return numberText(time) + "," + numberText(state.q) + "," + numberText(-state.q + off) + "," +
         numberText(state.q) + joints(state.qd) + joints(state.qdd) + "\n";
}

/// Runs the tool on the linkage.
class OfflineLoops : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("l.urdf", kLinkage);
    write("s.yaml", pinned("0.5"));
  }

  NumberTable table(const std::string& arguments, const std::string& expected_notes) {
    const Run result = run("--urdf l.urdf " + arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, expected_notes);
    return parseTable(result.out);
  }

  /// The message of a run that must fail with nothing written, without the program's name.
  std::string failure(const std::string& arguments, int exit_code = 1) {
    write("r.csv", "kept");
    const Run result = run("--urdf l.urdf " + arguments + " --output r.csv");
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(readFile(path("r.csv")), "kept");
    EXPECT_EQ(partialFile(folder()), "");
    const std::string start = "inverse_dynamics_offline: error: ";
    const std::size_t found = result.err.find(start);
    if (found == std::string::npos) return "unexpected: " + result.err;
    const std::string line = result.err.substr(found + start.size());
    return line.substr(0, line.find('\n'));
  }

  static constexpr char kFollow[] =
      "note: m.csv: of passive joints, computed from the closures: positions, velocities, "
      "accelerations\n";
};

}  // namespace virtual_work_dynamics
