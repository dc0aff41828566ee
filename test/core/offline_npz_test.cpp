#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/output_file.h"
#include "npz/npz_writer.h"
#include "offline_linkage.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kSwing[] =
    "time,position.hinge,velocity.hinge,acceleration.hinge\n"
    "0,0.1,0.2,0.3\n0.1,0.2,0.3,0.4\n0.2,0.3,0.4,1e-7\n0.4,0.5,-0.1,-2\n";

// An .npz by numpy, and what numpy reads of one.
class OfflineNpz : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) {
      GTEST_SKIP() << "numpy is not installed";
    }
    write("pendulum.urdf", kPendulum);
    write("swing.csv", kSwing);
  }

  // Runs lines of Python in the folder. @returns what they print; their errors with a status that
  // is not 0.
  std::string python(const std::string& lines) const {
    write("lines.py", "import io, json, zipfile\nimport numpy as np\n" + lines);
    const std::string command = "cd '" + folder() + "' && /usr/bin/python3 lines.py >said 2>&1";
    const int status = std::system(command.c_str());
    return (status == 0 ? "" : "failed: ") + readFile(path("said"));
  }

  // Computes `motion` to an output.
  Run compute(const std::string& motion, const std::string& output,
              const std::string& more = "") const {
    return run("--urdf pendulum.urdf --motion " + motion + " --output " + output + " " + more);
  }

  void expectRefused(const std::string& motion, const std::string& message) const {
    SCOPED_TRACE(message);
    const Run result = compute(motion, "no.csv");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(exists("no.csv"));
  }
};

TEST_F(OfflineNpz, HasTheColumnsOfTheCsv) {
  ASSERT_EQ(compute("swing.csv", "r.csv", "--positions --axes child").exit_code, 0);
  const Run result = compute("swing.csv", "r.npz", "--positions --axes child");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(python("z = np.load('r.npz', allow_pickle=False)\n"
                   "header = open('r.csv').readline().strip().split(',')\n"
                   "assert list(z.files) == header + ['mechanism.json'], z.files\n"
                   "rows = np.genfromtxt('r.csv', delimiter=',', skip_header=1)\n"
                   "for i, name in enumerate(header):\n"
                   "    assert z[name].dtype == np.float64 and z[name].shape == (4,)\n"
                   "    assert (z[name] == rows[:, i]).all(), name\n"
                   "assert zipfile.ZipFile('r.npz').testzip() is None\n"),
            "");
}

TEST_F(OfflineNpz, SaysWhatItsColumnsBelongTo) {
  write("arm.urdf", kCrane);
  write("m.csv", "time,position.slide,position.shoulder\n0,0,0\n");
  write("s.yaml", "motion: static\n");
  const Run result =
      run("--urdf arm.urdf --scene s.yaml --motion m.csv --axes child --output r.npz "
          "--reactions slide,shoulder,elbow,flange,ground");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(
      python("said = json.loads(bytes(np.load('r.npz')['mechanism.json']).decode())\n"
             "assert said['robot'] == 'crane' and said['axes'] == 'child'\n"
             "of = {item['name']: item for item in said['reactions']}\n"
             "assert of['slide']['axis'] == [0, 0, 1] and 'turn' not in of['slide']\n"
             "assert of['shoulder']['turn'] == {'velocity': 'velocity.shoulder', 'factor': 1}\n"
             "assert of['elbow']['turn'] == {'velocity': 'velocity.shoulder', 'factor': -2}\n"
             "assert of['elbow']['parent'] == 'boom' and of['elbow']['child'] == 'jib'\n"
             "assert 'axis' not in of['flange'] and of['ground']['kind'] == 'ground'\n"
             "efforts = {item['name']: item for item in said['efforts']}\n"
             "assert efforts['slide']['unit'] == 'm' and efforts['shoulder']['unit'] == 'rad'\n"
             "assert efforts['slide']['effort_limit'] == 1 and efforts['slide']['velocity_limit'] "
             "== 1\n"
             "assert efforts['slide']['lower'] == 0 and efforts['shoulder']['lower'] == -1\n"),
      "");
}

