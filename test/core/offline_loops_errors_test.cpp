#include <gtest/gtest.h>

#include <cmath>

#include "offline_linkage.h"

namespace virtual_work_dynamics {
namespace {

// Rounding of sums of numbers below one.
constexpr double kRounding = 1e-15;

constexpr char kDriveMotion[] =
    "time,position.drive,velocity.drive,acceleration.drive\n0,0,0,0\n0.1,0.3,-1.2,2.5\n";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(OfflineLoops, MotionsThatViolateALoopAreRefused) {
  const std::string start = kAllColumns + row(0, {0, 0, 0});
  write("bad.csv", start + row(0.1, {0.3, -1.2, 2.5}, 1e-4));
  const std::string message = failure("--scene s.yaml --motion bad.csv");
  EXPECT_TRUE(contains(message, "bad.csv: line 3: the positions violate closure 'pin' by "))
      << message;
  EXPECT_TRUE(contains(message, " m or rad, ")) << message;
  EXPECT_TRUE(contains(message, "the tolerance is 1e-06")) << message;
  // The rocker's foot is 0.58 m from the elbow, which is off by 1e-4 rad.
  const NumberTable loose = table("--scene s.yaml --motion bad.csv --loop-tolerance 1e-3", "");
  const double violation =
      loose.rows.at(1).at(static_cast<std::size_t>(loose.column("residual.position.pin")));
  EXPECT_GT(violation, 2e-5);
  EXPECT_LT(violation, 6e-5);
  write("bad.csv", start + "0.1,0,0,0,1,-1,1.1,0,0,0\n");
  EXPECT_TRUE(contains(failure("--scene s.yaml --motion bad.csv"),
                       "line 3: the velocities violate closure 'pin' by 0.03 m/s or rad/s"));
  write("bad.csv", start + "0.1,0,0,0,0,0,0,2,-2,2.5\n");
  EXPECT_TRUE(contains(failure("--scene s.yaml --motion bad.csv"),
                       "line 3: the accelerations violate closure 'pin' by 0.15 m/s^2 or rad/s^2"));
  EXPECT_TRUE(
      contains(failure("--scene s.yaml --motion bad.csv --check"), "closure 'pin' by 0.15"));
}

TEST_F(OfflineLoops, ResidualsAreOfEachLevel) {
  write("bad.csv", std::string(kAllColumns) + "0.1,0,0,0,1,-1,1.1,2,-2,2.5\n");
  const NumberTable loose = table("--scene s.yaml --motion bad.csv --loop-tolerance 1", "");
  const auto residual = [&](const char* level) {
    const int column = loose.column(std::string("residual.") + level + ".pin");
    return loose.rows.at(0).at(static_cast<std::size_t>(column));
  };
  EXPECT_NEAR(residual("position"), 0, kRounding);
  EXPECT_NEAR(residual("velocity"), 0.03, kRounding);
  EXPECT_NEAR(residual("acceleration"), std::hypot(0.15, 0.3 * 0.21), kRounding);
}

TEST_F(OfflineLoops, APartOfThePassiveJointsIsNoMotion) {
  write("part.csv", "time,position.drive,position.wrist\n0,0,0\n");
  EXPECT_EQ(failure("--scene s.yaml --motion part.csv"),
            "part.csv: too much is given: each of 'drive', 'wrist' follows from the rest; leave "
            "one out, or give all joints and nothing else");
  write("none.csv", "time,position.door\n0,0\n");
  EXPECT_EQ(failure("--scene s.yaml --motion none.csv"),
            "none.csv: line 1: column 'position.drive' is missing; there are 'position.door'");
  write("part.csv", "time,position.drive,velocity.drive,velocity.elbow\n0,0,0,0\n");
  EXPECT_EQ(failure("--scene s.yaml --motion part.csv"),
            "part.csv: column 'velocity.elbow' without 'position.elbow'");
}

TEST_F(OfflineLoops, LoopsThatCannotBeClosedAreNamed) {
  // The pin is too far away once the crank points away from it.
  write("far.yaml", pinned("0.7"));
  write("m.csv", "time,position.drive\n0,0\n0.1,-0.05\n0.2,-1.5\n");
  const std::string message = failure("--scene far.yaml --motion m.csv");
  EXPECT_TRUE(
      contains(message, "m.csv: line 4: the loops cannot be closed: closure 'pin' stays open by "))
      << message;
}

TEST_F(OfflineLoops, TheDriveAloneDoesNotSayHowTheOthersLeaveASingularPosition) {
  write("m.csv",
        "time,position.drive,velocity.drive,acceleration.drive\n0,1.5,1,0\n"
        "0.1,1.5707963267948966,1,0\n");
  EXPECT_EQ(failure("--scene s.yaml --motion m.csv"),
            "m.csv: line 3: the position is singular: the closures do not determine how the "
            "other joints move; give the motion of all joints");
}

TEST_F(OfflineLoops, WhatLoopsDoNotHaveIsRefused) {
  write("m.csv", kDriveMotion);
  const std::string start = "--scene s.yaml --motion m.csv ";
  EXPECT_EQ(failure("--motion m.csv --loop-tolerance 1e-3", 2),
            "--loop-tolerance: the scene has no closures");
  for (const std::string text : {"0", "-1", "nan", "tight"}) {
    EXPECT_EQ(failure(start + "--loop-tolerance=" + text, 2),
              "--loop-tolerance: '" + text + "' is not a positive number");
  }
  std::string named = pinned("0.5");
  write("comma.yaml", named.replace(named.find("pin"), 3, "'p,n'"));
  EXPECT_EQ(failure("--scene comma.yaml --motion m.csv"),
            "joint 'p,n': a comma, quote or line end cannot stand in a CSV header");
  EXPECT_EQ(failure("--scene comma.yaml --motion m.csv --reactions none"),
            "column 'residual.position.p,n': a comma, quote or line end cannot stand in a CSV "
            "header");
  EXPECT_TRUE(contains(failure("--scene s.yaml --motion m.csv --reactions pim"), "'pim'"));
  write("few.yaml", pinned("0.5", ""));
  EXPECT_TRUE(contains(failure("--scene few.yaml --motion m.csv"), "drive"));
}

}  // namespace
}  // namespace virtual_work_dynamics
