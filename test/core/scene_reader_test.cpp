#include "virtual_work_dynamics/scene_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

#include "sample_robots.h"
#include "virtual_work_dynamics/error.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {
namespace {

Scene read(const std::string& yaml) {
  return readScene(YAML::Load(yaml));
}

void expectRefusal(const std::string& yaml, const std::string& part) {
  try {
    read(yaml);
    ADD_FAILURE() << "accepted: " << yaml;
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(SceneReader, EmptyIsTheDefault) {
  const Scene scene = read("");
  EXPECT_EQ(scene.gravity, Eigen::Vector3d(0, 0, -9.81));
  EXPECT_FALSE(scene.static_motion);
  EXPECT_TRUE(scene.include_active);
  EXPECT_EQ(scene.reactions, ReactionSelection::kAll);
}

TEST(SceneReader, ReadsEveryKey) {
  const Scene scene = read(R"(
gravity: [9.81, "0", 1e1]
motion: static
reactions: [b, ground]
include_active: false
strict_inertia: true
applied_wrenches:
  - {link: hand, at: [1, 2, 3], axes: root, force: [4, 5, 6], torque: [7, 8, 9]}
  - {link: foot}
  - {name: sole, link: foot, live: true, invert: true, deviation: {force: 2, torque: 0.5}}
joints:
  - {name: hip, stiffness: 1e9, rest: -1, damping: 2, coulomb: "3", coulomb_velocity: 4, rotor_inertia: 5, offset: -6}
  - {name: knee}
use_urdf_dynamics: true
)");
  EXPECT_EQ(scene.gravity, Eigen::Vector3d(9.81, 0, 10));
  EXPECT_TRUE(scene.static_motion);
  EXPECT_EQ(scene.reactions, ReactionSelection::kNamed);
  EXPECT_EQ(scene.reaction_names, (std::vector<std::string>{"b", "ground"}));
  EXPECT_FALSE(scene.include_active);
  EXPECT_TRUE(scene.strict_inertia);
  ASSERT_EQ(scene.applied_wrenches.size(), 3u);
  EXPECT_EQ(scene.applied_wrenches[0].link, "hand");
  EXPECT_EQ(scene.applied_wrenches[0].at, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.applied_wrenches[0].axes, Axes::kRoot);
  EXPECT_EQ(scene.applied_wrenches[0].force, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(scene.applied_wrenches[0].torque, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(scene.applied_wrenches[1].axes, Axes::kLink);
  EXPECT_FALSE(scene.applied_wrenches[0].live);
  EXPECT_FALSE(scene.applied_wrenches[0].invert);
  EXPECT_EQ(scene.applied_wrenches[2].name, "sole");
  EXPECT_TRUE(scene.applied_wrenches[2].live);
  EXPECT_TRUE(scene.applied_wrenches[2].invert);
  EXPECT_FALSE(scene.applied_wrenches[0].deviation);
  ASSERT_TRUE(scene.applied_wrenches[2].deviation);
  EXPECT_EQ(scene.applied_wrenches[2].deviation->force, 2);
  EXPECT_EQ(scene.applied_wrenches[2].deviation->torque, 0.5);
  ASSERT_EQ(scene.joints.size(), 2u);
  EXPECT_EQ(scene.joints[0].joint, "hip");
  EXPECT_EQ(scene.joints[0].stiffness, 1e9);
  EXPECT_EQ(scene.joints[0].rest, -1);
  EXPECT_EQ(scene.joints[0].damping, 2.0);
  EXPECT_EQ(scene.joints[0].coulomb, 3.0);
  EXPECT_EQ(scene.joints[0].coulomb_velocity, 4);
  EXPECT_EQ(scene.joints[0].rotor_inertia, 5);
  EXPECT_EQ(scene.joints[0].offset, -6);
  EXPECT_FALSE(scene.joints[1].damping);
  EXPECT_FALSE(scene.joints[1].coulomb);
  EXPECT_TRUE(scene.use_urdf_dynamics);
}

TEST(SceneReader, RefusesByKey) {
  expectRefusal("[1, 2]", "map");
  expectRefusal("gravty: [0, 0, 0]", "gravty: unknown key; did you mean 'gravity'?");
  expectRefusal("gravity: [0, 0]", "gravity");
  expectRefusal("gravity: [0, 0, heavy]", "'heavy'");
  expectRefusal("gravity: [0, 0, .nan]", "gravity");
  expectRefusal("gravity: [0, 0, 1e999]", "gravity");
  expectRefusal("gravity: 9.81", "gravity");
  expectRefusal("motion: fast", "'fast'");
  expectRefusal("motion: sttaic",
                "motion: 'sttaic' is neither full nor static; did you mean 'static'?");
  expectRefusal("closure: []", "closure: unknown key; did you mean 'closures'?");
  expectRefusal("{\"a\\nb\": 1}", "a\\nb: unknown key");
  expectRefusal("reactions: some", "'some'");
  expectRefusal("reactions: {a: 1}", "reactions");
  expectRefusal("reactions: [[a]]", "reactions");
  expectRefusal("include_active: maybe", "include_active");
  expectRefusal("{motion: full, motion: static}", "motion: given twice");
  expectRefusal("applied_wrenches: {link: a}", "applied_wrenches");
  expectRefusal("applied_wrenches: [{at: [0, 0, 0]}]", "applied_wrenches[0]: names no link");
  expectRefusal("applied_wrenches: [{link: a, frce: [0, 0, 0]}]", "applied_wrenches[0].frce");
  expectRefusal("applied_wrenches: [{link: a, axes: world}]", "'world'");
  for (const char* key : {"at", "force", "torque"}) {
    expectRefusal(
        std::string("applied_wrenches: [{name: w, link: a, live: true, ") + key + ": [0, 0, 0]}]",
        std::string("applied_wrenches[0].") + key + ": a live wrench has none");
  }
  expectRefusal("applied_wrenches: [{axes: link, name: w, link: a, live: true}]",
                "applied_wrenches[0].axes: a live wrench has none");
  expectRefusal("joints: {name: a}", "joints");
  expectRefusal("joints: [a]", "joints[0]");
  expectRefusal("joints: [{stiffness: 1}]", "joints[0]: names no joint");
  expectRefusal("joints: [{name: a}, {name: b, stifness: 1}]",
                "joints[1].stifness: unknown key; did you mean 'stiffness'?");
  expectRefusal("joints: [{name: a, damping: soft}]", "'soft'");
  expectRefusal("use_urdf_dynamics: perhaps", "use_urdf_dynamics");
}

TEST(SceneReader, NamesUnreadableFiles) {
  EXPECT_THROW(readSceneFile("/nowhere/scene.yaml"), FileError);
}

TEST(SceneReader, RefusesASecondDocument) {
  const std::string path = testing::TempDir() + "two_documents.yaml";
  std::ofstream(path) << "motion: static\n---\nmotion: full\n";
  EXPECT_THROW(readSceneFile(path), SceneError);
  std::ofstream(path) << "motion: static\n";
  EXPECT_TRUE(readSceneFile(path).static_motion);
  std::ofstream(path) << "";
  EXPECT_FALSE(readSceneFile(path).static_motion);
  std::remove(path.c_str());
}

std::string fileRefusal(const std::string& text) {
  const std::string path = testing::TempDir() + "refused.yaml";
  std::ofstream(path) << text;
  std::string message = "(not refused)";
  try {
    readSceneFile(path);
  } catch (const std::exception& error) {
    message = error.what();
    EXPECT_EQ(message.rfind(path + ": ", 0), 0u) << message;
    message = message.substr(std::min(message.size(), path.size() + 2));
  }
  std::remove(path.c_str());
  return message;
}

TEST(SceneReader, ACommaOutOfPlaceIsNamed) {
  const std::string invalid = "is not valid YAML: yaml-cpp: error at ";
  EXPECT_EQ(fileRefusal(","), invalid + "line 1, column 1: nothing can begin with what is here");
  EXPECT_EQ(fileRefusal("# a comment\n,\n"),
            invalid + "line 2, column 1: nothing can begin with what is here");
  EXPECT_EQ(fileRefusal("{gravity: [0, 0, -9.81]},"),
            invalid + "line 1, column 25: nothing can begin with what is here");
}

TEST(SceneReader, FilesThatGrowWithoutBoundAreRefused) {
  std::string aliases = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (char key = 'b'; key < 'k'; ++key) {
    aliases += std::string(1, key) + ": &" + key + " [";
    for (int i = 0; i < 9; ++i) aliases += std::string(i > 0 ? ", *" : "*") + char(key - 1);
    aliases += "]\n";
  }
  EXPECT_NE(fileRefusal(aliases).find("more than a million values"), std::string::npos);
  EXPECT_NE(fileRefusal("reactions: " + std::string(100000, '[')).find("nested more than 64 deep"),
            std::string::npos);
  // Aliases as such are welcome.
  EXPECT_EQ(fileRefusal("joints: [{name: a, damping: &d 2}, {name: b, damping: *d}]"),
            "(not refused)");
}

TEST(SceneReader, TolerancesAreFromZeroToBelowOne) {
  EXPECT_FALSE(read("").tolerances.any());
  const Scene scene = read("tolerances: {mass: 0.03, inertia: '0.1'}");
  EXPECT_EQ(scene.tolerances.mass, 0.03);
  EXPECT_EQ(scene.tolerances.inertia, 0.1);
  EXPECT_TRUE(read("tolerances: {inertia: 0.1}").tolerances.any());
  for (const char* wrong : {"mass: -0.1", "mass: 1", "inertia: .nan", "mass: .inf", "inertia: 1.5",
                            "inertia: much", "length: 0.1"}) {
    EXPECT_THROW(read(std::string("tolerances: {") + wrong + "}"), SceneError) << wrong;
  }
  EXPECT_THROW(read("tolerances: 0.1"), SceneError);
}

TEST(Scene, RequestedReactionsAreInDepthFirstOrderGroundFirst) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  EXPECT_EQ(requestedReactions(mechanism, read("")),
            (std::vector<std::string>{"joint_1", "joint_2"}));
  EXPECT_TRUE(requestedReactions(mechanism, read("reactions: none")).empty());
  EXPECT_EQ(requestedReactions(mechanism, read("reactions: [joint_2, ground, joint_1]")),
            (std::vector<std::string>{"ground", "joint_1", "joint_2"}));
  EXPECT_THROW(requestedReactions(mechanism, read("reactions: [elbow]")), SceneError);
  EXPECT_THROW(requestedReactions(mechanism, read("reactions: [joint_1, joint_1]")), SceneError);
}

TEST(Scene, ReactionsOfClosuresStandBehindThoseOfJoints) {
  const Mechanism mechanism = readUrdf(pendulumUrdf());
  const auto reactions = [&](const std::string& wanted) {
    return requestedReactions(mechanism,
                              read("closures: [{name: z, type: fixed, parent: {link: a}, child: "
                                   "{link: b}}, {name: c, type: fixed, parent: {link: a}, child: "
                                   "{link: b}}]\nreactions: " +
                                   wanted));
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(reactions("all"), (Names{"joint_1", "joint_2", "z", "c"}));
  EXPECT_EQ(reactions("[c, joint_2, ground]"), (Names{"ground", "joint_2", "c"}));
  EXPECT_EQ(reactions("none"), Names());
  EXPECT_THROW(reactions("[c, d]"), SceneError);
  EXPECT_THROW(reactions("[c, c]"), SceneError);
}

}  // namespace
}  // namespace virtual_work_dynamics
