#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "base/number_text.h"
#include "offline_tool.h"
#include "tumbling_roots.h"

namespace virtual_work_dynamics {
namespace {

constexpr char kCrane[] = R"(<robot name="crane"><link name="base"><inertial>
  <origin xyz="0 0 0.1"/><mass value="5"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="jib"><inertial><origin xyz="0.4 0 0"/><mass value="2"/>
  <inertia ixx="0.01" iyy="0.2" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slew" type="continuous"><parent link="base"/><child link="jib"/>
  <origin xyz="0 0 0.5"/><axis xyz="0 1 0"/></joint></robot>)";
constexpr char kMotion[] = "time,position.slew,velocity.slew,acceleration.slew";
constexpr char kOrientation[] =
    ",root.orientation.w,root.orientation.x,root.orientation.y,root.orientation.z";
constexpr char kRates[] =
    ",root.angular_velocity.x,root.angular_velocity.y,root.angular_velocity.z"
    ",root.acceleration.x,root.acceleration.y,root.acceleration.z"
    ",root.angular_acceleration.x,root.angular_acceleration.y,root.angular_acceleration.z";
constexpr char kMoving[] = "root: moving\nreactions: [slew, ground]\n";

class OfflineRoot : public OfflineTool {
 protected:
  void SetUp() override {
    OfflineTool::SetUp();
    write("crane.urdf", kCrane);
    write("moving.yaml", kMoving);
  }

  /// Two rows of the joint, each followed by these cells.
  std::string motion(const std::string& columns, const std::string& cells) const {
    return kMotion + columns + "\n0,0.3,1,2" + cells + "\n0.1,0.4,1.2,2" + cells + "\n";
  }

  Run compute(const std::string& csv, const std::string& more = "--scene moving.yaml") {
    write("m.csv", csv);
    return run("--urdf crane.urdf --motion m.csv " + more);
  }

  /// The numbers of a row of the result.
  static std::vector<double> row(const std::string& text, int index) {
    std::istringstream lines(text);
    std::string line, cell;
    for (int i = 0; i <= index + 1; ++i) std::getline(lines, line);
    std::istringstream cells(line);
    std::vector<double> numbers;
    while (std::getline(cells, cell, ',')) numbers.push_back(std::stod(cell));
    return numbers;
  }
};

// The tool's columns on a root that turns at w about the vertical axis of the joint's pole: what
// Newton and Euler say of a point on a turntable, by hand.
TEST_F(OfflineRoot, OnATurntableIsThatByHand) {
  const double w = 3, epsilon = 0.7, q = 0.3, qd = 1, qdd = 2;
  const Run found =
      compute(motion(std::string(kOrientation) + kRates, ",1,0,0,0,0,0,3,0,0,0,0,0,0.7"));
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.err, "");
  const std::vector<double> first = row(found.out, 0);
  // The mass is at 0.4 (cos q, 0, -sin q) from the pin; I is the jib's about its own axes.
  const double r = 0.4, m = 2, I = 0.2, I_axial = 0.01, g = 9.81;
  const double c = std::cos(q), s = std::sin(q);
  const double effort =
      (I + m * r * r) * qdd + (I + m * r * r - I_axial) * w * w * s * c - m * g * r * c;
  EXPECT_NEAR(first[1], effort, 1e-13);
  // Force on the jib in root axes: m times the acceleration of a point that moves on a turntable.
  const double x = r * c, xd = -r * s * qd, xdd = -r * c * qd * qd - r * s * qdd;
  const double zdd = r * s * qd * qd - r * c * qdd;
  EXPECT_NEAR(first[8], m * (xdd - w * w * x), 1e-13);
  EXPECT_NEAR(first[9], m * (2 * w * xd + epsilon * x), 1e-13);
  EXPECT_NEAR(first[10], m * (zdd + g), 1e-13);
}

