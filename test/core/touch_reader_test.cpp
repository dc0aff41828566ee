#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "robot_builder.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

Eigen::Matrix3d axesOf(const LinkFrame& frame) {
  using Turn = Eigen::AngleAxisd;
  return (Turn(frame.rpy.z(), Eigen::Vector3d::UnitZ()) *
          Turn(frame.rpy.y(), Eigen::Vector3d::UnitY()) *
          Turn(frame.rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

std::string messageOf(const std::string& text) {
  try {
    readScene(YAML::Load(text));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

TEST(TouchReader, ReadsWheels) {
  const Scene scene = readScene(YAML::Load(R"(
rolling:
  - {name: front, link: wheel, centre: [1, 2, 3], axis: [0, 3, -4], radius: 0.4, tube_radius: 0.1,
     plane: {link: ramp, point: [0.5, 0, 0], normal: [1, -2, 2]}, normal: false, slip: rolling}
  - {name: back, link: wheel, axis: [-1, 0, 0], radius: 0.4, side: back, roller_angle: 0.5,
     plane: {link: ramp, normal: [1, -2, 2]}}
closures:
  - {name: pin, type: revolute, parent: {link: a}, child: {link: b}}
)"));
  ASSERT_EQ(scene.closures.size(), 3u);
  EXPECT_EQ(scene.closures[0].name, "pin");  // whatever the order of the keys
  const Closure& front = scene.closures[1];
  EXPECT_EQ(front.type, ClosureType::kRolling);
  EXPECT_EQ(front.child.link, "wheel");
  EXPECT_EQ(front.parent.link, "ramp");
  EXPECT_EQ(front.child.xyz, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(front.parent.xyz, Eigen::Vector3d(0.5, 0, 0));
  EXPECT_LE((axesOf(front.child).col(2) - Eigen::Vector3d(0, 0.6, -0.8)).norm(), 1e-15);
  const Eigen::Vector3d normal(1.0 / 3, -2.0 / 3, 2.0 / 3);
  EXPECT_LE((axesOf(front.parent).col(2) - normal).norm(), 1e-15);
  EXPECT_EQ(front.touch.radius, 0.4);
  EXPECT_EQ(front.touch.tube_radius, 0.1);
  EXPECT_FALSE(front.touch.normal);
  EXPECT_EQ(front.touch.slip, Slip::kRolling);
  EXPECT_FALSE(front.touch.roller_angle);
  const Closure& back = scene.closures[2];
  EXPECT_LE((axesOf(back.child).col(2) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-15);
  EXPECT_LE((axesOf(back.parent).col(2) + normal).norm(), 1e-15);
  EXPECT_TRUE(back.touch.normal);
  EXPECT_EQ(back.touch.slip, Slip::kNone);
  EXPECT_EQ(back.touch.roller_angle.value(), 0.5);
}

TEST(TouchReader, ReadsKnifeEdges) {
  const Scene scene = readScene(YAML::Load(R"(
knife_edges:
  - {name: skate, link: sleigh, at: [1, 0, 0], direction: [2, -1, 2], normal: false,
     plane: {link: ice}}
)"));
  ASSERT_EQ(scene.closures.size(), 1u);
  const Closure& skate = scene.closures[0];
  EXPECT_EQ(skate.type, ClosureType::kKnifeEdge);
  EXPECT_EQ(skate.child.xyz, Eigen::Vector3d(1, 0, 0));
  EXPECT_LE((axesOf(skate.child).col(0) - Eigen::Vector3d(2, -1, 2) / 3).norm(), 1e-15);
  EXPECT_EQ(axesOf(skate.parent), Eigen::Matrix3d::Identity());
  EXPECT_FALSE(skate.touch.normal);
}

TEST(TouchReader, RefusesWhatIsWrongInOneLine) {
  const std::string wheel =
      "rolling: [{name: w, link: l, axis: [0, 1, 0], radius: 1, plane: {link: p}";
  EXPECT_EQ(messageOf(wheel + "}]"), "no error");
  EXPECT_EQ(messageOf("rolling: [{name: w, link: l, radius: 1, plane: {link: p}}]"),
            "rolling[0]: axis is missing");
  EXPECT_EQ(messageOf("rolling: [{name: w, link: l, axis: [0, 1, 0], plane: {link: p}}]"),
            "rolling[0]: radius is missing");
  EXPECT_EQ(messageOf("rolling: [{name: w, link: l, axis: [0, 1, 0], radius: 1}]"),
            "rolling[0]: plane is missing");
  EXPECT_EQ(
      messageOf("rolling: [{name: w, link: l, axis: [0, 0, 0], radius: 1, plane: {link: p}}]"),
      "rolling[0].axis: is zero, which is no direction");
  EXPECT_EQ(messageOf(wheel + ", slip: none, roller_angle: 1}]"),
            "rolling[0].slip: a wheel with roller_angle has none: its rollers say how it slips");
  EXPECT_EQ(messageOf("knife_edges: [{name: k, link: l, plane: {link: p}}]"),
            "knife_edges[0]: direction is missing");
  EXPECT_EQ(messageOf("rolling: [{name: w, link: l, axis: [0, 1, 0], radius: 1, plane: {}}]"),
            "rolling[0].plane: link is missing");
  EXPECT_NE(messageOf(wheel + ", sides: back}]").find("side"), std::string::npos);
  EXPECT_NE(messageOf("closures: [{name: c, type: rolling, parent: {link: a}, child: {link: b}}]"),
            "no error");
}

// Link 1 slides along x, link 2 on it along z, link 3 on that turns about y.
Mechanism cart() {
  RobotBuilder builder(3);
  const Matrix3l R = Matrix3l::Identity();
  builder.add(JointType::kPrismatic, 0, Vector3l::UnitX(), R, Vector3l::Zero());
  builder.add(JointType::kPrismatic, 1, Vector3l::UnitZ(), R, Vector3l::Zero());
  builder.add(JointType::kRevolute, 2, Vector3l::UnitY(), R, Vector3l::Zero());
  return builder.build();
}

std::string refusalOf(const std::string& touch, const std::string& more = "") {
  try {
    ClosedLoopDynamics(cart(), readScene(YAML::Load(touch + "\nfree_motion: true\n" + more)), {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TouchReader, RefusesWhatNoMechanismCanHave) {
  const auto wheel = [](const std::string& more) {
    return "rolling: [{name: w, link: link_3, plane: {link: link_0}, " + more + "}]";
  };
  const std::string none = "actuated: []\n";
  EXPECT_EQ(refusalOf(wheel("axis: [0, 1, 0], radius: 1"), none), "no error");
  EXPECT_EQ(refusalOf(wheel("axis: [0, 1, 0], radius: 0"), none),
            "rolling: 'w': radius and tube_radius are both zero");
  EXPECT_EQ(refusalOf(wheel("axis: [0, 1, 0], radius: -1"), none),
            "rolling: 'w': radius = -1 is not zero or more");
  EXPECT_EQ(refusalOf(wheel("axis: [0, 1, 0], radius: 1, slip: all, normal: false"), none),
            "rolling: 'w': holds nothing: it slips and its normal is false");
  EXPECT_EQ(refusalOf(wheel("axis: [0, 1, 0], radius: 1, friction: 1, normal: false"), none),
            "rolling: 'w': friction has no effect where normal is false");
  EXPECT_EQ(refusalOf(wheel("axis: [0, 1, 0], radius: 1, friction: 1, slip: all"), none),
            "rolling: 'w': friction has no effect on what slips in all directions");
  EXPECT_EQ(refusalOf("contacts: [{name: c, link: link_3, friction: 1, slip: all,"
                      " plane: {link: link_0}}]",
                      none),
            "contacts: 'c': friction has no effect on what slips in all directions");
  for (const Slip slip : {Slip::kNone, Slip::kAll, Slip::kLateral, Slip::kRolling}) {
    Scene scene = readScene(YAML::Load(
        "contacts: [{name: c, link: link_3, plane: {link: link_0}}]\nfree_motion: true\n" + none));
    scene.closures[0].touch.slip = slip;
    std::string refusal = "no error";
    try {
      ClosedLoopDynamics(cart(), scene, {});
    } catch (const Error& error) {
      refusal = error.what();
    }
    const bool sound = slip == Slip::kNone || slip == Slip::kAll;
    EXPECT_EQ(refusal,
              sound ? "no error" : "contacts: 'c': a point slips in all directions or in none");
  }
  EXPECT_EQ(refusalOf(wheel("axis: [0, 0, 1], radius: 1"), none),
            "rolling: 'w': its axle is parallel to the plane's normal");
  EXPECT_EQ(refusalOf("knife_edges: [{name: k, link: link_3, direction: [0, 0, 1],"
                      " plane: {link: link_0}}]",
                      none),
            "knife_edges: 'k': its direction is parallel to the plane's normal");
  EXPECT_EQ(refusalOf("rolling: [{name: w, link: link_3, axis: [0, 1, 0], radius: 1,"
                      " plane: {link: link_3}}]",
                      none),
            "rolling: 'w': both frames are on link 'link_3'");
  EXPECT_EQ(refusalOf("rolling: [{name: w, link: link_1, axis: [0, 1, 0], radius: 1,"
                      " plane: {link: link_0}}]",
                      none),
            "rolling: 'w' cannot be assembled from the given start: it stays open by 1 m");
}

TEST(TouchReader, UnknownLinksAreNamedByTheKeysOfTheScene) {
  const std::string known = "known are 'link_0', 'link_1', 'link_2' and 'link_3'";
  const std::string none = "actuated: []\n";
  const auto contact = [](const std::string& link, const std::string& plane) {
    return "contacts: [{name: c, link: " + link + ", plane: {link: " + plane + "}}]";
  };
  EXPECT_EQ(refusalOf(contact("toe", "link_0"), none),
            "contacts: 'c': link: no link 'toe'; " + known);
  EXPECT_EQ(refusalOf(contact("link_3", "floor"), none),
            "contacts: 'c': plane.link: no link 'floor'; " + known);
  EXPECT_EQ(refusalOf("cylinders: [{name: c, link_a: link_0, link_b: boom}]", none),
            "cylinders: 'c': link_b: no link 'boom'; " + known);
}

}  // namespace
}  // namespace virtual_work_dynamics
