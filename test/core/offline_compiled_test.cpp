#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "base/number_text.h"
#include "generated_program.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

// Rows of files by the tool with --compiled and without. Compilers are stand-ins that take notes
// before they call the real one.
class OfflineCompiled : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    if (!isThere("cc")) GTEST_SKIP() << "there is no cc";
    write("crane.urdf", kCrane);
    write("m.csv", motion(1203, 3));
    for (const char* folder : {"bin", "tmp"}) std::filesystem::create_directory(path(folder));
  }

  // Of a crane: rows that rest, too, and some of large numbers.
  static std::string motion(int rows, double size) {
    std::string text = "time";
    for (const char* level : {"position", "velocity", "acceleration"}) {
      for (const char* joint : {"slide", "shoulder"})
        text += std::string(",") + level + "." + joint;
    }
    text += "\n";
    for (int row = 0; row < rows; ++row) {
      text += numberText(0.01 * row);
      for (int c = 0; c < 6; ++c) {
        const double wave = row % 7 == 0 ? 0 : size * std::sin(0.37 * row + 1.1 * c);
        text += "," + numberText(wave);
      }
      text += "\n";
    }
    return text;
  }

  // Puts a cc in place that runs a script's lines before the real cc.
  void standIn(const std::string& lines) const {
    const std::string script =
        write("bin/cc", "#!/bin/sh\necho called >>'" + path("calls") + "'\n" + lines +
                            "\nPATH=\"${PATH#*:}\"\nexec cc \"$@\"\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  }
  std::string environment() const {
    return "TMPDIR='" + path("tmp") + "' PATH='" + path("bin") + "':\"$PATH\"";
  }
  bool called() const { return exists("calls"); }
  bool leftNothing() const { return std::filesystem::is_empty(path("tmp")); }

  // The results with --compiled, which has to be used, and without have the same bytes.
  void expectSameBytes(const std::string& arguments) const {
    const Run plain = run("--urdf crane.urdf " + arguments);
    ASSERT_EQ(plain.exit_code, 0) << plain.err;
    std::filesystem::remove(path("calls"));
    standIn("");
    const Run compiled = run("--urdf crane.urdf --compiled " + arguments, environment());
    EXPECT_EQ(compiled.exit_code, 0) << compiled.err;
    EXPECT_TRUE(called());
    EXPECT_EQ(compiled.err, plain.err);
    EXPECT_TRUE(compiled.out == plain.out) << arguments << "\n" << compiled.out.substr(0, 2000);
    EXPECT_GT(compiled.out.size(), 1000u);
    EXPECT_TRUE(leftNothing());
  }
};

TEST_F(OfflineCompiled, GivesTheSameBytes) {
  write("scene.yaml",
        "gravity: [0.5, 0, -9.81]\n"
        "applied_wrenches:\n"
        "  - {name: hook, link: tool, at: [0.1, 0, 0], axes: root, force: [1, 2, 3]}\n"
        "joints:\n  - {name: shoulder, damping: 0.3, coulomb: 0.2, stiffness: 2}\n");
  expectSameBytes("--motion m.csv");
  expectSameBytes("--motion m.csv --scene scene.yaml --axes child --threads 2");
  expectSameBytes("--motion m.csv --scene scene.yaml --no-efforts --reactions flange,slide");
  expectSameBytes("--motion m.csv --scene scene.yaml --certificates --positions --effort-limits");
}

TEST_F(OfflineCompiled, GivesTheSameBytesForOtherInstructions) {
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2}) {
    if (!isSupported(set)) continue;
    const std::string chosen =
        std::string("export ") + kInstructionSetVariable + "=" + toString(set);
    const Run plain = run("--urdf crane.urdf --motion m.csv", chosen + ";");
    standIn("");
    const Run compiled =
        run("--urdf crane.urdf --motion m.csv --compiled", chosen + ";" + environment());
    EXPECT_EQ(compiled.err, plain.err);
    EXPECT_TRUE(compiled.out == plain.out) << toString(set);
  }
}