TEST_F(OfflineRoot, IsTheSameByEveryRoute) {
  const std::string csv =
      motion(std::string(kOrientation) + kRates, ",0.5,-0.5,0.5,0.5,1,-2,3,4,-5,6,0.5,2,-3");
  const Run found = compute(csv);
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const Run lagrange = compute(csv, "--scene moving.yaml --method lagrange");
  const Run threads = compute(csv, "--scene moving.yaml --threads 2");
  EXPECT_EQ(found.out, threads.out);
  for (int i = 0; i < 2; ++i) {
    const std::vector<double> one = row(found.out, i), other = row(lagrange.out, i);
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t j = 0; j < one.size(); ++j) EXPECT_NEAR(one[j], other[j], 1e-12) << j;
  }
  const Run certified = compute(csv, "--scene moving.yaml --certificates");
  EXPECT_EQ(certified.exit_code, 0);
  EXPECT_LE(row(certified.out, 1).back(), 1e-14);
}

// In static scenes the attitude counts, and it alone.
TEST_F(OfflineRoot, OfAStaticSceneIsTilted) {
  write("static.yaml", std::string(kMoving) + "motion: static\n");
  const double half = std::sqrt(0.5);
  const std::string quarter = "," + numberText(half) + ",0," + numberText(half) + ",0";
  const Run tilted = compute(motion(kOrientation, quarter), "--scene static.yaml");
  ASSERT_EQ(tilted.exit_code, 0) << tilted.err;
  write("m.csv", motion("", ""));
  write("rests.yaml", "gravity: [9.81, 0, 0]\nreactions: [slew, ground]\nmotion: static\n");
  const Run rests = run("--urdf crane.urdf --motion m.csv --scene rests.yaml");
  ASSERT_EQ(rests.exit_code, 0) << rests.err;
  const std::vector<double> one = row(tilted.out, 0), other = row(rests.out, 0);
  for (std::size_t j = 0; j < one.size(); ++j) EXPECT_NEAR(one[j], other[j], 1e-13) << j;
}

// What poses, with or without their rates, make of a tumbling root's effort and reactions, against
// those of its closed form.
TEST_F(OfflineRoot, RatesThatAreMissingAreEstimated) {
  constexpr int kRows = 800, kEnd = 60;
  const auto table = [](const std::string& columns, const auto& numbers) {
    std::ostringstream text;
    text.precision(17);
    text << kMotion << columns << "\n";
    for (int i = 0; i < kRows; ++i) {
      const double t = 0.005 * i;
      text << t << "," << std::sin(t) << "," << std::cos(t) << "," << -std::sin(t);
      for (const double number : numbers(TumblingRoot().at(t))) text << "," << number;
      text << "\n";
    }
    return text.str();
  };
  const auto orientation = [](const RootMotion& root) {
    const Eigen::Quaterniond& q = root.orientation;
    return std::vector<double>{q.w(), q.x(), q.y(), q.z()};
  };
  const auto add = [](std::vector<double>& numbers, const Eigen::Vector3d& vector) {
    numbers.insert(numbers.end(), vector.data(), vector.data() + 3);
  };
  const Run exact = compute(table(std::string(kOrientation) + kRates, [&](const RootMotion& root) {
    std::vector<double> numbers = orientation(root);
    add(numbers, root.angular_velocity);
    add(numbers, root.acceleration);
    add(numbers, root.angular_acceleration);
    return numbers;
  }));
  ASSERT_EQ(exact.exit_code, 0) << exact.err;
  EXPECT_EQ(exact.err, "");
  const std::string position = ",root.position.x,root.position.y,root.position.z";
  const std::string rates =
      ",root.velocity.x,root.velocity.y,root.velocity.z"
      ",root.angular_velocity.x,root.angular_velocity.y,root.angular_velocity.z";
  for (const bool with_rates : {false, true}) {
    const Run found =
        compute(table(std::string(kOrientation) + position + (with_rates ? rates : ""),
                      [&](const RootMotion& root) {
                        std::vector<double> numbers = orientation(root);
                        add(numbers, root.position);
                        if (!with_rates) return numbers;
                        add(numbers, root.velocity);
                        add(numbers, root.angular_velocity);
                        return numbers;
                      }));
    ASSERT_EQ(found.exit_code, 0) << found.err;
    EXPECT_NE(found.err.find("m.csv: estimated: "), std::string::npos) << found.err;
    EXPECT_EQ(found.err.find("root.angular_velocity.{x,y,z}") == std::string::npos, with_rates);
    EXPECT_NE(found.err.find("root.orientation (4): "), std::string::npos) << found.err;
    double worst = 0;
    for (int i = kEnd; i < kRows - kEnd; i += 20) {
      const std::vector<double> one = row(found.out, i), other = row(exact.out, i);
      ASSERT_EQ(one.size(), other.size());
      for (std::size_t j = 0; j < one.size(); ++j)
        worst = std::max(worst, std::abs(one[j] - other[j]));
    }
    EXPECT_LT(worst, 1e-8);  // N and N m, of some tens; measured 1e-10
  }
}

