#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

// Roundings of some ten operations.
constexpr double kClosedForm = 1e-12;

// A motor, an arm that hangs, and a rack, of which gears make one freedom.
constexpr char kDrive[] = R"(<robot name="drive">
  <link name="base"/>
  <link name="rotor"><inertial><mass value="0.1"/>
    <inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="bar"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
    <inertia ixx="0.03" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rail"><inertial><mass value="3"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="continuous"><parent link="base"/><child link="rotor"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="arm" type="continuous"><parent link="base"/><child link="bar"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="rack" type="prismatic"><parent link="base"/><child link="rail"/>
    <axis xyz="0 0 1"/><limit lower="-9" upper="9" effort="1e4" velocity="9"/></joint>
</robot>)";

constexpr char kScene[] = R"(
couplings:
  - {name: reducer, terms: [{name: motor, factor: 1}, {name: arm, factor: -50}], offset: 0}
  - {name: pinion, terms: [{name: rack, factor: 1}, {name: motor, factor: -0.002}]}
actuated: [motor]
)";

class OfflineCouplings : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("r.urdf", kDrive);
    write("s.yaml", kScene);
  }
  Run runWith(const std::string& options) const {
    return run("--urdf r.urdf --scene s.yaml " + options);
  }
  static bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
};

constexpr char kMotorMotion[] =
    "time,position.motor,velocity.motor,acceleration.motor\n"
    "0,0,10,20\n0.1,30,-40,300\n0.2,500,0,-7\n";

TEST_F(OfflineCouplings, MotorMovesEverything) {
  write("m.csv", kMotorMotion);
  const Run done = runWith("--motion m.csv --certificates --positions");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const NumberTable table = parseTable(done.out);
  ASSERT_EQ(table.rows.size(), 3u);
  for (const std::vector<double>& row : table.rows) {
    const auto at = [&](const std::string& name) {
      const int column = table.column(name);
      EXPECT_GE(column, 0) << name;
      return row[static_cast<std::size_t>(std::max(column, 0))];
    };
    const double turn = at("position.motor"), acceleration = at("acceleration.motor");
    EXPECT_NEAR(at("position.arm"), turn / 50, kClosedForm * 10);
    EXPECT_NEAR(at("position.rack"), 0.002 * turn, kClosedForm * 10);
    const double inertia = 0.03 + 2 * 0.25;
    const double arm = inertia * acceleration / 50 + 2 * 9.81 * 0.5 * std::sin(turn / 50);
    const double rack = 3 * (9.81 + 0.002 * acceleration);
    EXPECT_NEAR(at("effort.motor"), 1e-4 * acceleration + arm / 50 + 0.002 * rack, kClosedForm);
    EXPECT_NEAR(at("effort.reducer"), -arm / 50, kClosedForm);
    EXPECT_NEAR(at("effort.pinion"), rack, 100 * kClosedForm);
    EXPECT_EQ(at("effort.arm"), 0);
    EXPECT_EQ(at("determined.effort.reducer"), 1);
    EXPECT_LE(at("residual.position.pinion"), kClosedForm);
    EXPECT_LE(at("residual.acceleration.reducer"), 1e-10);
    EXPECT_LE(at("certificate.power"), 1e-13);
    EXPECT_LE(at("certificate.ground_moment"), 1e-13);
  }
}

TEST_F(OfflineCouplings, LagrangesEquationsFindTheSame) {
  write("m.csv", kMotorMotion);
  const Run one = runWith("--motion m.csv"), other = runWith("--motion m.csv --method lagrange");
  ASSERT_EQ(other.exit_code, 0) << other.err;
  const NumberTable table = parseTable(one.out), second = parseTable(other.out);
  ASSERT_EQ(table.header, second.header);
  ASSERT_EQ(second.rows.size(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < table.header.size(); ++i) {
      EXPECT_NEAR(table.rows[row][i], second.rows[row][i],
                  1e-10 * std::max(1.0, std::abs(table.rows[row][i])))
          << table.header[i];
    }
  }
}

