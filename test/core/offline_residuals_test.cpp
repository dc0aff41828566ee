#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kRows = 400;
constexpr double kStep = 0.005;  // s

struct State {
  double q, qd, qdd;
};

State stateAt(double t) {
  return {0.4 * std::sin(2 * t) + 0.2 * std::sin(5.1 * t),
          0.8 * std::cos(2 * t) + 1.02 * std::cos(5.1 * t),
          -1.6 * std::sin(2 * t) - 5.202 * std::sin(5.1 * t)};
}

// The bob of kPendulum: 2 kg, 0.5 m below the hinge, 0.03 kg m^2 about its centre.
double effortAt(double t) {
  const State at = stateAt(t);
  return (0.03 + 2 * 0.25) * at.qdd + 2 * 9.81 * 0.5 * std::sin(at.q);
}

std::string row(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    char number[40];
    std::snprintf(number, sizeof number, "%.17g", value);
    text += (text.empty() ? "" : ",") + std::string(number);
  }
  return text + "\n";
}

class OfflineResiduals : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("p.urdf", kPendulum);
    writeMotion("m.csv", nullptr);
  }

  // A motion with all derivatives; with a column of efforts where there is a law of them.
  void writeMotion(const std::string& name, const std::function<double(double)>& effort) const {
    std::string text = "time,position.hinge,velocity.hinge,acceleration.hinge";
    text += effort ? ",effort.hinge\n" : "\n";
    for (int i = 0; i < kRows; ++i) {
      const double t = i * kStep;
      const State at = stateAt(t);
      text += effort ? row({t, at.q, at.qd, at.qdd, effort(t)}) : row({t, at.q, at.qd, at.qdd});
    }
    write(name, text);
  }

  Run computed(const std::string& options) const {
    return run("--urdf p.urdf --reactions none " + options);
  }
};

// Cells of a column, which must be there.
std::vector<double> column(const NumberTable& table, const std::string& name) {
  std::vector<double> values;
  const int place = table.column(name);
  EXPECT_GE(place, 0) << name;
  for (const auto& cells : table.rows) {
    if (place >= 0) values.push_back(cells[static_cast<std::size_t>(place)]);
  }
  return values;
}