TEST_F(OfflineCompiled, GivesTheSameBytesWhereNumbersOverflow) {
  write("m.csv", motion(40, 1e160));
  expectSameBytes("--motion m.csv --axes child");
}

TEST_F(OfflineCompiled, GivesTheSameBytesForMovingRootsAndWrenchesOfTheMotion) {
  write("scene.yaml",
        "root: moving\n"
        "applied_wrenches:\n  - {name: hook, link: tool, axes: link, force: [1, 2, 3]}\n");
  std::string text = motion(300, 2), wider;
  std::istringstream lines(text);
  int row = -1;
  for (std::string line; std::getline(lines, line); ++row) {
    if (row < 0) {
      for (const char* name :
           {"root.angular_velocity.x", "root.angular_velocity.y", "root.angular_velocity.z",
            "root.acceleration.x", "root.acceleration.y", "root.acceleration.z",
            "root.angular_acceleration.x", "root.angular_acceleration.y",
            "root.angular_acceleration.z", "root.orientation.x", "root.orientation.y",
            "root.orientation.z", "root.orientation.w", "wrench.hook.fx", "wrench.hook.fy",
            "wrench.hook.fz", "wrench.hook.tx", "wrench.hook.ty", "wrench.hook.tz"}) {
        line += std::string(",") + name;
      }
    } else {
      for (int c = 0; c < 9; ++c) line += "," + numberText(std::cos(0.3 * row + c));
      line += ",0,0,0.6,0.8";
      for (int c = 0; c < 6; ++c) line += "," + numberText(std::cos(0.2 * row * c));
    }
    wider += line + "\n";
  }
  write("m.csv", wider);
  expectSameBytes("--motion m.csv --scene scene.yaml");
}

TEST_F(OfflineCompiled, ComputesWithWhatWasCompiled) {
  // A compiler that is given another robot's mass: 4 kg of the sledge become 5.
  standIn(
      "for word; do case \"$word\" in *.c) sed -i 's/\\b4\\.0\\b/5.0/g; s/\\b6\\.25\\b/7.25/g' "
      "\"$word\";; esac; done");
  const std::string arguments = "--urdf crane.urdf --motion m.csv --reactions none";
  const Run plain = run(arguments), compiled = run(arguments + " --compiled", environment());
  EXPECT_EQ(compiled.exit_code, 0) << compiled.err;
  EXPECT_NE(compiled.out, plain.out);
}

TEST_F(OfflineCompiled, WorksInAFolderOfItsOwnWithoutAShell) {
  const std::string odd = path("tmp") + "/a $(touch spoilt) 'b'";
  std::filesystem::create_directory(odd);
  standIn(
      "for word; do case \"$word\" in *.c) stat -c '%a %n' \"$(dirname \"$word\")\" \"$word\" >'" +
      path("seen") + "'; echo \"$TMPDIR\" >>'" + path("seen") + "';; esac; done");
  const Run compiled = run("--urdf crane.urdf --motion m.csv --compiled",
                           "TMPDIR=\"" + path("tmp") + "/a \\$(touch spoilt) 'b'\" PATH='" +
                               path("bin") + "':\"$PATH\"");
  EXPECT_EQ(compiled.exit_code, 0) << compiled.err;
  EXPECT_EQ(compiled.err.find("--compiled"), std::string::npos) << compiled.err;
  std::istringstream seen(readFile(path("seen")));
  std::string folder, file, temporary;
  std::getline(seen, folder);
  std::getline(seen, file);
  std::getline(seen, temporary);
  EXPECT_EQ(folder.rfind("700 " + odd + "/", 0), 0u) << folder;
  EXPECT_EQ(file.rfind("600 " + odd + "/", 0), 0u) << file;
  EXPECT_EQ(folder.substr(4), temporary);
  EXPECT_TRUE(std::filesystem::is_empty(odd));
  EXPECT_FALSE(exists("spoilt"));
}

