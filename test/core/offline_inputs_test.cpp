#include <gtest/gtest.h>
#include <unistd.h>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kSwing[] =
    "time,position.hinge,velocity.hinge,acceleration.hinge\n0,0,0,0\n0.1,0.3,-1.2,2.5\n";

/// Inputs that are no files, and targets that may not be written.
class OfflineToolInputs : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("p.urdf", kPendulum);
    write("m.csv", kSwing);
    write("s.yaml", "reactions: none\n");
  }

  // The message of a run that must fail with the input `name` of --urdf, --scene or --motion.
  std::string refusal(const std::string& option, const std::string& name,
                      const std::string& before = "") {
    std::string arguments;
    for (const std::string file : {"--urdf p.urdf", "--scene s.yaml", "--motion m.csv"}) {
      const bool replaced = file.rfind(option, 0) == 0;
      arguments += " " + (replaced ? option + " " + name : file);
    }
    const Run result = run(arguments, before);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    const std::string start = "inverse_dynamics_offline: error: ";
    return result.err.substr(std::min(start.size(), result.err.size()));
  }
};

TEST_F(OfflineToolInputs, DevicesWithoutEndAndFoldersAreRefused) {
  for (const char* option : {"--urdf", "--scene", "--motion"}) {
    EXPECT_EQ(refusal(option, "/dev/zero"),
              "/dev/zero: is not a text: byte 1 is zero; only UTF-8 is read\n");
    // What is wrong first is another thing each time.
    EXPECT_EQ(refusal(option, "/dev/urandom").rfind("/dev/urandom: ", 0), 0u);
    EXPECT_EQ(refusal(option, "."), ".: cannot be read: Is a directory\n");
  }
}

TEST_F(OfflineToolInputs, TextsWithoutEndAreRefused) {
  EXPECT_EQ(refusal("--urdf", "/dev/stdin", "yes '<robot>' |"),
            "/dev/stdin: has more than 256 MB, or no end\n");
  EXPECT_EQ(refusal("--scene", "/dev/stdin", "yes 'a: 1' |"),
            "/dev/stdin: has more than 64 MB, or no end\n");
  EXPECT_EQ(refusal("--motion", "-", "yes 'position.a,' | tr -d '\\n' |"),
            "/dev/stdin: line 1 has more than 64 MB, or no end\n");
  EXPECT_EQ(refusal("--motion", "-", "{ echo time,position.hinge; yes 0, | tr -d '\\n'; } |"),
            "/dev/stdin: line 2 has more than 64 MB, or no end\n");
}

TEST_F(OfflineToolInputs, TheTextOfAnotherEncodingIsNamed) {
  write("utf16.csv", std::string("\xFF\xFEt\0i\0m\0e\0\n\0", 12));
  EXPECT_EQ(refusal("--motion", "utf16.csv"),
            "utf16.csv: is not a text: byte 4 is zero; only UTF-8 is read\n");
}

TEST_F(OfflineToolInputs, PipesAreReadLikeFiles) {
  const std::string expected = run("--urdf p.urdf --scene s.yaml --motion m.csv").out;
  ASSERT_NE(expected, "");
  EXPECT_EQ(run("--urdf p.urdf --scene s.yaml --motion -", "cat m.csv |").out, expected);
  EXPECT_EQ(run("--urdf p.urdf --scene s.yaml --motion -", "(sleep 0.1; cat m.csv) |").out,
            expected);
  EXPECT_EQ(run("--urdf /dev/stdin --scene s.yaml --motion m.csv", "cat p.urdf |").out, expected);
  EXPECT_EQ(
      run("--urdf p.urdf --scene s.yaml --motion fifo & cat m.csv >fifo; wait", "mkfifo fifo;").out,
      expected);
}

// Pieces in which the text comes do not show, wherever they begin.
TEST_F(OfflineToolInputs, LinesMayBeLongerThanWhatIsReadAtOnce) {
  std::string header = "time,position.hinge,velocity.hinge,acceleration.hinge", row = "0,0,0,0";
  for (int i = 0; i < 20000; ++i) {
    header += ",position.other_" + std::to_string(i);
    row += ",0.125";
  }
  write("wide.csv", header + "\n" + row + "\n" + row + "\n");
  const Run result = run("--urdf p.urdf --scene s.yaml --motion wide.csv");
  EXPECT_EQ(result.out, "time,effort.hinge\n0,0\n0,0\n");
}

TEST_F(OfflineToolInputs, WhatMayNotBeWrittenStays) {
  std::string user;
  if (geteuid() == 0) user = "exec setpriv --reuid=65534 --regid=65534 --clear-groups";
  if (!user.empty() && std::system("setpriv --reuid=65534 true 2>/dev/null") != 0) {
    GTEST_SKIP() << "no other user than root to try it";
  }
  namespace fs = std::filesystem;
  write("r.csv", "kept");
  const std::string arguments = "--urdf p.urdf --motion m.csv --output r.csv";
  for (const bool folder_allows : {true, false}) {
    fs::permissions(folder(), folder_allows ? fs::perms(0777) : fs::perms(0555));
    fs::permissions(path("r.csv"), folder_allows ? fs::perms(0444) : fs::perms(0666));
    const Run result = run(arguments, user);
    fs::permissions(folder(), fs::perms(0755));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err,
              "inverse_dynamics_offline: error: r.csv: cannot be written: Permission denied\n");
    EXPECT_EQ(readFile(path("r.csv")), "kept");
    EXPECT_EQ(partialFile(folder()), "");
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
