#include <gtest/gtest.h>

#include <string>

#include "generated_program.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

class OfflineGenerate : public OfflineTool {
 protected:
  // The line that the tool says is wrong.
  std::string errorOf(const std::string& arguments) const {
    const Run result = run("--urdf crane.urdf " + arguments);
    EXPECT_NE(result.exit_code, 0);
    // Behind the warning of the crane's tool, which is as thin as a needle.
    const std::string begin = "inverse_dynamics_offline: error: ";
    const std::size_t at = result.err.find(begin);
    if (at == std::string::npos) return result.err;
    const std::size_t from = at + begin.size();
    return result.err.substr(from, result.err.find('\n', from) - from);
  }

  void SetUp() override {
    OfflineTool::SetUp();
    write("crane.urdf", kCrane);
  }
};

TEST_F(OfflineGenerate, WritesASourceAndAHeaderThatSaysWhatItIs) {
  write("scene.yaml", "gravity: [0, 0, -1.62]\nreactions: [shoulder, flange]\n");
  const Run result =
      run("--urdf crane.urdf --scene scene.yaml --axes child --generate crane_on_moon.c");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find("note: crane_on_moon.c, crane_on_moon.h: "), std::string::npos)
      << result.err;
  const std::string header = readFile(path("crane_on_moon.h"));
  ASSERT_EQ(std::system(("cksum <'" + path("scene.yaml") + "' >'" + path("sum") + "'").c_str()), 0);
  const std::string sum = readFile(path("sum"));
  const std::string number = sum.substr(0, sum.find(' '));
  for (const std::string& line :
       {std::string("Inverse dynamics of the robot 'crane' in one scene."),
        std::string("Description: 'crane.urdf', cksum "),
        "Scene: 'scene.yaml', cksum " + number + " ", std::string("Gravity: 0 0 -1.62 m/s^2"),
        std::string("Reactions in axes of the child links"),
        std::string("#define CRANE_ON_MOON_COORDINATES 2\n"),
        std::string("#define CRANE_ON_MOON_REACTIONS 2\n"),
        std::string("CRANE_ON_MOON_Q_SLIDE = 0"), std::string("CRANE_ON_MOON_Q_SHOULDER = 1"),
        std::string("CRANE_ON_MOON_R_FLANGE = 1"),
        std::string("void crane_on_moon_compute(const double q[2], const double qd[2],"),
        std::string("multiplications, ")}) {
    EXPECT_NE(header.find(line), std::string::npos) << line << "\n" << header;
  }
  const std::string compile = std::string("cc ") + kStrictC + "-O0 -c '" + path("crane_on_moon.c") +
                              "' -o '" + path("crane.o") + "'";
  EXPECT_EQ(std::system(compile.c_str()), 0);
}

TEST_F(OfflineGenerate, GivesTheSameTextWhereverItRuns) {
  ASSERT_EQ(run("--urdf crane.urdf --generate crane.c").exit_code, 0);
  const std::string first = readFile(path("crane.c"));
  ASSERT_EQ(
      run("--urdf '" + path("crane.urdf") + "' --generate '" + path("crane.c") + "'").exit_code, 0);
  EXPECT_EQ(readFile(path("crane.c")), first);
  EXPECT_EQ(first.find(folder()), std::string::npos);
}

TEST_F(OfflineGenerate, RefusesInOneLine) {
  EXPECT_EQ(errorOf("--generate crane.txt"),
            "--generate: 'crane.txt' does not end in .c, .cc, .cpp or .cxx");
  EXPECT_EQ(
      errorOf("--generate my-crane.c"),
      "--generate: 'my-crane.c': the functions are named after the file, which must begin with "
      "a letter and have but letters, digits and underscores before its ending");
  EXPECT_EQ(errorOf("--generate crane.c --motion m.csv"),
            "--motion cannot be used with --generate");
  EXPECT_EQ(errorOf("--axes inertial --generate crane.c"),
            "--axes inertial cannot be used with --generate");
  EXPECT_EQ(errorOf("--check --generate crane.c"), "--check cannot be used with --generate");
  write("rolls.yaml",
        "rolling:\n  - {name: tyre, link: jib, axis: [0, 1, 0], radius: 0.5, normal: false, "
        "plane: {link: base}}\n");
  EXPECT_EQ(errorOf("--scene rolls.yaml --generate crane.c"),
            "rolls.yaml: no code can be generated, as closure 'tyre' touches a plane");
  EXPECT_EQ(errorOf("--no-efforts --reactions none --generate crane.c"),
            "no code can be generated, as neither efforts nor reactions are asked for");
  EXPECT_EQ(errorOf("--reactions elbo --generate crane.c"),
            "--reactions[0]: no joint 'elbo'; did you mean 'elbow'?");
  EXPECT_FALSE(exists("crane.c"));
  EXPECT_FALSE(exists("crane.h"));
}

}  // namespace
}  // namespace virtual_work_dynamics