TEST_F(OfflineCouplings, MotionOfAllJointsIsHeldAgainstThem) {
  const std::string header =
      "time,position.motor,position.arm,position.rack,velocity.motor,velocity.arm,velocity.rack,"
      "acceleration.motor,acceleration.arm,acceleration.rack\n";
  write("m.csv", header + "0,0,0,0,10,0.2,0.02,20,0.4,0.04\n");
  EXPECT_EQ(runWith("--motion m.csv").exit_code, 0);
  write("m.csv", header + "0,0,0,0,10,0.2,0.02,20,0.4,0.04\n0.1,1,0.02,0.03,0,0,0,0,0,0\n");
  const Run refused = runWith("--motion m.csv");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(contains(refused.err,
                       "m.csv: line 3: the positions violate coupling 'pinion' by 0.028 m or rad"))
      << refused.err;
}

TEST_F(OfflineCouplings, CheckListsThem) {
  const Run done = runWith("--check");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(contains(done.out, "couplings:    reducer (motor arm), pinion (rack motor)\n"))
      << done.out;
  EXPECT_TRUE(contains(done.out, "actuated:     motor\n")) << done.out;
  EXPECT_TRUE(contains(done.out, "passive:      arm, rack\n")) << done.out;
  EXPECT_TRUE(contains(done.out, "  degrees of freedom: 1\n")) << done.out;
  EXPECT_TRUE(contains(done.out, "  conditions of the closures and couplings: 2\n")) << done.out;
}

// Whole turns of a motor count: what a driver has left out is put back, nothing is taken away.
TEST_F(OfflineCouplings, WrappedMotorIsUnwound) {
  std::string text = "time,position.motor,velocity.motor,acceleration.motor\n";
  for (int row = 0; row < 40; ++row) {
    const double turn = 0.7 * row;
    text += std::to_string(0.01 * row) + "," + std::to_string(std::remainder(turn, 2 * M_PI)) +
            ",70,0\n";
  }
  write("m.csv", text);
  const Run done = runWith("--motion m.csv --positions");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const NumberTable table = parseTable(done.out);
  const auto arm = static_cast<std::size_t>(table.column("position.arm"));
  ASSERT_EQ(table.rows.size(), 40u);
  EXPECT_NEAR(table.rows.back()[arm], 0.7 * 39 / 50, 1e-6);
}

TEST_F(OfflineCouplings, DeviationsAndCodeAndResiduals) {
  write("m.csv", "time,position.motor\n0,0\n0.01,0.1\n0.02,0.2\n0.03,0.3\n0.04,0.4\n0.05,0.5\n");
  const Run done = runWith("--motion m.csv --deviations");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const NumberTable table = parseTable(done.out);
  EXPECT_GE(table.column("deviation.effort.reducer"), 0);
  const Run generated = runWith("--generate out.c");
  ASSERT_EQ(generated.exit_code, 0) << generated.err;
  EXPECT_TRUE(contains(readFile(path("out.h")), "OUT_EFFORT_REDUCER = "))
      << readFile(path("out.h"));
}

TEST_F(OfflineCouplings, BadEntriesAreOneLine) {
  const auto refusalOf = [&](const std::string& couplings) {
    write("s.yaml", "couplings: " + couplings + "\n");
    return runWith("--check").err;
  };
  EXPECT_TRUE(contains(refusalOf("[{name: c}]"), "couplings[0]: terms is missing"));
  EXPECT_TRUE(
      contains(refusalOf("[{terms: [{name: arm, factor: 1}]}]"), "couplings[0]: name is missing"));
  EXPECT_TRUE(contains(refusalOf("[{name: c, terms: [{name: arm}]}]"),
                       "couplings[0].terms[0]: factor is missing"));
  EXPECT_TRUE(contains(refusalOf("[{name: c, term: []}]"), "couplings[0].term"));
  EXPECT_TRUE(contains(refusalOf("3"), "couplings: expected a list"));
}

}  // namespace
}  // namespace virtual_work_dynamics
