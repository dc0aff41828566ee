#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "base/number_text.h"
#include "offline_tool.h"

namespace virtual_work_dynamics {
namespace {

class OfflineFreeTurns : public OfflineTool {
 protected:
  OfflineFreeTurns() {
    write("ball.urdf",
          "<robot name='r'><link name='base'/><link name='body'><inertial>"
          "<origin xyz='0 0 0.2'/><mass value='2'/><inertia ixx='0.03' ixy='0' ixz='0' iyy='0.04'"
          " iyz='0' izz='0.05'/></inertial></link><joint name='j' type='floating'>"
          "<parent link='base'/><child link='body'/></joint></robot>");
    write("ball.yaml", "{joint_types: [{name: j, type: spherical}], reactions: [j]}");
  }

  std::string failure(const std::string& csv) {
    write("m.csv", csv);
    const Run result = run("--urdf ball.urdf --scene ball.yaml --motion m.csv --output r.csv");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_FALSE(exists("r.csv"));
    return result.err;
  }

  // The numbers of a line of the output, counted from 0 behind the header.
  std::vector<double> numbers(std::size_t line) {
    std::istringstream lines(readFile(path("r.csv")));
    std::string text;
    std::getline(lines, header_);
    for (std::size_t i = 0; i <= line; ++i) std::getline(lines, text);
    std::vector<double> found;
    std::istringstream cells(text);
    for (std::string cell; std::getline(cells, cell, ',');) found.push_back(std::stod(cell));
    return found;
  }

  std::string header_;
};

const std::string kHeader =
    "time,orientation.j.x,orientation.j.y,orientation.j.z,orientation.j.w,angular_velocity.j.x,"
    "angular_velocity.j.y,angular_velocity.j.z,angular_acceleration.j.x,angular_acceleration.j.y,"
    "angular_acceleration.j.z\n";

// On its side, with y up: the weight turns about x of the body; moments about the principal axes
// as Euler has them.
TEST_F(OfflineFreeTurns, ComeFromColumns) {
  write("m.csv", kHeader + "0,0.7071067811865476,0,0,0.7071067811865476,1,2,3,0.4,0.5,0.6\n");
  const Run result =
      run("--urdf ball.urdf --scene ball.yaml --motion m.csv --output r.csv --axes child "
          "--positions --certificates");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<double> found = numbers(0);
  EXPECT_EQ(header_.substr(0, 112),
            "time,effort.j.rx,effort.j.ry,effort.j.rz,reaction.j.fx,reaction.j.fy,reaction.j.fz,"
            "reaction.j.tx,reaction.j.ty,r");
  const double c = 0.2, m = 2, g = 9.81;
  // The body's y axis points up: weight along -y acts at c z, moment about x of the origin.
  const double ix = 0.03 + m * c * c, iy = 0.04 + m * c * c, iz = 0.05;
  EXPECT_NEAR(found[1], ix * 0.4 + (iz - iy) * 2 * 3 - m * g * c, 1e-12);
  EXPECT_NEAR(found[2], iy * 0.5 + (ix - iz) * 3 * 1, 1e-12);
  EXPECT_NEAR(found[3], iz * 0.6 + (iy - ix) * 1 * 2, 1e-12);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found[7 + i], found[1 + i]);
  // The motion that was used, in the columns that it was read from.
  EXPECT_NE(header_.find("orientation.j.x,orientation.j.y,orientation.j.z,orientation.j.w,"
                         "angular_velocity.j.x"),
            std::string::npos);
  const std::vector<double> tail(found.end() - 10, found.end());
  const std::vector<double> expected{std::sqrt(0.5), 0, 0, std::sqrt(0.5), 1, 2, 3, 0.4, 0.5, 0.6};
  for (std::size_t i = 0; i < tail.size(); ++i) EXPECT_NEAR(tail[i], expected[i], 1e-15) << i;
}

TEST_F(OfflineFreeTurns, MayBeInDegreesAndOfAnotherName) {
  const double degree = std::acos(-1.0) / 180;
  const auto row = [](const std::string& orientation, const std::vector<double>& rates) {
    std::string text = "0," + orientation;
    for (const double rate : rates) text += "," + numberText(rate);
    return text + "\n";
  };
  const std::vector<double> in_degrees{60, 120, 180, 24, 30, 36};
  std::vector<double> rates;
  for (const double rate : in_degrees) rates.push_back(degree * rate);
  std::string renamed = kHeader;
  for (std::size_t at; (at = renamed.find(".j.")) != std::string::npos;) {
    renamed.replace(at, 3, ".old_j.");
  }
  write("m.csv", kHeader + row("0.5,0.5,0.5,0.5", rates));
  write("d.csv", renamed + row("0.5,0.5,0.5,0.5", in_degrees));
  ASSERT_EQ(run("--urdf ball.urdf --scene ball.yaml --motion m.csv --output r.csv").exit_code, 0);
  const std::vector<double> expected = numbers(0);
  const Run result =
      run("--urdf ball.urdf --scene ball.yaml --motion d.csv --output r.csv --degrees "
          "--rename 'old_(.*)=\\1'");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<double> found = numbers(0);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-5) << i;
}

