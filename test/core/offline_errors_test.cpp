#include <gtest/gtest.h>
#include <signal.h>
#include <sys/types.h>

#include <chrono>
#include <thread>
#include <utility>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kSwing[] =
    "time,position.hinge,velocity.hinge,acceleration.hinge\n0,0,0,0\n0.1,0.3,-1.2,2.5\n";

class OfflineToolErrors : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("p.urdf", kPendulum);
    write("m.csv", kSwing);
  }

  // The message of a run that must fail, without the program's name. Whatever fails, the result of
  // an earlier run stays, and no partial one is left.
  std::string failure(const std::string& arguments, int exit_code, const std::string& before = "") {
    write("r.csv", "kept");
    const Run result = run(arguments, before);
    EXPECT_EQ(result.exit_code, exit_code) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(readFile(path("r.csv")), "kept") << arguments;
    EXPECT_EQ(partialFile(folder()), "") << arguments;
    const std::string start = "inverse_dynamics_offline: error: ";
    const std::string end =
        exit_code == 2 ? "\nTry 'inverse_dynamics_offline --help'.\n" : std::string("\n");
    const std::string& text = result.err;
    if (text.size() < start.size() + end.size() || text.compare(0, start.size(), start) != 0 ||
        text.compare(text.size() - end.size(), end.size(), end) != 0) {
      return "unexpected: " + text;
    }
    const std::string line = text.substr(start.size(), text.size() - start.size() - end.size());
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }

  std::string usage(const std::string& arguments) { return failure(arguments, 2); }

  // The error for a motion with this text instead of m.csv.
  std::string motion(const std::string& text) {
    write("bad.csv", text);
    return failure("--urdf p.urdf --motion bad.csv --output r.csv", 1);
  }

  std::string urdf(const std::string& text) {
    write("bad.urdf", text);
    return failure("--urdf bad.urdf --motion m.csv --output r.csv", 1);
  }

  std::string scene(const std::string& text) {
    write("bad.yaml", text);
    return failure("--urdf p.urdf --motion m.csv --scene bad.yaml --output r.csv", 1);
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(OfflineToolErrors, WrongUsageIsToldWithAHint) {
  const std::string good = "--urdf p.urdf --motion m.csv --output r.csv ";
  EXPECT_EQ(usage(""), "--urdf FILE is missing");
  EXPECT_EQ(usage("--urdf p.urdf"),
            "--motion FILE is missing (only --check, --explain and --generate need none)");
  EXPECT_EQ(usage(good + "--gravitiy '0 0 0'"),
            "unknown option '--gravitiy'; did you mean --gravity?");
  EXPECT_EQ(usage(good + "extra"), "unexpected argument 'extra'");
  EXPECT_EQ(usage(good + "--motion=n.csv"), "--motion is given twice");
  EXPECT_EQ(usage("--motion m.csv --urdf"), "--urdf needs a value");
  EXPECT_EQ(usage("--motion --urdf p.urdf"), "--motion needs a value");
  EXPECT_EQ(usage(good + "--scene="), "--scene needs a value");
  EXPECT_EQ(usage(good + "--check=yes"), "--check takes no value");
  EXPECT_EQ(usage(good + "--axes world"), "--axes: 'world' is neither root nor child nor inertial");
  EXPECT_EQ(usage(good + "--gravity '0 0'"),
            "--gravity: '0 0' is not three numbers, as in --gravity \"0 0 -9.81\"");
  EXPECT_EQ(usage(good + "--gravity '0 0 -9.81 1'"),
            "--gravity: '0 0 -9.81 1' is not three numbers, as in --gravity \"0 0 -9.81\"");
  EXPECT_EQ(usage(good + "--gravity '0 0 g'"), "--gravity: 'g' is not a finite number");
  EXPECT_EQ(usage(good + "--gravity=nan"), "--gravity: 'nan' is not a finite number");
  EXPECT_EQ(usage(good + "--reactions hinge,,ground"),
            "--reactions: there is an empty name in 'hinge,,ground'");
}

TEST_F(OfflineToolErrors, ThreadsAreAWholeNumber) {
  const std::string good = "--urdf p.urdf --motion m.csv --output r.csv ";
  for (const std::string text : {"0", "-1", "1.5", "two", "1025", "nan"}) {
    EXPECT_EQ(usage(good + "--threads=" + text),
              "--threads: '" + text + "' is not a whole number from 1 to 1024");
  }
  EXPECT_EQ(usage(good + "--explain=yes"), "--explain takes no value");
}

TEST_F(OfflineToolErrors, LagrangeHasOneThreadAndNothingToExplain) {
  const std::string good = "--urdf p.urdf --motion m.csv --output r.csv --method ";
  EXPECT_EQ(usage(good + "newton"), "--method: 'newton' is neither virtual_work nor lagrange");
  EXPECT_EQ(usage(good + "lagrange --threads 2"),
            "--threads: --method lagrange runs in one thread, not in 2");
  EXPECT_EQ(usage(good + "lagrange --explain"), "--explain cannot be used with --method lagrange");
}

TEST_F(OfflineToolErrors, AnUnknownInstructionSetIsNamed) {
  write("p.urdf", kPendulum);
  const Run result = run("--urdf p.urdf --explain", "VIRTUAL_WORK_DYNAMICS_INSTRUCTION_SET=mmx");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.err, "'mmx' is not one of baseline, avx2, avx512")) << result.err;
}

