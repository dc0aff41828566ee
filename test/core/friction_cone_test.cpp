#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "closed_loops.h"
#include "robot_builder.h"

namespace virtual_work_dynamics {
namespace {

// A point that sticks to a slope holds a weight on slides: all that friction must bear is the
// tangent of the slope times the normal force.
Hold holdOnASlope(double slope, double heading, double friction) {
  RobotBuilder builder(7);
  int link = 0;
  for (int i = 0; i < 3; ++i) {
    link = builder.add(JointType::kPrismatic, link, Vector3l::Unit(i), Matrix3l::Identity(),
                       Vector3l::Zero());
    builder.removeInertia(link);
  }
  builder.link(link).mass = 3;
  Closure foot;
  foot.name = "foot";
  foot.type = ClosureType::kContact;
  foot.parent.link = "link_0";
  foot.parent.rpy = {0, slope, heading};
  foot.child.link = "link_3";
  foot.touch.friction = friction;
  Scene scene;
  scene.closures = {foot};
  scene.actuated.emplace();
  ClosedLoops dynamics(builder.build(), scene);
  dynamics.compute(Motion(3));
  return dynamics.results().loops.holds.at(0);
}

TEST(FrictionCone, HoldsUpToItsEdgeFromFlatToSteep) {
  for (const double slope : {1e-3, 0.1, 0.7, 1.2, 1.5, 1.57}) {
    for (const double heading : {0.0, 0.9, -2.5}) {
      for (const double beside : {1e-2, 1e-4, 1e-6}) {
        SCOPED_TRACE(std::to_string(slope) + " " + std::to_string(heading) + " " +
                     std::to_string(beside));
        EXPECT_EQ(holdOnASlope(slope, heading, std::tan(slope) * (1 + beside)), Hold::kHolds);
        EXPECT_EQ(holdOnASlope(slope, heading, std::tan(slope) * (1 - beside)), Hold::kOutsideCone);
      }
    }
  }
}

TEST(FrictionCone, WhatHangsWouldHaveToBePulled) {
  EXPECT_EQ(holdOnASlope(1.6, 0.3, 1e3), Hold::kWrongWay);
  EXPECT_EQ(holdOnASlope(3, 0.3, 1e3), Hold::kWrongWay);
}

}  // namespace
}  // namespace virtual_work_dynamics