TEST_F(OfflineFreeTurns, RatesOfARootMayBeInDegrees) {
  write("root.yaml", "{root: moving, reactions: [ground]}");
  write("body.urdf",
        "<robot name='r'><link name='body'><inertial><mass value='2'/><inertia ixx='0.03' ixy='0'"
        " ixz='0' iyy='0.04' iyz='0' izz='0.05'/></inertial></link></robot>");
  const std::string header =
      "time,root.orientation.x,root.orientation.y,root.orientation.z,root.orientation.w,"
      "root.acceleration.x,root.acceleration.y,root.acceleration.z,root.angular_velocity.x,"
      "root.angular_velocity.y,root.angular_velocity.z,root.angular_acceleration.x,"
      "root.angular_acceleration.y,root.angular_acceleration.z\n";
  write("m.csv", header + "0,0,0,0,1,0,0,0,0,0,0,180,0,0\n");
  const Run result =
      run("--urdf body.urdf --scene root.yaml --motion m.csv --output r.csv --degrees");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(numbers(0)[4], 0.03 * std::acos(-1.0), 1e-12);
}

// By Lagrange's equations the same.
TEST_F(OfflineFreeTurns, ComeFromColumnsForLagrangesEquations) {
  write("m.csv", kHeader + "0,0.5,0.5,0.5,0.5,1,2,3,0.4,0.5,0.6\n");
  run("--urdf ball.urdf --scene ball.yaml --motion m.csv --output r.csv");
  const std::vector<double> recursion = numbers(0);
  run("--urdf ball.urdf --scene ball.yaml --motion m.csv --output r.csv --method lagrange");
  const std::vector<double> lagrange = numbers(0);
  ASSERT_EQ(recursion.size(), lagrange.size());
  for (std::size_t i = 0; i < lagrange.size(); ++i) EXPECT_NEAR(lagrange[i], recursion[i], 1e-12);
}

// A turn at 2 rad/s about z, read from orientations of either sign.
TEST_F(OfflineFreeTurns, AreEstimatedFromOrientations) {
  std::string csv = "time,orientation.j.x,orientation.j.y,orientation.j.z,orientation.j.w\n";
  for (int i = 0; i < 200; ++i) {
    const double t = 0.01 * i, sign = i % 3 == 0 ? -1 : 1;
    csv += numberText(t) + ",0,0," + numberText(sign * std::sin(t)) + "," +
           numberText(sign * std::cos(t)) + "\n";
  }
  write("m.csv", csv);
  const Run result =
      run("--urdf ball.urdf --scene ball.yaml --motion m.csv --output r.csv --positions");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(
      result.err.find("estimated: angular_velocity.j.{x,y,z}, angular_acceleration.j.{x,y,z}"),
      std::string::npos)
      << result.err;
  const std::vector<double> found = numbers(100);
  EXPECT_NEAR(found[found.size() - 4], 2, 1e-3);
}

TEST_F(OfflineFreeTurns, AreRefusedInOneLine) {
  EXPECT_NE(failure("time,position.j.rx\n0,0\n")
                .find("m.csv: column 'position.j.rx': this joint turns freely, its orientation is "
                      "given by orientation.<joint>.{x,y,z,w}"),
            std::string::npos);
  EXPECT_NE(failure("time\n0\n").find("m.csv: columns are missing: orientation.j.{x,y,z,w}\n"),
            std::string::npos);
  EXPECT_NE(
      failure("time,orientation.j.x\n0,0\n")
          .find("column 'orientation.j.y' is missing, though other components of it are there"),
      std::string::npos);
  EXPECT_NE(
      failure("time,angular_velocity.j.x,angular_velocity.j.y,angular_velocity.j.z\n0,0,0,0\n")
          .find("columns are missing: orientation.j.{x,y,z,w}\n"),
      std::string::npos);
  EXPECT_NE(failure("time,orientation.j.x,orientation.j.y,orientation.j.z,orientation.j.w\n"
                    "0,0,0,0,1.01\n")
                .find("m.csv: line 2: orientation.j.{x,y,z,w} has the length 1.01, not 1\n"),
            std::string::npos);
  EXPECT_NE(failure("time,orientation.j.q\n0,0\n").find("orientation.<joint>.{x,y,z,w}"),
            std::string::npos);
}

TEST_F(OfflineFreeTurns, WithRoundedOrientationsAreScaledWithAWarning) {
  write("m.csv", kHeader + "0,0,0,0,1.0005,0,0,0,0,0,0\n");
  const Run result = run("--urdf ball.urdf --scene ball.yaml --motion m.csv --output r.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(
      result.err.find("lengths of orientation.j are up to 0.0005 off 1; they are scaled to 1"),
      std::string::npos)
      << result.err;
}

// The floating joint of the description itself: its slides have positions.
TEST_F(OfflineFreeTurns, OfFloatingJointsHavePositions) {
  write("m.csv",
        "time,position.j.x,position.j.y,position.j.z,velocity.j.x,velocity.j.y,velocity.j.z,"
        "acceleration.j.x,acceleration.j.y,acceleration.j.z,orientation.j.x,orientation.j.y,"
        "orientation.j.z,orientation.j.w,angular_velocity.j.x,angular_velocity.j.y,"
        "angular_velocity.j.z,angular_acceleration.j.x,angular_acceleration.j.y,"
        "angular_acceleration.j.z\n0,1,2,3,0,0,0,0,0,-9.81,0,0,0,1,0,0,0,0,0,0\n");
  const Run result = run("--urdf ball.urdf --motion m.csv --output r.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<double> found = numbers(0);
  EXPECT_EQ(header_.rfind("time,effort.j.x,effort.j.y,effort.j.z,effort.j.rx", 0), 0u) << header_;
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_NEAR(found[i], 0, 1e-14) << i;
}

TEST_F(OfflineFreeTurns, StandInTheReportOfTheRobot) {
  const Run result = run("--urdf ball.urdf --scene ball.yaml --check");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("joints:       1 spherical\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("links:        2, root base\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("j.rx"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace virtual_work_dynamics