TEST_F(OfflineResiduals, AreComputedLessMeasuredWhichIsTheExternalEffort) {
  // A hand pushes with 0.7 N m along the joint: the motor delivers so much less.
  writeMotion("m.csv", [](double t) { return effortAt(t) - 0.7; });
  const Run result = computed("--motion m.csv --residuals");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  const auto measured = column(table, "measured_effort.hinge");
  const auto residual = column(table, "measured_residual.hinge");
  ASSERT_EQ(residual.size(), static_cast<std::size_t>(kRows));
  for (int i = 0; i < kRows; ++i) {
    EXPECT_EQ(measured[i], effortAt(i * kStep) - 0.7);
    EXPECT_NEAR(residual[i], 0.7, 1e-12);
  }
  EXPECT_EQ(result.err.find("ignored"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("VAF"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("hinge         400      1.0000         0.7         0.7  N m"),
            std::string::npos)
      << result.err;
}

TEST_F(OfflineResiduals, AreNotThereUnlessAskedFor) {
  writeMotion("m.csv", effortAt);
  const Run result = computed("--motion m.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.find("measured"), std::string::npos);
  EXPECT_EQ(result.err.find("VAF"), std::string::npos);
  EXPECT_NE(result.err.find("ignored, no motion: 'effort.hinge'"), std::string::npos) << result.err;
}

TEST_F(OfflineResiduals, ReadAnotherFileAtTheInstantsOfTheRows) {
  // On a straight line in time, with stamps of its own, a gap from 1 s to 1.4 s, and nothing before
  // 0.2 s or after 1.8 s.
  std::string text = "time,effort.hinge,effort.valve\n";
  for (double t = 0.2; t < 1.8; t += 0.0137) {
    if (t < 1 || t > 1.4) text += row({t, 3 * t - 1, 7});
  }
  write("efforts.csv", text);
  const Run result = computed("--motion m.csv --measured efforts.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto measured = column(parseTable(result.out), "measured_effort.hinge");
  const auto residual = column(parseTable(result.out), "measured_residual.hinge");
  int known = 0;
  for (int i = 0; i < kRows; ++i) {
    const double t = i * kStep;
    const bool inside = (t >= 0.2 && t < 0.98) || (t > 1.42 && t < 1.78);
    const bool outside = t < 0.2 || (t > 1.02 && t < 1.38) || t > 1.81;
    if (inside) {
      // Instants are rounded to nanoseconds.
      EXPECT_NEAR(measured[i], 3 * t - 1, 1e-8) << t;
      EXPECT_NEAR(residual[i], effortAt(t) - (3 * t - 1), 1e-8) << t;
      ++known;
    } else if (outside) {
      EXPECT_TRUE(std::isnan(measured[i])) << t;
      EXPECT_TRUE(std::isnan(residual[i])) << t;
    }
  }
  EXPECT_GT(known, 200);
  EXPECT_NE(result.err.find("none is computed, of 'valve'"), std::string::npos) << result.err;
}

TEST_F(OfflineResiduals, OfAnNpzAreThoseOfTheCsv) {
  writeMotion("m.csv", [](double t) { return effortAt(t) - 0.7; });
  const std::string make =
      "import numpy as np; c = np.genfromtxt('m.csv', delimiter=',', names=True, deletechars=''); "
      "np.savez('m.npz', **{n: c[n] for n in c.dtype.names})";
  ASSERT_EQ(std::system(("cd '" + folder() + "' && /usr/bin/python3 -c \"" + make + "\"").c_str()),
            0);
  const Run csv = computed("--motion m.csv --residuals");
  for (const char* from : {"--motion m.npz --residuals", "--motion m.csv --measured m.npz"}) {
    const Run npz = computed(from);
    ASSERT_EQ(npz.exit_code, 0) << npz.err;
    EXPECT_EQ(npz.out, csv.out) << from;
  }
}

TEST_F(OfflineResiduals, TakeANameOrARangeOfNamesThatRulesTurnIntoJoints) {
  std::string text = "time,tau1..3\n";
  for (int i = 0; i < kRows; ++i) text += row({i * kStep, 1, 2.5, 3});
  write("efforts.csv", text);
  const Run result = computed("--motion m.csv --measured efforts.csv --rename tau2=hinge");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(column(parseTable(result.out), "measured_effort.hinge")[17], 2.5);
}

TEST_F(OfflineResiduals, LeaveColumnsOfTextAndSaySo) {
  std::string text = "time,mode,hinge,note,effort.hinge_2\n";
  for (int i = 0; i < kRows; ++i) {
    text += row({i * kStep}).substr(0, row({i * kStep}).size() - 1) + ",auto,2.5," +
            (i < 7 ? "" : "\"slow, then fast\"") + ",1\n";
  }
  write("efforts.csv", text);
  const Run result = computed("--motion m.csv --measured efforts.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(column(parseTable(result.out), "measured_effort.hinge")[17], 2.5);
  EXPECT_NE(result.err.find("efforts.csv: line 2: column 'mode' is not taken for efforts, as it "
                            "begins with 'auto'"),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("efforts.csv: line 9: column 'note' is not taken"), std::string::npos)
      << result.err;
  // A text behind numbers, or in a column that says it has efforts, is a fault.
  write("efforts.csv", "time,hinge\n0,1\n0.1,high\n");
  const Run bare = computed("--motion m.csv --measured efforts.csv");
  EXPECT_EQ(bare.exit_code, 1);
  EXPECT_NE(bare.err.find("line 3, column 2: 'high' is not a finite number"), std::string::npos)
      << bare.err;
  write("efforts.csv", "time,effort.hinge\n0,high\n0.1,1\n");
  const Run named = computed("--motion m.csv --measured efforts.csv");
  EXPECT_EQ(named.exit_code, 1);
  EXPECT_NE(named.err.find("line 2, column 2: 'high' is not a finite number"), std::string::npos)
      << named.err;
}

TEST_F(OfflineResiduals, OfABagAreThoseOfItsOwnMessages) {
  const std::string bag = std::string(kSourceFolder) + "/test/core/bags/none.bag";
  const Run result = computed("--motion " + bag + " --residuals");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  const auto effort = column(table, "effort.hinge"),
             residual = column(table, "measured_residual.hinge");
  ASSERT_EQ(residual.size(), 40U);
  for (std::size_t i = 0; i < residual.size(); ++i) EXPECT_EQ(residual[i], effort[i] - 10);
  const Run other = computed("--motion " + bag + " --measured " + kSourceFolder +
                             "/test/core/bags/two_robots.bag --measured-topic /right/joint_states");
  ASSERT_EQ(other.exit_code, 0) << other.err;
  EXPECT_EQ(column(parseTable(other.out), "measured_effort.hinge")[3], 20);
}

TEST_F(OfflineResiduals, OfWhatOtherProgramsWrote) {
  const std::string echoed = std::string(kSourceFolder) + "/test/core/bags/echo.csv";
  const Run result = computed("--motion " + echoed + " --residuals");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(column(parseTable(result.out), "measured_effort.hinge")[1], 10);
  std::string text = "__time,/joint_states/hinge/position,/joint_states/hinge/effort\n";
  for (int i = 0; i < 50; ++i) text += row({1 + i * 0.01, stateAt(i * 0.01).q, i / 8.0});
  write("juggled.csv", text);
  const Run juggled = computed("--motion juggled.csv --residuals");
  ASSERT_EQ(juggled.exit_code, 0) << juggled.err;
  EXPECT_EQ(column(parseTable(juggled.out), "measured_effort.hinge")[20], 2.5);
}

TEST_F(OfflineResiduals, HaveTheDeviationOfTheComputedEffort) {
  std::string text = "time,position.hinge,effort.hinge\n";
  for (int i = 0; i < kRows; ++i) {
    const double noise = 1e-4 * std::sin(1e4 * i * i);
    text += row({i * kStep, stateAt(i * kStep).q + noise, effortAt(i * kStep)});
  }
  write("noisy.csv", text);
  write("tolerances.yaml", "tolerances: {mass: 0.01}\n");
  const Run result =
      computed("--motion noisy.csv --residuals --deviations --scene tolerances.yaml");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const NumberTable table = parseTable(result.out);
  const auto motion = column(table, "deviation.effort.hinge");
  const auto description = column(table, "tolerance.effort.hinge");
  const auto residual = column(table, "deviation.measured_residual.hinge");
  double largest = 0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    EXPECT_NEAR(residual[i], std::hypot(motion[i], description[i]), 1e-15 + 1e-14 * residual[i]);
    largest = std::max(largest, std::min(motion[i], description[i]));
  }
  EXPECT_GT(largest, 1e-3);  // both have a share
}

TEST_F(OfflineResiduals, HaveAMomentumObserverBesideThem) {
  // A hand pushes from 0.5 s on; from 1 s to 1.4 s nothing was recorded.
  constexpr double kGain = 40;
  std::string text = "time,position.hinge,velocity.hinge,acceleration.hinge,effort.hinge\n";
  std::vector<double> times;
  for (int i = 0; i < 10 * kRows; ++i) {
    const double t = i * kStep / 10;
    if (t > 1 && t < 1.4) continue;
    times.push_back(t);
    const State at = stateAt(t);
    text += row({t, at.q, at.qd, 1e3, effortAt(t) - (t < 0.5 ? 0 : 0.7)});
  }
  write("m.csv", text);
  const Run result = computed("--motion m.csv --observer-gain 40");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto external = column(parseTable(result.out), "external_effort.hinge");
  ASSERT_EQ(external.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i];
    const double since = t < 1.2 ? std::max(0.0, t - 0.5) : t - 1.4;
    // Trapezoids of half a millisecond: the jump is off by up to half a step of it.
    const double jump = t < 1.2 ? kGain * kStep / 20 * 0.7 : 1e-3;
    EXPECT_NEAR(external[i], 0.7 * (1 - std::exp(-kGain * since)), jump) << t;
  }
  write("passive.yaml", "actuated: []\n");
  const Run refused = computed("--motion m.csv --observer-gain 40 --scene passive.yaml");
  EXPECT_NE(refused.exit_code, 0);
  write("static.yaml", "motion: static\n");
  const Run still = computed("--motion m.csv --observer-gain 40 --scene static.yaml");
  EXPECT_NE(still.err.find("static.yaml: momentum observer: a static scene has no momentum"),
            std::string::npos)
      << still.err;
}

TEST_F(OfflineResiduals, RefuseInOneLineWhatCannotBeCompared) {
  write("others.csv", "time,effort.elbow\n0,1\n");
  write("late.csv", "time,effort.hinge\n100,1\n101,1\n");
  write("bare.csv", "time,position.hinge\n0,1\n");
  write("twice.csv", "time,hinge,effort.hinge\n0,1,1\n");
  write("ragged.csv", "time,effort.hinge\n0,1\n1\n");
  write("word.csv", "time,effort.hinge\n0,many\n");
  write("timeless.csv", "effort.hinge\n1\n");
  write("huge.csv", "time,effort.hinge\n1e18,1\n");
  write("empty_cells.csv", "time,effort.hinge\n0,\n1,nan\n");
  const std::pair<const char*, const char*> kCases[] = {
      {"--measured others.csv", "no measured effort is one of the robot's: they are of 'elbow'"},
      {"--measured late.csv",
       "efforts were measured from 100 s to 101 s, and the motion is from 0 s "
       "to 1.995 s: no row has a measured effort"},
      {"--measured bare.csv", "bare.csv: line 1: no column effort.<joint>"},
      {"--measured twice.csv", "line 1: two columns are efforts of 'hinge'"},
      {"--measured ragged.csv", "line 3: 2 cells expected as in the header, 1 found"},
      {"--measured word.csv", "line 2, column 2: 'many' is not a finite number"},
      {"--measured timeless.csv", "line 1: column 'time' is missing"},
      {"--measured huge.csv", "huge.csv: line 2: the time 1e+18 s is beyond"},
      {"--measured empty_cells.csv", "empty_cells.csv: has no efforts that were measured"},
      {"--measured none.csv", "none.csv: "},
      {"--residuals", "m.csv: line 1: no column effort.<joint>"},
      {"--observer-gain 0", "--observer-gain: '0' is not a positive number"},
      {"--residuals --no-efforts", "--residuals: need the efforts that --no-efforts leaves out"}};
  for (const auto& [options, expected] : kCases) {
    SCOPED_TRACE(options);
    const Run result = computed(std::string("--motion m.csv --output r.csv ") + options);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_NE(result.err.find(expected), std::string::npos) << result.err;
    EXPECT_FALSE(exists("r.csv"));
  }
  const Run piped = run("--urdf p.urdf --motion - --residuals", "cat m.csv |");
  EXPECT_NE(piped.err.find("can be read only once"), std::string::npos) << piped.err;
  const Run overwritten = computed("--motion m.csv --measured late.csv --output late.csv");
  EXPECT_NE(overwritten.err.find("would overwrite the input"), std::string::npos);
}

TEST_F(OfflineResiduals, ListEffortsBeyondTheLimitsOfTheDescription) {
  const std::string bare(kPendulum);
  const std::size_t place = bare.find("<axis xyz=\"0 1 0\"/></joint>");
  ASSERT_NE(place, std::string::npos);
  std::string limited = bare;
  limited.insert(place, "<limit effort=\"3\" velocity=\"9\"/>");
  write("limited.urdf", limited);
  const Run result = run("--urdf limited.urdf --reactions none --motion m.csv --effort-limits");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  int rows = 0;
  double first = -1, last = 0, peak = 0, at = 0;
  for (int i = 0; i < kRows; ++i) {
    const double t = i * kStep, effort = effortAt(t);
    if (std::abs(effort) <= 3) continue;
    ++rows;
    if (first < 0) first = t;
    last = t;
    if (std::abs(effort) > std::abs(peak)) {
      peak = effort;
      at = t;
    }
  }
  ASSERT_GT(rows, 3);
  std::ostringstream expected;
  expected << "warning: m.csv: effort of 'hinge' is beyond its limit 3 in " << rows << " rows from "
           << first << " s to " << last << " s, at most " << peak;
  // The tool writes all digits of the peak.
  EXPECT_NE(result.err.find(expected.str().substr(0, expected.str().size() - 1)), std::string::npos)
      << result.err << expected.str();
  std::ostringstream when;
  when << " at " << at << " s\n";
  EXPECT_NE(result.err.find(when.str()), std::string::npos) << result.err << when.str();
  const Run none = computed("--motion m.csv --effort-limits");
  EXPECT_NE(none.err.find("no effort is beyond its limit; 0 of 1 joints have one"),
            std::string::npos)
      << none.err;
}

TEST_F(OfflineResiduals, OfSomeJointsLeaveTheOthers) {
  write("two.urdf", R"(<robot name="two"><link name="base"/>
    <link name="a"><inertial><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <link name="b"><inertial><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="first" type="prismatic"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="second" type="continuous"><parent link="a"/><child link="b"/></joint></robot>)");
  std::string text = "time,position.first,position.second,effort.first\n";
  for (int i = 0; i < 50; ++i) text += row({i * 0.01, 0.1, 0.2, 18});
  write("two.csv", text);
  const Run result = run("--urdf two.urdf --reactions none --residuals --motion two.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(column(parseTable(result.out), "measured_residual.first")[9], 2 * 9.81 - 18, 1e-9);
  EXPECT_EQ(result.out.find("measured_residual.second"), std::string::npos);
  EXPECT_NE(result.err.find("has no measured effort of 'second'"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace virtual_work_dynamics