TEST_F(OfflineToolErrors, AnInputIsNeverOverwritten) {
  EXPECT_EQ(usage("--urdf p.urdf --motion m.csv --output ./m.csv"),
            "--output: './m.csv' would overwrite the input 'm.csv'");
  EXPECT_EQ(readFile(path("m.csv")), kSwing);
  // Nor is anything else that is there.
  write("q.csv.part", kSwing);
  std::filesystem::create_symlink("m.csv", path("n.csv.part"));
  for (const std::string output : {"q.csv", "n.csv"}) {
    EXPECT_EQ(run("--urdf p.urdf --motion q.csv.part --output " + output).exit_code, 0);
    EXPECT_TRUE(exists(output));
  }
  EXPECT_EQ(readFile(path("m.csv")), kSwing);
  EXPECT_EQ(readFile(path("q.csv.part")), kSwing);
  EXPECT_TRUE(std::filesystem::is_symlink(path("n.csv.part")));
}

TEST_F(OfflineToolErrors, BadMotionsAreNamedWithLineAndColumn) {
  EXPECT_EQ(motion(""), "bad.csv: the file is empty");
  EXPECT_EQ(motion("time,position.hinge\n"), "bad.csv: no rows after the header");
  EXPECT_EQ(motion("position.hinge\n1\n"), "bad.csv: line 1: column 'time' is missing");
  EXPECT_EQ(motion("time,position.hing\n0,1\n"),
            "bad.csv: line 1: column 'position.hinge' is missing; is it 'position.hing'?");
  EXPECT_EQ(motion("time,positon.hinge\n0,1\n"),
            "bad.csv: line 1, column 2: 'positon.hinge' is not one of time, position.<joint>, "
            "velocity.<joint>, acceleration.<joint>; did you mean 'position.hinge'?");
  EXPECT_EQ(motion("time,position.hinge,position.hinge\n0,1,2\n"),
            "bad.csv: line 1, column 3: 'position.hinge' already stands in column 2");
  EXPECT_EQ(motion(std::string(kSwing) + "0.2,1,2\n"),
            "bad.csv: line 4: 4 cells expected as in the header, 3 found");
  EXPECT_EQ(motion(std::string(kSwing) + "0.2,1,2,fast\n"),
            "bad.csv: line 4, column 4 (acceleration.hinge): 'fast' is not a finite number");
  EXPECT_EQ(failure("--urdf p.urdf --motion none.csv --output r.csv", 1),
            "none.csv: cannot be read: No such file or directory");
  EXPECT_EQ(failure("--urdf p.urdf --motion . --output r.csv", 1),
            ".: cannot be read: Is a directory");
}

TEST_F(OfflineToolErrors, EstimatingNeedsRowsAndTimesThatIncrease) {
  EXPECT_EQ(motion("time,position.hinge\n0,1\n"),
            "bad.csv: motion: accelerations are not given, and estimating them takes 3 rows or "
            "more, not 1");
  EXPECT_EQ(motion("# c\ntime,position.hinge\n0,1\n0.5,1\n# d\n0.5,1\n1,2\n"),
            "bad.csv: line 6: time 0.5 is not later than 0.5 in the row before, and derivatives "
            "have to be estimated");
}

