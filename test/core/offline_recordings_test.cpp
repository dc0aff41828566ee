#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <utility>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

constexpr double kStep = 1e-4;      // rad, of the encoder
constexpr double kInterval = 2e-3;  // s
constexpr int kRows = 3000;

// The swing of a pendulum as an encoder gives it, and what the pendulum's motor then delivers.
double position(double t) {
  return 0.6 * std::sin(2.1 * t) + 0.2 * std::sin(6 * t);
}
double velocity(double t) {
  return 1.26 * std::cos(2.1 * t) + 1.2 * std::cos(6 * t);
}
double effort(double t, double offset = 0) {
  const double qdd = -2.646 * std::sin(2.1 * t) - 7.2 * std::sin(6 * t);
  return 0.53 * qdd + 9.81 * std::sin(position(t) + offset);  // of kPendulum in offline_tool.h
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class OfflineRecordings : public OfflineTool {
 protected:
  // Writes m.csv, with velocities that are `ratio` times the true ones unless that is NaN.
  void record(double ratio = std::nan(""), double pause = 0) const {
    std::ostringstream csv;
    csv.precision(12);
    csv << "time,position.hinge" << (std::isnan(ratio) ? "" : ",velocity.hinge") << "\n";
    for (int i = 0; i < kRows; ++i) {
      const double t = kInterval * i, stamp = t + (i < kRows / 2 ? 0 : pause);
      csv << stamp << "," << std::round(position(t) / kStep) * kStep;
      if (!std::isnan(ratio)) csv << "," << ratio * velocity(t);
      csv << "\n";
    }
    write("m.csv", csv.str());
    write("p.urdf", kPendulum);
  }

  // Writes m.csv with so much added to the position of each row.
  void recordWith(const std::function<double(int row)>& offset) const {
    std::ostringstream csv;
    csv.precision(12);
    csv << "time,position.hinge\n";
    for (int i = 0; i < kRows; ++i) {
      const double t = kInterval * i;
      csv << t << "," << std::round((position(t) + offset(i)) / kStep) * kStep << "\n";
    }
    write("m.csv", csv.str());
    write("p.urdf", kPendulum);
  }

  // Root mean square of the effort's error away from the ends, N m.
  double error(const Run& result) const {
    const NumberTable table = parseTable(result.out);
    double squares = 0;
    int count = 0;
    for (int i = 100; i + 100 < kRows; ++i, ++count) {
      const double computed = table.rows.at(static_cast<std::size_t>(i)).at(1);
      squares += std::pow(computed - effort(kInterval * i), 2);
    }
    return std::sqrt(squares / count);
  }

  Run compute(const std::string& options = "") const {
    const Run result = run("--urdf p.urdf --motion m.csv --reactions none " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  }
};

TEST_F(OfflineRecordings, NoiseOfTheEncoderIsFoundAndSmoothed) {
  record();
  const Run result = compute();
  EXPECT_TRUE(says(result.err, "note: m.csv: hinge: 500 Hz, position noise 2.9e-05 rad"))
      << result.err;
  // Second differences of the rows would err by sqrt(6) kStep / sqrt(12) / kInterval^2 = 18
  // rad/s^2, and the effort by 9 N m.
  EXPECT_LT(error(result), 0.02);
}

TEST_F(OfflineRecordings, VelocitiesThatContradictThePositionsAreNotUsed) {
  record();
  const double without = error(compute());
  const std::pair<double, std::string> wrong[] = {
      {0, "stay at zero while its position moves"},
      {57.29577951, "degrees per second?"},
      {0.0174532925, "slope of its positions: are these in degrees?"},
      {0.001, "slope of its positions: are these in millimetres?"},
      {1.2, "are 1.2 times the slope"}};
  for (const auto& [ratio, text] : wrong) {
    record(ratio);
    const Run result = compute();
    EXPECT_TRUE(says(result.err, "velocities of 'hinge' are not used: they ")) << result.err;
    EXPECT_TRUE(says(result.err, text)) << result.err;
    EXPECT_LE(error(result), 1.2 * without) << ratio;
  }
  record(1);
  const Run right = compute();
  EXPECT_FALSE(says(right.err, "not used")) << right.err;
  EXPECT_LT(error(right), 0.5 * without);
}

TEST_F(OfflineRecordings, OptionsReplaceWhatIsFound) {
  record();
  const Run stiff = compute("--bandwidth 0.5");
  EXPECT_TRUE(says(stiff.err, "bandwidth 0.5 Hz")) << stiff.err;
  EXPECT_GT(error(stiff), 1) << "the swing itself is smoothed away";
  EXPECT_TRUE(says(compute("--position-noise 0.001").err, "position noise 0.001 rad"));
  EXPECT_TRUE(says(compute("--stamp-noise 0.002").err, "stamp noise 0.002 s"));
}

TEST_F(OfflineRecordings, ALagCostsWhatItCostsInTheNode) {
  record();
  const double zero_phase = error(compute());
  EXPECT_GT(error(compute("--lag 0")), 3 * zero_phase);
  EXPECT_NEAR(error(compute("--lag 0.5")), zero_phase, 0.1 * zero_phase);
}

TEST_F(OfflineRecordings, NothingIsAssumedAcrossGaps) {
  record(std::nan(""), 3);
  const Run result = compute();
  EXPECT_TRUE(says(result.err, "near the ends and near 1 gap, across which nothing is assumed"))
      << result.err;
  // A motion through the gap would stand still beside it: the rows there have slopes of their own.
  const NumberTable table = parseTable(result.out);
  for (int i = kRows / 2 - 3; i < kRows / 2 + 3; ++i) {
    EXPECT_NEAR(table.rows.at(static_cast<std::size_t>(i)).at(1), effort(kInterval * i), 1.5) << i;
  }
  EXPECT_FALSE(says(compute("--max-gap 4").err, "gap")) << "longer gaps were allowed";
}

TEST_F(OfflineRecordings, PositionsThatStandAloneAreLeftOut) {
  record();
  const double clean = error(compute());
  recordWith([](int row) { return row == 1000 || row == 2000 || row == 2001 ? -0.5 : 0; });
  const Run result = compute();
  EXPECT_TRUE(says(result.err,
                   "warning: m.csv: line 1002 and in 2 more rows: position of 'hinge' is "
                   "far from those before and after, and is left out"))
      << result.err;
  EXPECT_TRUE(says(result.err, "left out 3")) << result.err;
  EXPECT_LE(error(result), 1.05 * clean);
  EXPECT_FALSE(says(result.err, "jump")) << result.err;
}

TEST_F(OfflineRecordings, WhiteNoiseDoesNotStandAlone) {
  for (const double deviation : {0.01, 0.1}) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, deviation);
    recordWith([&](int) { return noise(random); });
    const Run result = compute();
    EXPECT_FALSE(says(result.err, "jumps")) << result.err;
    EXPECT_FALSE(says(result.err, "left out")) << result.err;
  }
}