TEST_F(OfflineCompiled, FallsBackWithOneNote) {
  const auto expectNote = [&](const std::string& note, const std::string& before) {
    const std::string arguments = "--urdf crane.urdf --motion m.csv";
    const Run plain = run(arguments), compiled = run(arguments + " --compiled", before);
    EXPECT_EQ(compiled.exit_code, 0);
    EXPECT_TRUE(compiled.out == plain.out);
    EXPECT_EQ(compiled.err, plain.err + "note: --compiled: " + note + "; computed without\n");
    EXPECT_TRUE(leftNothing());
  };
  standIn("exit 3");
  expectNote("cc fails with exit status 3", environment());
  standIn("kill -9 $$");
  expectNote("cc was ended by signal 9", environment());
  expectNote("there is no C compiler (cc, gcc or clang)", "PATH='" + path("tmp") + "'");
  standIn("echo >\"$TMPDIR/rows.so\"; exit 0");
  const Run broken = run("--urdf crane.urdf --motion m.csv --compiled", environment());
  EXPECT_NE(broken.err.find("note: --compiled: what was compiled cannot be loaded: "),
            std::string::npos)
      << broken.err;
  const Run nowhere = run("--urdf crane.urdf --motion m.csv --compiled", "TMPDIR=/nowhere");
  EXPECT_EQ(nowhere.exit_code, 0);
  EXPECT_NE(nowhere.err.find("note: --compiled: no folder can be made in "
                             "'/nowhere': No such file or directory; computed"),
            std::string::npos)
      << nowhere.err;
}

TEST_F(OfflineCompiled, LeavesNothingWhenASignalEndsIt) {
  standIn("sleep 60");
  const auto start = std::chrono::steady_clock::now();
  const Run ended =
      run("--urdf crane.urdf --motion m.csv --compiled", environment() + " timeout -s TERM 1");
  EXPECT_EQ(ended.exit_code, 124);
  EXPECT_EQ(ended.out, "");
  EXPECT_TRUE(called());
  EXPECT_TRUE(leftNothing());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

// A compiler that is slow, and a hang-up meanwhile, as of a shell that is closed.
TEST_F(OfflineCompiled, HangsOnUnderNohup) {
  standIn("sleep 2; exit 3");
  const std::string arguments = "--urdf crane.urdf --motion m.csv";
  const Run plain = run(arguments);
  const Run hung = run(arguments + " --compiled", environment() + " timeout -s HUP 1 nohup");
  EXPECT_TRUE(called());
  EXPECT_TRUE(hung.out == plain.out) << hung.err;
  EXPECT_NE(hung.err.find("note: --compiled: cc fails with exit status 3"), std::string::npos)
      << hung.err;
  EXPECT_TRUE(leftNothing());
}

TEST_F(OfflineCompiled, IsRefusedWhereItSaysNothing) {
  for (const char* others :
       {"--check", "--explain", "--method lagrange", "--regressor folder", "--generate crane.c"}) {
    const Run result = run(std::string("--urdf crane.urdf --motion m.csv --compiled ") + others);
    EXPECT_EQ(result.exit_code, 2) << others;
    EXPECT_NE(result.err.find("--compiled"), std::string::npos) << result.err;
  }
}

TEST_F(OfflineCompiled, NamesClosedLoops) {
  write("pair.urdf", kPendulum);
  write("p.csv", "time,position.hinge,velocity.hinge,acceleration.hinge\n0,0.1,0,0\n1,0.1,0,0\n");
  write("spring.yaml",
        "springs:\n  - {name: coil, stiffness: 100, rest_length: 0.1, link_a: stand, "
        "at_a: [0.5, 0, 1], link_b: bob, at_b: [0, 0, -0.5]}\n");
  const std::string arguments = "--urdf pair.urdf --scene spring.yaml --motion p.csv";
  const Run plain = run(arguments), compiled = run(arguments + " --compiled");
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(compiled.exit_code, 0);
  EXPECT_EQ(compiled.out, plain.out);
  EXPECT_NE(compiled.err.find("note: --compiled: no code can be generated, as spring 'coil' acts "
                              "between two points"),
            std::string::npos)
      << compiled.err;
}

}  // namespace
}  // namespace virtual_work_dynamics
