#include <gtest/gtest.h>

#include <string>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

// A crank on a slider, so that there are several names, closures among them.
constexpr char kLinkage[] = R"(<robot name="linkage">
  <link name="base"/>
  <link name="carriage"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="crank_arm"><inertial><origin xyz="0.1 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rod"><inertial><origin xyz="0.2 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slider" type="prismatic"><parent link="base"/><child link="carriage"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="crank" type="revolute"><parent link="base"/><child link="crank_arm"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="knee" type="continuous"><parent link="crank_arm"/><child link="rod"/>
    <origin xyz="0.2 0 0"/><axis xyz="0 0 1"/></joint>
</robot>)";

class OfflineToolNames : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("linkage.urdf", kLinkage);
  }

  // The line of a run that must fail, without what begins every line.
  std::string failure(const std::string& arguments, int exit_code = 1) {
    const Run result = run("--urdf linkage.urdf " + arguments);
    EXPECT_EQ(result.exit_code, exit_code) << arguments;
    const std::string start = "inverse_dynamics_offline: error: ";
    EXPECT_EQ(result.err.substr(0, start.size()), start);
    const std::string line = result.err.substr(start.size(), result.err.find('\n') - start.size());
    EXPECT_EQ(
        result.err.size(),
        start.size() + line.size() + 1 +
            (exit_code == 2 ? std::string("Try 'inverse_dynamics_offline --help'.\n").size() : 0))
        << result.err;
    return line;
  }

  std::string scene(const std::string& yaml) {
    write("s.yaml", yaml);
    return failure("--check --scene s.yaml");
  }
};

TEST_F(OfflineToolNames, AJointMayHaveTheNameOfAResidual) {
  std::string description = kLinkage;
  for (std::size_t at; (at = description.find("\"knee\"")) != std::string::npos;) {
    description.replace(at, 6, "\"residual.motion.k\"");
  }
  write("named.urdf", description);
  std::string header = "time", row = "0";
  for (const char* level : {"position", "velocity", "acceleration"}) {
    for (const char* joint : {"slider", "crank", "residual.motion.k"}) {
      header += std::string(",") + level + "." + joint;
      row += ",0";
    }
  }
  write("m.csv", header + "\n" + row + "\n");
  const Run result = run("--urdf named.urdf --motion m.csv --output r.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string table = readFile(path("r.csv"));
  const std::string efforts = "time,effort.crank,effort.residual.motion.k,effort.slider,reaction.";
  EXPECT_EQ(table.substr(0, efforts.size()), efforts);
}

TEST_F(OfflineToolNames, AMisspeltNameHasFileAndKeyInFrontAndTheNearestBehind) {
  EXPECT_EQ(scene("reactions: [crank, knee, slidr]"),
            "s.yaml: reactions[2]: no joint 'slidr'; did you mean 'slider'?");
  EXPECT_EQ(scene("reactions: [elbow]"),
            "s.yaml: reactions[0]: no joint 'elbow'; known are 'crank', 'knee' and 'slider'");
  EXPECT_EQ(scene("joints: [{name: Crank, stiffness: 1}]"),
            "s.yaml: joints[0].name: no joint 'Crank'; did you mean 'crank'?");
  EXPECT_EQ(scene("applied_wrenches: [{link: rod}, {link: carrige}]"),
            "s.yaml: applied_wrenches[1].link: no link 'carrige'; did you mean 'carriage'?");
  EXPECT_EQ(scene("gravty: [0, 0, 0]"), "s.yaml: gravty: unknown key; did you mean 'gravity'?");
  const std::string pin =
      "closures: [{name: pin, type: revolute, parent: {link: carriage}, child: {link: rd}}]";
  EXPECT_EQ(scene(pin),
            "s.yaml: closures: 'pin': child.link: no link 'rd'; known are 'base', "
            "'crank_arm', 'rod' and 'carriage'");
  const std::string closed =
      "closures: [{name: pin, type: revolute, parent: {link: carriage}, child: {link: rod}}]\n";
  EXPECT_EQ(scene(closed + "actuated: [sldier]"),
            "s.yaml: actuated[0]: no joint or closure 'sldier'; did you mean 'slider'?");
  EXPECT_EQ(scene(closed + "assembly: [{name: crnk, position: 1}]"),
            "s.yaml: assembly[0].name: no joint 'crnk'; did you mean 'crank'?");
  EXPECT_EQ(scene(closed + "reactions: [pins]"),
            "s.yaml: reactions[0]: no joint or closure 'pins'; did you mean 'pin'?");
  EXPECT_EQ(
      scene("closures: [{name: pin, type: revolut}]"),
      "s.yaml: closures[0].type: 'revolut' is not one of fixed, revolute, prismatic, "
      "cylindrical, universal, spherical, planar, distance, gear, rack; did you mean 'revolute'?");
}

TEST_F(OfflineToolNames, OptionsAreNamed) {
  EXPECT_EQ(failure("--check --reactions crank,slidr"),
            "--reactions[1]: no joint 'slidr'; did you mean 'slider'?");
  EXPECT_EQ(failure("--chek", 2), "unknown option '--chek'; did you mean --check?");
  EXPECT_EQ(failure("--frobnicate", 2), "unknown option '--frobnicate'");
  write("m.csv", "time,position.slider,position.crank\n0,0,0\n");
  EXPECT_EQ(failure("--motion m.csv --rest kne=1", 2),
            "--rest: robot 'linkage' has no joint 'kne' that moves by itself; did you mean "
            "'knee'?");
}

TEST_F(OfflineToolNames, JointsOfAMotionAreComparedWithThoseOfTheRobot) {
  write("s.yaml", "motion: static\n");
  write("m.csv", "time,position.slidr,position.crank,position.knee\n0,0,0,0\n");
  EXPECT_EQ(failure("--scene s.yaml --motion m.csv"),
            "m.csv: line 1: column 'position.slider' is missing; is it 'position.slidr'?");
  write("m.csv",
        "time,position.slider,position.crank,position.knee,position.lid,effort.crank\n"
        "0,0,0,0,1,2\n");
  const Run result = run("--urdf linkage.urdf --scene s.yaml --motion m.csv");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err,
            "note: m.csv: ignored, not coordinates of the robot: 'lid'; they are 'crank', 'knee' "
            "and 'slider'\nnote: m.csv: ignored, no motion: 'effort.crank'\n");
}