// What recorders and tables of ROS stamps hold, counted from 1970 and from the start. Six rows.
TEST_F(OfflineToolErrors, TimesThatCannotBeSecondsAreRefused) {
  const auto rows = [](double start, double spacing) {
    std::string text = "time,position.hinge\n";
    for (int i = 0; i < 6; ++i) text += std::to_string(start + spacing * i) + ",0.1\n";
    return text;
  };
  EXPECT_EQ(motion(rows(1.6e18, 1.024e7)),
            "bad.csv: times up to 1.6e+18 with 1.024e+07 from row to row cannot be seconds, and "
            "derivatives have to be estimated: are they nanoseconds? Give seconds");
  const std::pair<double, double> clocks[] = {{0, 1e6}, {1.6e15, 1e3}, {1.6e12, 1}};
  for (const auto& [start, spacing] : clocks) {
    EXPECT_TRUE(contains(motion(rows(start, spacing)), "are they nanoseconds?")) << start;
  }
  // Slow recordings are not, and where nothing is estimated times have no part in the results.
  write("slow.csv", rows(0, 3600));
  EXPECT_EQ(run("--urdf p.urdf --motion slow.csv").exit_code, 0);
  write("exact.csv",
        "time,position.hinge,velocity.hinge,acceleration.hinge\n1.6e18,0,0,0\n1.7e18,0,0,0\n");
  EXPECT_EQ(run("--urdf p.urdf --motion exact.csv").exit_code, 0);
}

TEST_F(OfflineToolErrors, BadRobotsAreNamed) {
  EXPECT_TRUE(contains(urdf("no xml"), "robot description"));
  const std::string pendulum = kPendulum;
  std::string bad = pendulum;
  bad.replace(bad.find("<mass value=\"2\""), 15, "<mass value=\"-2\"");
  EXPECT_TRUE(contains(urdf(bad), "'bob'"));
  bad = pendulum;
  bad.replace(bad.find("0 1 0"), 5, "0 0 0");
  EXPECT_TRUE(contains(urdf(bad), "'hinge'"));
  bad = pendulum;
  bad.replace(bad.find("continuous"), 10, "flying");
  EXPECT_TRUE(contains(urdf(bad), "'hinge'"));
  EXPECT_TRUE(contains(failure("--urdf none.urdf --motion m.csv --output r.csv", 1),
                       "none.urdf: cannot be read: No such file or directory"));
  EXPECT_TRUE(contains(failure("--urdf . --motion m.csv --output r.csv", 1), "Is a directory"));
}

TEST_F(OfflineToolErrors, BadScenesAreNamed) {
  EXPECT_TRUE(contains(scene("gravty: [0, 0, 0]\n"), "gravty"));
  EXPECT_TRUE(contains(scene("closures: [{name: pin}]\n"), "closures[0]: type is missing"));
  EXPECT_TRUE(contains(scene("reactions: [hing]\n"), "hing"));
  EXPECT_TRUE(
      contains(failure("--urdf p.urdf --motion m.csv --reactions hinge,hinge", 1), "'hinge'"));
  EXPECT_TRUE(contains(failure("--urdf p.urdf --motion m.csv --scene none.yaml", 1), "none.yaml"));
}

TEST_F(OfflineToolErrors, NamesThatWouldBreakTheHeaderAreRefused) {
  std::string bad = kCrane;
  bad.replace(bad.find("name=\"elbow\""), 12, "name=\"el,bow\"");
  // The needle-thin tool is warned of as well.
  bad.replace(bad.find("izz=\"3e-06\""), 11, "izz=\"0\"");
  write("bad.urdf", bad);
  write("c.csv", "time,position.slide,position.shoulder\n0,0,0\n");
  write("s.yaml", "motion: static\n");
  EXPECT_EQ(failure("--urdf bad.urdf --motion c.csv --scene s.yaml", 1),
            "joint 'el,bow': a comma, quote or line end cannot stand in a CSV header");
}

TEST_F(OfflineToolErrors, OutputsThatCannotBeWrittenAreNamed) {
  const std::string good = "--urdf p.urdf --motion m.csv ";
  EXPECT_EQ(failure(good + "--output none/r.csv", 1),
            "none/r.csv: cannot be written: No such file or directory");
  EXPECT_EQ(failure(good + "--output .", 1), ".: cannot be written: Is a directory");
  EXPECT_EQ(failure(good + "--output /dev/full", 1),
            "/dev/full: cannot be written: No space left on device");
  EXPECT_EQ(failure(good + ">/dev/full", 1),
            "standard output: cannot be written: No space left on device");
  EXPECT_EQ(failure("--help >/dev/full", 1), "standard output: cannot be written");
}

std::string longMotion(int rows) {
  std::string text = "time,position.hinge,velocity.hinge,acceleration.hinge\n";
  for (int i = 0; i < rows; ++i) text += std::to_string(i) + ",0.123,0.456,0.789\n";
  return text;
}

