#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "offline_tool.h"

// What seems to be in another unit is computed as it is said, and asked about.

namespace virtual_work_dynamics {
namespace {

class OfflineUnits : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    std::string crane = kCrane;
    // Of the inertia of its tool is asked, too.
    const std::string needle = "<inertia ixx=\"0\" iyy=\"0\"",
                      sound = "<inertia ixx=\"2e-6\" iyy=\"2e-6\"";
    crane.replace(crane.find(needle), needle.size(), sound);
    write("c.urdf", crane);
  }

  // A recording of the crane that lacks derivatives.
  void record(double step, double slide) const {
    std::string csv = "time,position.slide,position.shoulder\n";
    for (int i = 0; i < 40; ++i) {
      csv += std::to_string(step * i) + "," + std::to_string(slide * (1 + std::sin(0.1 * i)) / 2) +
             ",0.2\n";
    }
    write("m.csv", csv);
  }

  void expectAsked(const std::string& arguments, const std::string& question) const {
    const Run result = run("--urdf c.urdf --motion m.csv " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("warning: ") != std::string::npos, !question.empty()) << result.err;
    EXPECT_NE(result.err.find(question), std::string::npos) << result.err;
  }
};

TEST_F(OfflineUnits, PositionsOfSlidesInMillimetres) {
  record(0.01, 0.9);
  expectAsked("", "");
  record(0.01, 900);
  expectAsked("", "positions of 'slide' reach 89");
  expectAsked("", ", its limit is 1 m: are they millimetres?\n");
}

TEST_F(OfflineUnits, TimesInMilliseconds) {
  record(10, 0.9);
  expectAsked("",
              "warning: m.csv: 10 s from row to row, and derivatives have to be estimated: are "
              "times milliseconds?\n");
  record(1, 0.2);  // at 1 kHz, 10 m/s
  expectAsked("", "m.csv: 1 s from row to row, and derivatives have to be estimated");
  // A slow axis, once a second: 45 m/s if these were milliseconds, and one that hardly moves.
  record(1, 0.9);
  expectAsked("", "");
  record(1, 0.001);
  expectAsked("", "");
}

TEST_F(OfflineUnits, GravityInMillimetres) {
  record(0.01, 0.9);
  write("g.yaml", "gravity: [0, 0, -9810]\n");
  const std::string question = "warning: g.yaml: gravity: [0, 0, -9810] m/s^2: is it in mm/s^2?\n";
  expectAsked("--scene g.yaml", question);
  const Run check = run("--check --urdf c.urdf --scene g.yaml");
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_NE(check.out.find(question), std::string::npos) << check.out;
  EXPECT_NE(check.out.find("\ngravity:      0 0 -9810 m/s^2\n"), std::string::npos) << check.out;
  // Of a centrifuge of 50 g.
  write("g.yaml", "gravity: [0, 0, -490]\n");
  expectAsked("--scene g.yaml", "");
}

TEST_F(OfflineUnits, AnglesOfClosuresInDegrees) {
  const std::string scene =
      "actuated: [slide]\nclosures: [{name: pin, type: cylindrical, parent: {link: base, rpy: "
      "[ANGLE, 0, 0]}, child: {link: boom, rpy: [ANGLE, 0, 0]}}]\n";
  for (const auto& [angle, doubts] :
       {std::make_pair("-1.5707963267948966", 0), std::make_pair("-90", 2)}) {
    std::string text = scene;
    for (std::size_t at; (at = text.find("ANGLE")) != std::string::npos;)
      text.replace(at, 5, angle);
    write("s.yaml", text);
    const std::string out = run("--check --urdf c.urdf --scene s.yaml").out;
    int found = 0;
    for (const char* side : {"parent", "child"}) {
      found += out.find(std::string("warning: s.yaml: closures: 'pin': rpy of its ") + side +
                        " [-90, 0, 0] rad: are they degrees?\n") != std::string::npos;
    }
    EXPECT_EQ(found, doubts) << out;
  }
}

TEST_F(OfflineUnits, PayloadsInGrams) {
  record(0.01, 0.9);
  write("p.yaml", "payload: [{link: tool, mass: 2500, at: [0, 0, 0]}]\n");
  expectAsked(
      "--scene p.yaml",
      "warning: p.yaml: payload: 2500 kg on link 'tool' of a robot of 6.25 kg: is it in g?\n");
  // Of a jack that lifts 25 times what it weighs.
  write("p.yaml", "payload: [{link: tool, mass: 156, at: [0, 0, 0]}]\n");
  expectAsked("--scene p.yaml", "");
}

// A swing with its own derivatives, times these factors.
std::string swing(double velocity, double acceleration, double step = 0.01, double rate = 3) {
  std::ostringstream csv;
  csv << "time,position.hinge,velocity.hinge,acceleration.hinge\n";
  for (int i = 0; i < 100; ++i) {
    const double t = step * i;
    csv << t << "," << std::sin(rate * t) << "," << velocity * rate * std::cos(rate * t) << ","
        << acceleration * -rate * rate * std::sin(rate * t) << "\n";
  }
  return csv.str();
}

TEST_F(OfflineUnits, DerivativesThatDoNotGoWithThePositions) {
  write("c.urdf", kPendulum);
  const struct {
    double velocity, acceleration, step;
    std::string asked;
  } kCases[] = {
      {1, 1, 0.01, ""},
      {57.29578, 57.29578, 0.01,
       "velocities of 'hinge' are 57.3 times the slope of its positions: are they degrees?\n"},
      {1, 0.10197, 0.01,
       "accelerations of 'hinge' are 0.102 times the slope of its velocities: are they multiples "
       "of g?\n"},
      {-1, 1, 0.01, "velocities of 'hinge' are -1 times the slope of its positions\n"},
      {1, 1, 0.25, ""},
      {0, 0, 0.01, ""},      // as of what is nearly at rest
      {57.3, 57.3, 2, ""}};  // too far apart to tell
  for (const auto& test : kCases) {
    write("m.csv", swing(test.velocity, test.acceleration, test.step));
    expectAsked("", test.asked);
  }
  write("m.csv", swing(57.29578, 57.29578));
  write("static.yaml", "motion: static\n");
  expectAsked("--scene static.yaml", "");
}

// What swings nearly as often as there are rows, or more often, has no slopes from row to row.
TEST_F(OfflineUnits, SwingsThatRowsDoNotResolveAreNotAskedAbout) {
  write("c.urdf", kPendulum);
  for (const double hertz : {20, 30, 35, 40, 45, 60, 85, 99, 101}) {
    write("m.csv", swing(1, 1, 0.01, 2 * 3.14159265358979 * hertz));
    expectAsked("", "");
  }
  write("m.csv", swing(57.29578, 57.29578, 0.01, 2 * 3.14159265358979 * 12));
  expectAsked("", "times the slope of its positions");
}

TEST_F(OfflineUnits, ColumnsWithoutTheirKind) {
  write("m.csv", "time,slide,shoulder\n0,0,0\n");
  const Run result = run("--urdf c.urdf --motion m.csv");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("column 'position.slide' is missing, and there is 'slide'\n"),
            std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace virtual_work_dynamics
