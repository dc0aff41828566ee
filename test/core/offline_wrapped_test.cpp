// Recordings of drivers that wrap positions, through the offline tool.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <sstream>
#include <string>

#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

const double kPi = std::acos(-1.0);
// Closed forms of up to 10 N m; the estimate of a steady turn's acceleration adds rounding of
// positions of up to 20 rad over the squared window, 0.04^2 s^2, times inertias of 0.01 kg m^2.
constexpr double kClosedForm = 1e-11;

/// A wheel without weight and an arm that is geared to it one to two: 1 kg, 0.1 m from the axis y.
std::string geared(const std::string& type) {
  const std::string ends = "'><parent link='base'/><child link='";
  const std::string limit = "<limit lower='-30' upper='30' effort='1' velocity='5'/>";
  return "<robot name='geared'><link name='base'/><link name='wheel'/>"
         "<link name='arm'><inertial><origin xyz='0.1 0 0'/><mass value='1'/>"
         "<inertia ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'/></inertial></link>"
         "<joint name='j1' type='" +
         type + ends + "wheel'/><axis xyz='0 1 0'/>" + limit + "</joint><joint name='j2' type='" +
         type + ends + "arm'/><axis xyz='0 1 0'/>" + limit +
         "<mimic joint='j1' multiplier='0.5'/></joint></robot>";
}

class WrappedRecording : public OfflineTool {
 protected:
  /// Six seconds at 3 rad/s, wrapped into -pi..pi.
  std::string recording(bool derivatives) const {
    std::ostringstream csv;
    csv.precision(17);
    csv << "time,position.j1" << (derivatives ? ",velocity.j1,acceleration.j1\n" : "\n");
    for (int i = 0; i <= 600; ++i) {
      csv << 0.01 * i << "," << std::remainder(0.03 * i, 2 * kPi)
          << (derivatives ? ",3,0\n" : "\n");
    }
    return write("wrapped.csv", csv.str());
  }

  void expectEffort(const std::string& options, const std::function<double(double)>& effort) {
    const Run result = run("--urdf robot.urdf --motion wrapped.csv " + options);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(
        result.err.find("note: wrapped.csv: whole turns that a driver left out are added to the "
                        "positions of j1\n"),
        std::string::npos)
        << result.err;
    const NumberTable table = parseTable(result.out);
    ASSERT_EQ(table.rows.size(), 601u);
    const auto column = static_cast<std::size_t>(table.column("effort.j1"));
    for (const auto& row : table.rows) {
      ASSERT_NEAR(row.at(column), effort(row.at(0)), kClosedForm) << "at " << row.at(0);
    }
  }
};

TEST_F(WrappedRecording, MimicsFollowTheUnwrappedPosition) {
  for (const char* type : {"continuous", "revolute"}) {
    write("robot.urdf", geared(type));
    for (const bool derivatives : {false, true}) {
      recording(derivatives);
      expectEffort("", [](double t) { return -0.5 * 9.81 * 0.1 * std::cos(1.5 * t); });
    }
  }
}

TEST_F(WrappedRecording, SpringsAreWoundUp) {
  write("robot.urdf", geared("continuous"));
  recording(true);
  write("scene.yaml", "gravity: [0, 0, 0]\njoints: [{name: j1, stiffness: 0.4, rest: 1}]\n");
  expectEffort("--scene scene.yaml", [](double t) { return 0.4 * (3 * t - 1); });
}

}  // namespace
}  // namespace virtual_work_dynamics
