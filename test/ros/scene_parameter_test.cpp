#include "ros/scene_parameter.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ros/private_parameters.h"
#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

Scene sceneOf(const XmlRpcValue& parameter) {
  return readScene(sceneDocument(parameter));
}

void expectRefused(const XmlRpcValue& parameter, const std::string& start) {
  try {
    sceneOf(parameter);
    ADD_FAILURE() << "not refused: " << start;
  } catch (const ParameterError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, start.size()), start);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

TEST(SceneParameter, NotSetIsTheDefaultScene) {
  EXPECT_EQ(sceneOf(XmlRpcValue()).gravity, Scene().gravity);
  EXPECT_EQ(sceneOf(XmlRpcValue("")).gravity, Scene().gravity);
}

TEST(SceneParameter, TextIsReadAsYaml) {
  const Scene scene = sceneOf(XmlRpcValue("{gravity: [0, 1.5, -2], reactions: [elbow]}"));
  EXPECT_EQ(scene.gravity, Eigen::Vector3d(0, 1.5, -2));
  EXPECT_EQ(scene.reaction_names, std::vector<std::string>{"elbow"});
  EXPECT_EQ(sceneOf(XmlRpcValue("gravity: [0, 0, 3]\nmotion: static\n")).gravity.z(), 3);
}

TEST(SceneParameter, TextBelowAKeyIsReadAsYaml) {
  XmlRpcValue tree;
  tree["gravity"] = " [0, 0, 4]";
  tree["applied_wrenches"] = "[{link: tool, force: [0, 0, -20]}]";
  tree["tolerances"]["mass"] = "1e-2";
  tree["redundancy"] = "{policy: least_squares}";
  XmlRpcValue reactions;
  reactions[0] = "[odd name]";
  tree["reactions"] = reactions;
  const YAML::Node document = sceneDocument(tree);
  EXPECT_EQ(document["redundancy"]["policy"].as<std::string>(), "least_squares");
  EXPECT_EQ(document["gravity"][2].as<double>(), 4);
  EXPECT_EQ(document["applied_wrenches"][0]["link"].as<std::string>(), "tool");
  EXPECT_EQ(document["tolerances"]["mass"].as<double>(), 0.01);
  // A name among others in a list is a name.
  EXPECT_EQ(document["reactions"][0].as<std::string>(), "[odd name]");
}

TEST(SceneParameter, RefusalsNameTheParameter) {
  expectRefused(XmlRpcValue("{gravity: [0, 0"), "parameter ~scene: is not valid YAML: ");
  expectRefused(XmlRpcValue(","), "parameter ~scene: is not valid YAML: ");
  expectRefused(XmlRpcValue("a: 1\n---\nb: 2"), "parameter ~scene: ");
  expectRefused(
      XmlRpcValue("scene.yaml"),
      "parameter ~scene: expected a map of keys, got the text 'scene.yaml'; rosparam load "
      "FILE ~scene");
  expectRefused(XmlRpcValue("[1, 2]"), "parameter ~scene: expected a map of keys");
  expectRefused(XmlRpcValue(5), "parameter ~scene: expected a map of keys");
  XmlRpcValue tree;
  tree["gravity"] = "[0, 0";
  expectRefused(tree, "parameter ~scene/gravity: is not valid YAML: ");
  EXPECT_EQ(std::string(sceneParameterError(SceneError("scene: motion: unknown")).what()),
            "parameter ~scene: motion: unknown");
  EXPECT_EQ(std::string(sceneParameterError(SceneError("reactions: none")).what()),
            "parameter ~scene: reactions: none");
}

}  // namespace
}  // namespace virtual_work_dynamics