TEST_F(OfflineRoot, BadInputIsRefusedInOneLine) {
  const std::string all = std::string(kOrientation) + kRates;
  const std::string good = ",1,0,0,0,0,0,3,0,0,0,0,0,0.7";
  const auto error = [&](const std::string& csv) {
    const Run refused = compute(csv);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_EQ(refused.out, "");
    return refused.err;
  };
  EXPECT_EQ(error(motion(all, ",1.2,0,0,0,0,0,3,0,0,0,0,0,0.7")),
            "inverse_dynamics_offline: error: m.csv: line 2: root.orientation.{x,y,z,w} has the "
            "length 1.2, not 1\n");
  EXPECT_EQ(error(motion("", "")),
            "inverse_dynamics_offline: error: m.csv: columns are missing: "
            "root.orientation.{x,y,z,w}, root.acceleration.{x,y,z} or root.position.{x,y,z}: the "
            "scene says 'root: moving'\n");
  EXPECT_EQ(error(motion(kOrientation, ",1,0,0,0")),
            "inverse_dynamics_offline: error: m.csv: columns are missing: "
            "root.acceleration.{x,y,z} or root.position.{x,y,z}: the scene says 'root: moving'\n");
  const std::string poses = std::string(kOrientation) +
                            ",root.position.x,root.position.y,"
                            "root.position.z";
  EXPECT_NE(error(motion(poses, ",1,0,0,0,0,0,0")).find("estimating them takes 3 rows or more"),
            std::string::npos);
  std::string short_of_one = motion(all, good);
  short_of_one.replace(short_of_one.find("root.acceleration.y"), 19, "effort.slew");
  EXPECT_EQ(error(short_of_one),
            "inverse_dynamics_offline: error: m.csv: line 1: column 'root.acceleration.y' is "
            "missing, though other components of it are there\n");
  std::string misspelt = motion(all, good);
  misspelt.replace(misspelt.find("root.acceleration.y"), 19, "root.acceleration.v");
  EXPECT_NE(error(misspelt).find("column 13: 'root.acceleration.v' is not one of"),
            std::string::npos);
}

TEST_F(OfflineRoot, WhatIsNotUsedOrNotQuiteRightIsSaid) {
  const std::string all = std::string(kOrientation) + kRates;
  const Run unused = compute(motion(all, ",1,0,0,0,0,0,3,0,0,0,0,0,0.7"), "");
  EXPECT_EQ(unused.exit_code, 0);
  EXPECT_EQ(unused.err,
            "warning: m.csv: columns root.… are not used: the scene does not say 'root: moving'\n");
  const Run scaled = compute(motion(all, ",1.0005,0,0,0,0,0,3,0,0,0,0,0,0.7"));
  EXPECT_EQ(scaled.exit_code, 0);
  EXPECT_EQ(
      scaled.err,
      "warning: m.csv: lengths of root.orientation are up to 0.0005 off 1; they are scaled to "
      "1\n");
  const Run exact = compute(motion(all, ",1,0,0,0,0,0,3,0,0,0,0,0,0.7"));
  EXPECT_EQ(row(scaled.out, 0), row(exact.out, 0));
  write("doubtful.yaml", std::string(kMoving) + "tolerances: {mass: 0.1}\n");
  const Run doubtful =
      compute(motion(all, ",1,0,0,0,0,0,3,0,0,0,0,0,0.7"), "--scene doubtful.yaml --deviations");
  EXPECT_NE(doubtful.err.find("deviations take as exact: the root's motion, as it is given"),
            std::string::npos)
      << doubtful.err;
}