TEST_F(OfflineNpz, HasNoNumberWhereTheCsvHasNone) {
  write("linkage.urdf", kLinkage);
  write("loops.yaml", pinned("0.5"));
  const std::string rest = ",0,0,0,0,0,0\n";
  write("m.csv",
        "time,position.drive,position.elbow,position.wrist,velocity.drive,velocity.elbow,"
        "velocity.wrist,acceleration.drive,acceleration.elbow,acceleration.wrist\n0,0.5,-0.5,0.5" +
            rest + "1,1.5707963267948966,-1.5707963267948966,1.5707963267948966" + rest);
  for (const char* name : {"r.csv", "r.npz"}) {
    const Run result =
        run(std::string("--urdf linkage.urdf --scene loops.yaml --motion m.csv --output ") + name);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  EXPECT_EQ(python("z = np.load('r.npz')\n"
                   "rows = np.genfromtxt('r.csv', delimiter=',', names=True, deletechars='')\n"
                   "assert sum(np.isnan(rows[name][1]) for name in rows.dtype.names) > 0\n"
                   "for name in rows.dtype.names:\n"
                   "    np.testing.assert_array_equal(z[name], rows[name])\n"),
            "");
}

TEST_F(OfflineNpz, KeepsStampsToTheNanosecond) {
  const Run result = run(std::string("--urdf pendulum.urdf --motion '") + kSourceFolder +
                         "/test/core/bags/none.bag' --rename '.*hinge=hinge' --output r.npz");
  const Run csv = run(std::string("--urdf pendulum.urdf --motion '") + kSourceFolder +
                      "/test/core/bags/none.bag' --rename '.*hinge=hinge' --output r.csv");
  ASSERT_EQ(result.exit_code, csv.exit_code) << result.err;
  if (csv.exit_code != 0) GTEST_SKIP() << csv.err;
  EXPECT_EQ(python("z = np.load('r.npz')\n"
                   "stamps = [line.split(',')[1] for line in open('r.csv')][1:]\n"
                   "assert z['stamp'].dtype == np.dtype('datetime64[ns]')\n"
                   "ns = [int(s.split('.')[0]) * 10**9 + int(s.split('.')[1]) for s in stamps]\n"
                   "assert z['stamp'].astype(np.int64).tolist() == ns\n"),
            "");
}

TEST_F(OfflineNpz, IsReadAsTheMotionThatItIs) {
  ASSERT_EQ(compute("swing.csv", "csv.csv").exit_code, 0);
  ASSERT_EQ(
      python("c = np.genfromtxt('swing.csv', delimiter=',', names=True, deletechars='')\n"
             "np.savez('m.npz', **{n: c[n] for n in c.dtype.names[::-1]}, note=np.array('x'),\n"
             "         table=np.ones((2, 2)), **{'effort.hinge': np.full(4, np.nan)})\n"),
      "");
  const Run result = compute("m.npz", "npz.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(readFile(path("npz.csv")), readFile(path("csv.csv")));
  EXPECT_NE(result.err.find("ignored, no one-dimensional arrays of numbers: 'note' and 'table'"),
            std::string::npos)
      << result.err;
}

TEST_F(OfflineNpz, OfResultsIsAMotionAgain) {
  ASSERT_EQ(compute("swing.csv", "r.npz", "--positions").exit_code, 0);
  const Run result = compute("r.npz", "again.npz", "--positions");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(python("a, b = np.load('r.npz'), np.load('again.npz')\n"
                   "for name in a.files[:-1]:\n"
                   "    assert (a[name] == b[name]).all(), name\n"),
            "");
}

TEST_F(OfflineNpz, OfOtherNumbersIsRead) {
  ASSERT_EQ(compute("swing.csv", "csv.csv").exit_code, 0);
  ASSERT_EQ(python("np.savez('m.npz', time=np.array([0, 1, 2], 'i4'),\n"
                   "  **{'position.hinge': np.array([1, 2, -1], 'i8'),\n"
                   "     'velocity.hinge': np.array([0.5, 0.25, 2], 'f4'),\n"
                   "     'acceleration.hinge': np.zeros(3)})\n"),
            "");
  const Run result = compute("m.npz", "r.csv", "--positions");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(readFile(path("r.csv")));
  ASSERT_EQ(table.rows.size(), 3U);
  const auto at = [&](std::size_t row, const char* name) {
    return table.rows[row][static_cast<std::size_t>(table.column(name))];
  };
  EXPECT_EQ(at(2, "time"), 2);
  EXPECT_EQ(at(2, "position.hinge"), -1);
  EXPECT_EQ(at(1, "velocity.hinge"), 0.25);
}

TEST_F(OfflineNpz, TimesInNanosecondsMayBeNegative) {
  ASSERT_EQ(
      python("np.savez('m.npz', time=np.array([-1300000000, -300000000, 700000000], 'M8[ns]'),\n"
             "  **{'position.hinge': np.zeros(3), 'velocity.hinge': np.zeros(3),\n"
             "     'acceleration.hinge': np.zeros(3)})\n"),
      "");
  const Run result = compute("m.npz", "r.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(readFile(path("r.csv")));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0][0], -1.3);
  EXPECT_EQ(table.rows[1][0], -0.3);
  EXPECT_EQ(table.rows[2][0], 0.7);
}

TEST_F(OfflineNpz, WithSomethingWrongIsRefusedInOneLine) {
  const std::string begin = "m = {'time': np.arange(3.0), 'position.hinge': np.zeros(3)}\n";
  ASSERT_EQ(python(begin + "np.savez_compressed('m.npz', **m)\n"), "");
  expectRefused("m.npz", "is compressed; write it with numpy.savez, not numpy.savez_compressed");
  ASSERT_EQ(python(begin + "m['velocity.hinge'] = np.zeros(4)\nnp.savez('m.npz', **m)\n"), "");
  expectRefused("m.npz", "the array 'velocity.hinge' has 4 values, 'time' has 3");
  ASSERT_EQ(python(begin + "m['position.hinge'][1] = np.nan\nnp.savez('m.npz', **m)\n"), "");
  expectRefused("m.npz", "m.npz: index 1 of 'position.hinge' is nan, no number");
  ASSERT_EQ(python(begin + "m['time'] = np.array([0, 'NaT', 2], 'M8[ns]')\n" +
                   "np.savez('m.npz', **m)\n"),
            "");
  expectRefused("m.npz", "m.npz: index 1 of 'time' is nan, no number");
  ASSERT_EQ(python("np.savez('m.npz', time=np.zeros((3, 2)))\n"), "");
  expectRefused("m.npz", "has no one-dimensional arrays of numbers");
  write("text.npz", "time,position.hinge\n0,1\n1,2\n");
  expectRefused("text.npz", "text.npz: is not an .npz as numpy.savez writes it: it is no zip file");
  write("text.npz", "");
  expectRefused("text.npz", "text.npz: is not an .npz as numpy.savez writes it");
  ASSERT_EQ(python(begin + "np.savez('whole.npz', **m)\n"), "");
  const std::string whole = readFile(path("whole.npz"));
  write("m.npz", whole.substr(0, whole.size() - 30));
  expectRefused("m.npz", "its end is missing; it is cut off");
  // The place of the directory, in the four bytes before the length of the comment.
  write("m.npz",
        whole.substr(0, whole.size() - 6) + "\xff\xff\xff\x7f" + whole.substr(whole.size() - 2));
  expectRefused("m.npz", "m.npz: cannot be read as .npz: it is cut off or damaged");
}

TEST_F(OfflineNpz, ChangedAtRandomNeverEndsTheToolOtherwise) {
  ASSERT_EQ(compute("swing.csv", "r.npz", "--positions").exit_code, 0);
  const std::string whole = readFile(path("r.npz"));
  std::uint32_t random = 12345;
  for (int i = 0; i < 60; ++i) {
    std::string changed = whole;
    for (int k = 0; k < 3; ++k) {
      random = random * 1664525 + 1013904223;
      const std::size_t place = 4 + random % (whole.size() - 4);
      random = random * 1664525 + 1013904223;
      changed[place] = static_cast<char>(random >> 24);
    }
    write("m.npz", changed);
    const Run result = compute("m.npz", "no.csv");
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << i << ": " << result.err;
  }
}

TEST_F(OfflineNpz, IsNotWrittenToAPipe) {
  const Run pipe = run("--urdf pendulum.urdf --motion swing.csv --output pipe.npz",
                       "rm -f pipe.npz; mkfifo pipe.npz; cat pipe.npz >/dev/null &");
  EXPECT_EQ(pipe.exit_code, 1);
  EXPECT_NE(pipe.err.find("pipe.npz: an .npz is written to a file, not to standard output, a pipe"),
            std::string::npos)
      << pipe.err;
}

// Numbers of 64 bits, as of files beyond 4 GB, and more rows than are in memory at once.
TEST_F(OfflineNpz, BeyondFourGigabytesIsReadByNumpy) {
  constexpr std::size_t kRows = 70000;
  {
    OutputFile file(path("long.npz"));
    NpzWriter writer(file, {{"a", false}, {"b/c,d", false}}, kRows, {{"text", "hello"}}, 100);
    for (std::size_t i = 0; i < kRows; ++i) {
      writer.add(static_cast<double>(i));
      writer.add(-0.5 * static_cast<double>(i));
    }
    writer.finish();
  }
  EXPECT_EQ(python("assert zipfile.ZipFile('long.npz').testzip() is None\n"
                   "z = np.load('long.npz')\n"
                   "assert z.files == ['a', 'b/c,d', 'text'] and bytes(z['text']) == b'hello'\n"
                   "assert (z['a'] == np.arange(70000.0)).all()\n"
                   "assert (z['b/c,d'] == -0.5 * np.arange(70000)).all()\n"),
            "");
}

}  // namespace
}  // namespace virtual_work_dynamics