TEST_F(OfflineRecordings, NothingIsAssumedAcrossJumps) {
  recordWith([](int row) { return row < 500 ? 0.4 : 0; });
  const Run result = compute();
  EXPECT_TRUE(says(result.err,
                   "warning: m.csv: line 502: position of 'hinge' jumps as no motion "
                   "does; nothing is assumed of the motion across it"))
      << result.err;
  const NumberTable table = parseTable(result.out);
  for (int i = 400; i < 600; ++i) {
    EXPECT_NEAR(table.rows.at(static_cast<std::size_t>(i)).at(1),
                effort(kInterval * i, i < 500 ? 0.4 : 0), 1.5)
        << i;
  }
}

TEST_F(OfflineRecordings, JointsThatAreNotRecordedMayRest) {
  write("c.urdf", kCrane);
  write("m.csv", "time,position.slide,velocity.slide,acceleration.slide\n0,0.1,0.3,0.5\n");
  write("all.csv",
        "time,position.slide,position.shoulder,velocity.slide,velocity.shoulder,"
        "acceleration.slide,acceleration.shoulder\n0,0.1,0.7,0.3,0,0.5,0\n");
  const Run rests = run("--urdf c.urdf --motion m.csv --rest shoulder=0.7");
  ASSERT_EQ(rests.exit_code, 0) << rests.err;
  EXPECT_EQ(rests.out, run("--urdf c.urdf --motion all.csv").out);
  EXPECT_EQ(run("--urdf c.urdf --motion m.csv").exit_code, 1);
  const Run unknown = run("--urdf c.urdf --motion m.csv --rest wrist=0.7");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(says(unknown.err, "has no joint 'wrist' that moves by itself")) << unknown.err;
  for (const std::string wrong : {"shoulder", "shoulder=much", "=1"}) {
    EXPECT_EQ(run("--urdf c.urdf --motion m.csv --rest " + wrong).exit_code, 2) << wrong;
  }
}

TEST_F(OfflineRecordings, OptionsOutOfRangeAreRefused) {
  record();
  for (const std::string wrong :
       {"--position-noise 0", "--velocity-noise -1", "--stamp-noise -1e-3", "--bandwidth 0",
        "--lag -0.1", "--lag nan", "--max-gap 0"}) {
    const Run result = run("--urdf p.urdf --motion m.csv " + wrong);
    EXPECT_EQ(result.exit_code, 2) << wrong;
    EXPECT_TRUE(says(result.err, wrong.substr(0, wrong.find(' ')))) << result.err;
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
