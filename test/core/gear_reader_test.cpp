#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

std::string entryWith(const std::string& keys) {
  return "closures: [{name: c, parent: {link: a}, child: {link: b}, " + keys + "}]";
}

Closure closureWith(const std::string& keys) {
  return readScene(YAML::Load(entryWith(keys))).closures.at(0);
}

std::string refusalOf(const std::string& keys) {
  try {
    closureWith(keys);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(GearReader, TeethOfWheels) {
  const Closure gear = closureWith("type: gear, radii: [0.02, -0.07], helix_angle: -0.2");
  EXPECT_EQ(gear.type, ClosureType::kGear);
  EXPECT_EQ(gear.teeth.parent_radius, 0.02);
  EXPECT_EQ(gear.teeth.child_radius, -0.07);
  EXPECT_NEAR(gear.teeth.pressure_angle, 0.349065850398866, 1e-15);  // 20 degrees
  EXPECT_EQ(gear.teeth.helix_angle, -0.2);
}

TEST(GearReader, TeethOfARack) {
  const Closure rack = closureWith("type: rack, radius: 0.03, pressure_angle: 0.25");
  EXPECT_EQ(rack.type, ClosureType::kRack);
  EXPECT_EQ(rack.teeth.parent_radius, 0.03);
  EXPECT_EQ(rack.teeth.pressure_angle, 0.25);
  EXPECT_EQ(rack.teeth.helix_angle, 0);
}

TEST(GearReader, WhatBelongsToAnotherTypeIsRefused) {
  EXPECT_EQ(refusalOf("type: gear"), "closures[0]: radii is missing");
  EXPECT_EQ(refusalOf("type: rack"), "closures[0]: radius is missing");
  EXPECT_EQ(refusalOf("type: rack, radius: 1, radii: [1, 2]"),
            "closures[0].radii: only a closure of type gear has radii");
  EXPECT_EQ(refusalOf("type: gear, radii: [1, 2], radius: 1"),
            "closures[0].radius: only a closure of type rack has a radius");
  EXPECT_EQ(refusalOf("type: fixed, helix_angle: 0.1"),
            "closures[0].helix_angle: only closures of type gear and rack have teeth");
  EXPECT_EQ(refusalOf("type: gear, radii: [1, 2, 3]"),
            "closures[0].radii: expected a list of two numbers");
  EXPECT_EQ(refusalOf("type: gear, radii: [1, 2], length: 3"),
            "closures[0].length: only a closure of type distance has a length");
}

}  // namespace
}  // namespace virtual_work_dynamics