TEST_F(OfflineToolErrors, AFullDiskLeavesNoPartialFile) {
  write("long.csv", longMotion(2000));
  // A limit on the size of files stands for the disk; ignoring the signal makes it an error.
  EXPECT_EQ(failure("--urdf p.urdf --motion long.csv --output r.csv", 1,
                    "trap '' XFSZ; ulimit -f 64; exec"),
            "r.csv: cannot be written: File too large");
}

// Starts the tool, ends it by a signal once the partial file is there, and returns the wait status.
int interrupted(const std::string& folder, int signal_number) {
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.c_str()) != 0) _exit(126);
    signal(signal_number, SIG_DFL);  // a parent in the background may have it ignored
    execl(kOfflineTool, kOfflineTool, "--urdf", "p.urdf", "--motion", "long.csv", "--output",
          "r.csv", static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (!partialFile(folder).empty()) {
      kill(child, signal_number);
      waitpid(child, &status, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return status;
}

TEST_F(OfflineToolErrors, AnEndingSignalLeavesNoPartialFile) {
  write("long.csv", longMotion(200000));
  for (const int signal_number :
       {SIGHUP, SIGINT, SIGQUIT, SIGILL, SIGTRAP, SIGABRT, SIGBUS, SIGFPE, SIGUSR1, SIGSEGV,
        SIGUSR2, SIGPIPE, SIGALRM, SIGTERM, SIGXCPU, SIGXFSZ, SIGVTALRM}) {
    write("r.csv", "kept");
    // The tool may win the race and finish before the signal; then it is tried again.
    int status = 0;
    for (int attempt = 0; attempt < 5 && !WIFSIGNALED(status); ++attempt) {
      write("r.csv", "kept");
      status = interrupted(folder(), signal_number);
    }
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal_number);
    EXPECT_EQ(readFile(path("r.csv")), "kept");
    EXPECT_EQ(partialFile(folder()), "");
  }
}

// Several runs may write one file at once: what stays is one of the results, whole.
TEST_F(OfflineToolErrors, OfTwoThatWriteOneFileOneIsLeftWhole) {
  write("long.csv", longMotion(20000));
  write("short.csv", longMotion(5000));
  const auto command = [](const std::string& motion, const std::string& output) {
    return "--urdf p.urdf --motion " + motion + " --output " + output;
  };
  ASSERT_EQ(run(command("long.csv", "long_r.csv")).exit_code, 0);
  ASSERT_EQ(run(command("short.csv", "short_r.csv")).exit_code, 0);
  const std::string results[] = {readFile(path("long_r.csv")), readFile(path("short_r.csv"))};
  for (const char* const delay : {"0", "0.01", "0.02", "0.04", "0.08"}) {
    const std::string first = std::string(kOfflineTool) + " " + command("long.csv", "r.csv");
    const Run second = run(command("short.csv", "r.csv") + "; wait $! && echo both",
                           first + " 2>first.err & sleep " + delay + ";");
    EXPECT_EQ(second.out, "both\n") << second.err << readFile(path("first.err"));
    const std::string left = readFile(path("r.csv"));
    EXPECT_TRUE(left == results[0] || left == results[1]) << delay << ": " << left.size();
    EXPECT_EQ(partialFile(folder()), "");
  }
}

TEST_F(OfflineToolErrors, TheModeOfAReplacedFileIsKept) {
  const auto modeOf = [this](const std::string& name) {
    return static_cast<int>(std::filesystem::status(path(name)).permissions());
  };
  write("r.csv", "old");
  for (const int mode : {0640, 0600, 0664}) {
    std::filesystem::permissions(path("r.csv"), static_cast<std::filesystem::perms>(mode));
    ASSERT_EQ(run("--urdf p.urdf --motion m.csv --output r.csv").exit_code, 0);
    EXPECT_EQ(modeOf("r.csv"), mode);
  }
  ASSERT_EQ(run("--urdf p.urdf --motion m.csv --output new.csv", "umask 027; exec").exit_code, 0);
  EXPECT_EQ(modeOf("new.csv"), 0640);
  const std::string long_name(251, 'n');
  ASSERT_EQ(run("--urdf p.urdf --motion m.csv --output " + long_name + ".csv").exit_code, 0);
  EXPECT_TRUE(exists(long_name + ".csv"));
}

}  // namespace
}  // namespace virtual_work_dynamics
