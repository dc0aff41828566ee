#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kSwing[] =
    "time,position.hinge,velocity.hinge,acceleration.hinge\n"
    "0,0.3,0.1,-2\n0.01,0.301,0.08,-2.1\n0.02,0.3018,0.06,-2.2\n";
constexpr char kPayload[] =
    "gravity: [0, 1, -9]\nreactions: [hinge]\npayload: [{link: bob, mass: 1, at: [0, 0, -1]}]\n";

// As rosparam dump writes a text of several lines: in quotes, its line ends twice.
std::string quoted(const std::string& text) {
  std::string yaml = "'";
  for (const char c : text) yaml += c == '\n' ? "\n\n" : c == '\'' ? "''" : std::string(1, c);
  return yaml + "'";
}

std::string indented(const std::string& text, int blanks) {
  std::string result(static_cast<std::size_t>(blanks), ' ');
  for (std::size_t i = 0; i < text.size(); ++i) {
    result += text[i];
    if (text[i] == '\n' && i + 1 < text.size())
      result.append(static_cast<std::size_t>(blanks), ' ');
  }
  return result;
}

class OfflineRosparam : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("p.urdf", kPendulum);
    write("s.yaml", kPayload);
    write("m.csv", kSwing);
    write("dump.yaml", "inverse_dynamics:\n  estimator: {lag: 0.1}\n  scene:\n" +
                           indented(kPayload, 4) + "robot_description: " + quoted(kPendulum) +
                           "\nrosdistro: 'noetic\n\n  '\nrun_id: 7c5f\n");
    by_files_ = run("--urdf p.urdf --scene s.yaml --motion m.csv").out;
    ASSERT_FALSE(by_files_.empty());
  }

  // The results with these options are those of the files.
  void expectSame(const std::string& options) const {
    const Run result = run(options + " --motion m.csv");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, by_files_) << options;
  }

  // One line says what is wrong.
  void expectRefusal(const std::string& options, const std::string& why, int exit_code = 1) const {
    const Run result = run(options + " --motion m.csv");
    EXPECT_EQ(result.exit_code, exit_code) << options;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    if (exit_code == 1) {
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
  }

  std::string by_files_;
};

TEST_F(OfflineRosparam, GivesTheResultsOfTheFiles) {
  expectSame("--rosparam dump.yaml");
  expectSame("--rosparam dump.yaml --scene s.yaml --urdf p.urdf");
}

TEST_F(OfflineRosparam, ASceneThatWasSetOnACommandLineIsReadAsTheNodeReadsIt) {
  const std::string robot = "robot_description: " + quoted(kPendulum) + "\n";
  write("whole.yaml", robot +
                          "inverse_dynamics: {scene: \"{gravity: [0, 1, -9], reactions: "
                          "[hinge], payload: [{link: bob, mass: 1, at: [0, 0, -1]}]}\"}");
  expectSame("--rosparam whole.yaml");
  write("parts.yaml", robot +
                          "inverse_dynamics: {scene: {gravity: '[0, 1, -9]', reactions: "
                          "[hinge], payload: '[{link: bob, mass: 1, at: [0, 0, -1]}]'}}");
  expectSame("--rosparam parts.yaml");
}

TEST_F(OfflineRosparam, NamesAreSearchedAsTheNodeSearchesThem) {
  write("cell.yaml",
        "cell:\n  arm:\n    id:\n      scene:\n" + indented(kPayload, 8) +
            "  robot_description: " + quoted(kPendulum) +
            "\nrobot_description: <robot name=\"other\"/>\nscene: {gravity: [0, 0, 0]}\n");
  expectSame("--rosparam cell.yaml --node /cell/arm/id");
  expectRefusal("--rosparam cell.yaml",
                "cell.yaml: has no parameters of /inverse_dynamics; it has '/cell/arm/id/scene'");
  expectRefusal("--rosparam cell.yaml --node /cell/arm/ie", "--node says in which namespace");
  write("above.yaml", "cell: {robot_description: x}\nid: {scene: {}}");
  expectRefusal("--rosparam above.yaml --node /id",
                "above.yaml: has no robot_description for /id; it has '/cell/robot_description'");
}