// Poses of noise 1e-4 m and rad: deviations hold against the closed form.
TEST_F(OfflineRoot, DeviationsCoverWhatIsEstimated) {
  constexpr int kRows = 1200, kEnd = 80;
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  const auto table = [&](bool noisy) {
    std::ostringstream text;
    text.precision(17);
    text << kMotion << kOrientation
         << (noisy ? ",root.position.x,root.position.y,root.position.z" : kRates) << "\n";
    for (int i = 0; i < kRows; ++i) {
      const double t = 0.005 * i;
      RootMotion root = TumblingRoot{{0.4, 0.2, -0.3}, 0.6}.at(t);
      text << t << "," << std::sin(t) << "," << std::cos(t) << "," << -std::sin(t);
      const auto print = [&](const Eigen::Vector3d& vector) {
        for (int axis = 0; axis < 3; ++axis) text << "," << vector[axis];
      };
      const auto drawn = [&] {
        const double x = normal(generator), y = normal(generator);
        return Eigen::Vector3d(1e-4 * x, 1e-4 * y, 1e-4 * normal(generator));
      };
      if (noisy) {
        const Eigen::Vector3d turn = drawn();
        root.orientation =
            root.orientation * Eigen::AngleAxisd(turn.norm(), turn.stableNormalized());
      }
      const Eigen::Quaterniond& q = root.orientation;
      text << "," << q.w() << "," << q.x() << "," << q.y() << "," << q.z();
      if (noisy) {
        print(root.position + drawn());
      } else {
        print(root.angular_velocity);
        print(root.acceleration);
        print(root.angular_acceleration);
      }
      text << "\n";
    }
    return text.str();
  };
  const Run exact = compute(table(false));
  const Run found = compute(table(true), "--scene moving.yaml --deviations");
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.err.find("as exact"), std::string::npos) << found.err;
  int inside = 0, all = 0;
  for (int i = kEnd; i < kRows - kEnd; i += 5) {
    const std::vector<double> right = row(exact.out, i), numbers = row(found.out, i);
    ASSERT_EQ(right.size(), 14u);
    ASSERT_EQ(numbers.size(), 27u);
    for (std::size_t j = 1; j < right.size(); ++j, ++all) {
      EXPECT_GT(numbers[13 + j], 0);
      if (std::abs(numbers[j] - right[j]) <= 2 * numbers[13 + j]) ++inside;
    }
  }
  EXPECT_GT(inside, 0.9 * all);
  const Run noted = compute(table(true), "--scene moving.yaml --deviations --deviation-warn 1e-9");
  EXPECT_NE(noted.err.find("mostly from the noise of the root's "), std::string::npos) << noted.err;
}

TEST_F(OfflineRoot, ReactionsInInertialAxesAreThoseOfTheRootTurned) {
  const std::string csv =
      motion(std::string(kOrientation) + kRates, ",0.5,-0.5,0.5,0.5,1,-2,3,4,-5,6,0.5,2,-3");
  const std::vector<double> in_root = row(compute(csv).out, 1);
  const Run found = compute(csv, "--scene moving.yaml --axes inertial");
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const std::vector<double> inertial = row(found.out, 1);
  ASSERT_EQ(inertial.size(), in_root.size());
  EXPECT_EQ(inertial[1], in_root[1]);
  // (w, x, y, z) = (1, -1, 1, 1) / 2 turns x into -z, y into -x and z into y.
  for (std::size_t first = 2; first < in_root.size(); first += 3) {
    EXPECT_NEAR(inertial[first], -in_root[first + 1], 1e-12);
    EXPECT_NEAR(inertial[first + 1], in_root[first + 2], 1e-12);
    EXPECT_NEAR(inertial[first + 2], -in_root[first], 1e-12);
  }
  const Run rests = compute(motion("", ""), "--axes inertial");
  EXPECT_EQ(rests.exit_code, 2);
  EXPECT_NE(rests.err.find("--axes inertial: the scene does not say 'root: moving'"),
            std::string::npos)
      << rests.err;
  EXPECT_EQ(compute(csv, "--scene moving.yaml --axes inertial --deviations").exit_code, 2);
}

}  // namespace
}  // namespace virtual_work_dynamics