TEST_F(OfflineToolNames, NamesWithControlCharactersStayInTheirLine) {
  write("s.yaml", "reactions: [\"kn\\nee\\x1b[31m\"]");
  EXPECT_EQ(failure("--check --scene s.yaml").substr(0, 50),
            "s.yaml: reactions[0]: no joint 'kn\\nee\\x1b[31m'; k");
  // So do paths.
  EXPECT_EQ(failure("--check --scene \"$(printf 'no\\nfile')\""),
            "no\\nfile: cannot be read: No such file or directory");
  std::string odd = kLinkage;
  odd.replace(odd.find("name=\"linkage\""), 14, "name=\"link&#10;age\x1b\"");
  odd.replace(odd.find("name=\"knee\""), 11, "name=\"kn&#10;ee\"");
  write("odd.urdf", odd);
  const Run result = run("--urdf odd.urdf --check");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("link\\nage\\x1b\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("kn\\nee"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("kn\nee"), std::string::npos) << result.out;
}

TEST_F(OfflineToolNames, MotionsInDegreesAndNanosecondsAreDoubtedWhateverTheyGive) {
  const std::string header =
      "time,position.slider,position.crank,position.knee,velocity.slider,velocity.crank,"
      "velocity.knee,acceleration.slider,acceleration.crank,acceleration.knee\n";
  const std::string rest = ",0,0,0,0,0,0,0\n";
  write("m.csv", header + "0,0,90" + rest + "0.1,0,91" + rest);
  EXPECT_EQ(run("--urdf linkage.urdf --motion m.csv").err,
            "warning: m.csv: positions of 'crank' reach 91, its limit is 3 rad: are they "
            "degrees?\n");
  write("m.csv", header + "1600000000000000000,0,1" + rest + "1600000000002000000,0,1" + rest);
  EXPECT_EQ(run("--urdf linkage.urdf --motion m.csv --check").err,
            "warning: m.csv: times up to 1.600000000002e+18 cannot be seconds: are they "
            "nanoseconds?\n");
}

}  // namespace
}  // namespace virtual_work_dynamics