TEST_F(OfflineRosparam, WithoutASceneItIsTheDefaultOne) {
  write("bare.yaml", "robot_description: " + quoted(kPendulum) + "\ninverse_dynamics: {rest: []}");
  const Run expected = run("--urdf p.urdf --motion m.csv");
  const Run result = run("--rosparam bare.yaml --motion m.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, expected.out);
  EXPECT_EQ(result.err, expected.err);
  EXPECT_NE(result.out, by_files_);
  // Of a node that is not in the dump, a note says so.
  write("none.yaml", "robot_description: " + quoted(kPendulum));
  const Run none = run("--rosparam none.yaml --motion m.csv");
  EXPECT_EQ(none.exit_code, 0) << none.err;
  EXPECT_EQ(none.out, expected.out);
  EXPECT_EQ(none.err,
            expected.err +
                "note: none.yaml: has no parameters of /inverse_dynamics, so that all are "
                "the default ones\n");
}

TEST_F(OfflineRosparam, WhatIsWrongIsSaidWhereItStands) {
  expectRefusal("--rosparam missing.yaml", "missing.yaml: ");
  write("list.yaml", "[1, 2]");
  expectRefusal("--rosparam list.yaml", "list.yaml: is no map of parameters");
  write("broken.yaml", "a: [1");
  expectRefusal("--rosparam broken.yaml", "broken.yaml: is not valid YAML: ");
  write("map.yaml", "robot_description: {a: 1}");
  expectRefusal("--rosparam map.yaml", "map.yaml: /robot_description: expected the text of a URDF");
  write("urdf.yaml", "robot_description: <robot\ninverse_dynamics: {rest: []}");
  expectRefusal("--rosparam urdf.yaml", "urdf.yaml: /robot_description: ");
  const std::string robot = "robot_description: " + quoted(kPendulum) + "\n";
  write("scene.yaml", robot + "inverse_dynamics: {scene: {gravitation: 1}}");
  expectRefusal("--rosparam scene.yaml", "scene.yaml: /inverse_dynamics/scene: gravitation");
  write("word.yaml", robot + "inverse_dynamics: 'gravity'");
  expectRefusal("--rosparam word.yaml",
                "word.yaml: /inverse_dynamics: expected a map of parameters");
  write("text.yaml", robot + "inverse_dynamics: {scene: {gravity: '[0, 1'}}");
  expectRefusal("--rosparam text.yaml",
                "text.yaml: /inverse_dynamics/scene/gravity: is not valid YAML");
  expectRefusal("--rosparam dump.yaml --output dump.yaml", "would overwrite the input", 2);
  expectRefusal("", "--urdf FILE is missing (or --rosparam FILE, or a bag", 2);
  expectRefusal("--urdf p.urdf --remap odom:=/x", "--remap is of use with --output BAG only", 2);
  expectRefusal("--urdf p.urdf --root-source imu", "--root-source is of use with --output BAG", 2);
  expectRefusal("--urdf p.urdf --remap odom", "--remap: 'odom' is not NAME:=TOPIC", 2);
}

TEST_F(OfflineRosparam, GeneratedCodeSaysOfWhichDump) {
  const Run result = run("--rosparam dump.yaml --generate code.c");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(readFile(path("code.c")).find("Description: 'dump.yaml', cksum "), std::string::npos);
}

TEST_F(OfflineRosparam, GeneratedCodeDoesNotOverwriteTheDump) {
  for (const std::string name : {"read.c", "read.h"}) {
    const std::string dump = readFile(path("dump.yaml"));
    write(name, dump);
    const Run result = run("--rosparam ./" + name + " --generate read.c");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("--generate: '" + name + "' would overwrite the input './" + name),
              std::string::npos)
        << result.err;
    EXPECT_EQ(readFile(path(name)), dump);
    std::filesystem::remove(path(name));
  }
}

TEST_F(OfflineRosparam, ABagWithoutADescriptionIsNone) {
  const Run result = run("--motion '" + std::string(kSourceFolder) + "/test/core/bags/none.bag'");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("none.bag: has no topic /robot_description of std_msgs/String, and "
                            "--urdf FILE is missing"),
            std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace virtual_work_dynamics
