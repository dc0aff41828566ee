#include <gtest/gtest.h>

#include <string>

#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

Scene read(const std::string& yaml) {
  return readScene(YAML::Load(yaml));
}

// The message of a scene that must be refused.
std::string refusal(const std::string& yaml) {
  try {
    read(yaml);
  } catch (const SceneError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
  return "accepted";
}

std::string closure(const std::string& rest) {
  return refusal("closures: [{" + rest + "}]");
}

std::string spring(const std::string& rest) {
  return refusal("springs: [{" + rest + "}]");
}

std::string redundancy(const std::string& rest) {
  return refusal("redundancy: {" + rest + "}");
}

TEST(SceneReaderLoops, WithoutTheKeysEverythingIsAnOpenChain) {
  const Scene scene = read("");
  EXPECT_TRUE(scene.closures.empty());
  EXPECT_TRUE(scene.springs.empty());
  EXPECT_FALSE(scene.actuated);
  EXPECT_TRUE(scene.assembly.empty());
  EXPECT_EQ(scene.redundancy.policy, RedundancyPolicy::kMinimumNorm);
  EXPECT_EQ(scene.redundancy.rank_tolerance, 1e-10);
  EXPECT_FALSE(scene.redundancy.length);
}

// Lists come one after the other, each in its own order, whatever types it has.
TEST(SceneReaderLoops, KeepsTheOrderOfEachList) {
  const Scene scene = read(R"(
cylinders: [{name: c, link_a: a, link_b: b}]
closures:
  - {name: g, type: gear, radii: [1, 2], parent: {link: a}, child: {link: b}}
  - {name: r, type: revolute, parent: {link: a}, child: {link: b}}
  - {name: f, type: fixed, parent: {link: a}, child: {link: b}}
)");
  std::string order;
  for (const Closure& closure : scene.closures) order += closure.name;
  EXPECT_EQ(order, "grfc");
}

TEST(SceneReaderLoops, ReadsClosures) {
  const Scene scene = read(R"(
closures:
  - name: pin
    type: revolute
    parent: {link: crank, xyz: [1, 2, "3"], rpy: [0.1, 0.2, 0.3]}
    child: {link: rocker, xyz: [4, 5, 6], rpy: [0.4, 0.5, 0.6]}
  - {name: rod, type: distance, parent: {link: a}, child: {link: b}, length: 0.7}
  - {name: string, type: distance, parent: {link: a}, child: {link: b}}
)");
  ASSERT_EQ(scene.closures.size(), 3u);
  const Closure& pin = scene.closures[0];
  EXPECT_EQ(pin.name, "pin");
  EXPECT_EQ(pin.type, ClosureType::kRevolute);
  EXPECT_EQ(pin.parent.link, "crank");
  EXPECT_EQ(pin.parent.xyz, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(pin.parent.rpy, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(pin.child.link, "rocker");
  EXPECT_EQ(pin.child.xyz, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(pin.child.rpy, Eigen::Vector3d(0.4, 0.5, 0.6));
  EXPECT_FALSE(pin.length);
  const Closure& rod = scene.closures[1];
  EXPECT_EQ(rod.type, ClosureType::kDistance);
  EXPECT_EQ(rod.parent.xyz, Eigen::Vector3d::Zero());
  EXPECT_EQ(rod.child.rpy, Eigen::Vector3d::Zero());
  EXPECT_EQ(rod.length, 0.7);
  EXPECT_FALSE(scene.closures[2].length);
}

TEST(SceneReaderLoops, ReadsEveryTypeOfClosure) {
  const std::pair<const char*, ClosureType> types[] = {
      {"fixed", ClosureType::kFixed},         {"revolute", ClosureType::kRevolute},
      {"prismatic", ClosureType::kPrismatic}, {"cylindrical", ClosureType::kCylindrical},
      {"universal", ClosureType::kUniversal}, {"spherical", ClosureType::kSpherical},
      {"planar", ClosureType::kPlanar},       {"distance", ClosureType::kDistance}};
  for (const auto& type : types) {
    const Scene scene = read(std::string("closures: [{name: c, parent: {link: a}, type: ") +
                             type.first + ", child: {link: b}}]");
    EXPECT_EQ(scene.closures.at(0).type, type.second) << type.first;
  }
}

TEST(SceneReaderLoops, ReadsSpringsActuatedAndAssembly) {
  const Scene scene = read(R"(
springs:
  - {name: s, link_a: a, at_a: [1, 2, 3], link_b: b, at_b: [4, 5, 6], stiffness: 4530, rest_length: 0.07785, damping: 12}
  - {name: t, link_a: a, link_b: b, stiffness: "1e9"}
  - {name: u, link_a: a, link_b: b, damping: 7}
actuated: [motor, pin]
assembly: [{name: elbow, position: -0.5}, {position: 2, name: knee}]
)");
  ASSERT_EQ(scene.springs.size(), 3u);
  EXPECT_EQ(scene.springs[0].damping, 12);
  EXPECT_EQ(scene.springs[1].damping, 0);
  EXPECT_EQ(scene.springs[2].stiffness, 0);
  EXPECT_EQ(scene.springs[2].damping, 7);
  EXPECT_EQ(scene.springs[0].name, "s");
  EXPECT_EQ(scene.springs[0].link_a, "a");
  EXPECT_EQ(scene.springs[0].at_a, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.springs[0].link_b, "b");
  EXPECT_EQ(scene.springs[0].at_b, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(scene.springs[0].stiffness, 4530);
  EXPECT_EQ(scene.springs[0].rest_length, 0.07785);
  EXPECT_EQ(scene.springs[1].stiffness, 1e9);
  EXPECT_EQ(scene.springs[1].at_b, Eigen::Vector3d::Zero());
  EXPECT_EQ(scene.springs[1].rest_length, 0);
  EXPECT_EQ(scene.actuated, (std::vector<std::string>{"motor", "pin"}));
  ASSERT_EQ(scene.assembly.size(), 2u);
  EXPECT_EQ(scene.assembly[0].name, "elbow");
  EXPECT_EQ(scene.assembly[0].value, -0.5);
  EXPECT_EQ(scene.assembly[1].name, "knee");
  EXPECT_EQ(scene.assembly[1].value, 2);
}

TEST(SceneReaderLoops, AnEmptyListOfActuatedJointsIsNotNone) {
  const Scene scene = read("actuated: []");
  ASSERT_TRUE(scene.actuated);
  EXPECT_TRUE(scene.actuated->empty());
}

TEST(SceneReaderLoops, ReadsRedundancy) {
  const Redundancy least = read(R"(
redundancy:
  policy: minimum_norm
  effort_weights: [{name: m, weight: 4}]
  rank_tolerance: 1e-8
  length: 0.25
)")
                               .redundancy;
  EXPECT_EQ(least.policy, RedundancyPolicy::kMinimumNorm);
  ASSERT_EQ(least.effort_weights.size(), 1u);
  EXPECT_EQ(least.effort_weights[0].name, "m");
  EXPECT_EQ(least.effort_weights[0].value, 4);
  EXPECT_EQ(least.rank_tolerance, 1e-8);
  EXPECT_EQ(least.length, 0.25);

  const Redundancy zero =
      read("redundancy: {zero_at: [c, d], policy: zero_at, length: auto}").redundancy;
  EXPECT_EQ(zero.policy, RedundancyPolicy::kZeroAt);
  EXPECT_EQ(zero.zero_at, (std::vector<std::string>{"c", "d"}));
  EXPECT_FALSE(zero.length);

  const Redundancy stiff =
      read("redundancy: {policy: stiffness, stiffness: [{name: j, stiffness: 3}]}").redundancy;
  EXPECT_EQ(stiff.policy, RedundancyPolicy::kStiffness);
  ASSERT_EQ(stiff.stiffness.size(), 1u);
  EXPECT_EQ(stiff.stiffness[0].name, "j");
  EXPECT_EQ(stiff.stiffness[0].value, 3);
}

TEST(SceneReaderLoops, RefusesClosuresByKey) {
  EXPECT_EQ(refusal("closures: {name: c}"), "closures: expected a list");
  EXPECT_EQ(refusal("closures: [c]"),
            "closures[0]: expected a map with name, type, parent, child, length, radii, radius, "
            "pressure_angle, helix_angle");
  EXPECT_EQ(closure("tpye: fixed"), "closures[0].tpye: unknown key; did you mean 'type'?");
  EXPECT_EQ(closure("name: c, name: d"), "closures[0].name: given twice");
  EXPECT_EQ(closure("name: [c]"), "closures[0].name: expected a name");
  EXPECT_EQ(closure("type: hinge"),
            "closures[0].type: 'hinge' is not one of fixed, revolute, prismatic, cylindrical, "
            "universal, spherical, planar, distance, gear, rack");
  EXPECT_EQ(closure("type: [fixed]"),
            "closures[0].type: expected fixed, revolute, prismatic, cylindrical, universal, "
            "spherical, planar, distance, gear or rack");
  EXPECT_EQ(closure("parent: a"), "closures[0].parent: expected a map with link, xyz, rpy");
  EXPECT_EQ(closure("parent: {xyz: [0, 0, 0]}"), "closures[0].parent: link is missing");
  EXPECT_EQ(closure("child: {link: b, zyx: [0, 0, 0]}"),
            "closures[0].child.zyx: unknown key; known are 'link', 'xyz' and 'rpy'");
  EXPECT_EQ(closure("child: {link: b, rpy: [0, 0]}"),
            "closures[0].child.rpy: expected a list of three numbers");
  EXPECT_EQ(closure("child: {link: b, xyz: [0, 0, .nan]}"),
            "closures[0].child.xyz: '.nan' is not a finite number");
  EXPECT_EQ(closure("type: fixed, parent: {link: a}, child: {link: b}"),
            "closures[0]: name is missing");
  EXPECT_EQ(closure("name: c, parent: {link: a}, child: {link: b}"),
            "closures[0]: type is missing");
  EXPECT_EQ(closure("name: c, type: fixed, child: {link: b}"), "closures[0]: parent is missing");
  EXPECT_EQ(closure("name: c, type: fixed, parent: {link: b}"), "closures[0]: child is missing");
  EXPECT_EQ(closure("name: c, type: fixed, parent: {link: a}, child: {link: b}, length: 1"),
            "closures[0].length: only a closure of type distance has a length");
  EXPECT_EQ(closure("name: c, type: distance, parent: {link: a}, child: {link: b}, length: long"),
            "closures[0].length: 'long' is not a finite number");
}

TEST(SceneReaderLoops, RefusesSpringsByKey) {
  EXPECT_EQ(refusal("springs: s"), "springs: expected a list");
  EXPECT_EQ(refusal("springs: [s]"),
            "springs[0]: expected a map with name, link_a, at_a, link_b, at_b, stiffness, "
            "rest_length, damping");
  EXPECT_EQ(spring("rest: 1"), "springs[0].rest: unknown key; did you mean 'rest_length'?");
  EXPECT_EQ(spring("at_a: 1"), "springs[0].at_a: expected a list of three numbers");
  EXPECT_EQ(spring("stiffness: stiff"), "springs[0].stiffness: 'stiff' is not a finite number");
  EXPECT_EQ(spring("rest_length: .inf"), "springs[0].rest_length: '.inf' is not a finite number");
  EXPECT_EQ(spring("link_a: a, link_b: b, stiffness: 1"), "springs[0]: name is missing");
  EXPECT_EQ(spring("name: s, link_b: b, stiffness: 1"), "springs[0]: link_a is missing");
  EXPECT_EQ(spring("name: s, link_a: a, stiffness: 1"), "springs[0]: link_b is missing");
  EXPECT_EQ(spring("name: s, link_a: a, link_b: b"), "springs[0]: stiffness is missing");
}

TEST(SceneReaderLoops, RefusesActuatedAndAssemblyByKey) {
  EXPECT_EQ(refusal("actuated: motor"),
            "actuated: expected a list of names of joints and closures");
  EXPECT_EQ(refusal("actuated: [[motor]]"),
            "actuated: expected a list of names of joints and closures");
  EXPECT_EQ(refusal("assembly: {elbow: 1}"), "assembly: expected a list");
  EXPECT_EQ(refusal("assembly: [elbow]"), "assembly[0]: expected a map with name, position");
  EXPECT_EQ(refusal("assembly: [{name: elbow, angle: 1}]"),
            "assembly[0].angle: unknown key; known are 'name' and 'position'");
  EXPECT_EQ(refusal("assembly: [{name: elbow, position: up}]"),
            "assembly[0].position: 'up' is not a finite number");
  EXPECT_EQ(refusal("assembly: [{name: a, position: 1}, {position: 1}]"),
            "assembly[1]: name is missing");
  EXPECT_EQ(refusal("assembly: [{name: elbow}]"), "assembly[0]: position is missing");
}

TEST(SceneReaderLoops, RefusesRedundancyByKey) {
  EXPECT_EQ(refusal("redundancy: minimum_norm"),
            "redundancy: expected a map with policy, zero_at, stiffness, effort_weights, "
            "rank_tolerance, length");
  EXPECT_EQ(redundancy("polcy: zero_at"), "redundancy.polcy: unknown key; did you mean 'policy'?");
  EXPECT_EQ(redundancy("policy: least"),
            "redundancy.policy: 'least' is not one of minimum_norm, zero_at, stiffness");
  EXPECT_EQ(redundancy("policy: zero_at, zero_at: c"),
            "redundancy.zero_at: expected a list of closures' names");
  EXPECT_EQ(redundancy("policy: zero_at"), "redundancy.zero_at: names no closure");
  EXPECT_EQ(redundancy("policy: stiffness"), "redundancy.stiffness: names no joint or closure");
  EXPECT_EQ(redundancy("zero_at: [c]"), "redundancy.zero_at: the policy is not zero_at");
  EXPECT_EQ(redundancy("stiffness: []"), "redundancy.stiffness: the policy is not stiffness");
  EXPECT_EQ(redundancy("policy: stiffness, stiffness: [{name: j}]"),
            "redundancy.stiffness[0]: stiffness is missing");
  EXPECT_EQ(redundancy("policy: stiffness, stiffness: [{name: j, weight: 1}]"),
            "redundancy.stiffness[0].weight: unknown key; known are 'name' and 'stiffness'");
  EXPECT_EQ(redundancy("effort_weights: [{name: j}]"),
            "redundancy.effort_weights[0]: weight is missing");
  EXPECT_EQ(redundancy("effort_weights: [{weight: 2}]"),
            "redundancy.effort_weights[0]: name is missing");
  EXPECT_EQ(redundancy("rank_tolerance: small"),
            "redundancy.rank_tolerance: 'small' is not a finite number");
  EXPECT_EQ(redundancy("length: long"), "redundancy.length: 'long' is not a finite number");
  EXPECT_EQ(redundancy("length: [1]"), "redundancy.length: expected auto or a number");
}

}  // namespace
}  // namespace virtual_work_dynamics
