#include "ros/xmlrpc_to_yaml.h"

#include <gtest/gtest.h>

#include <string>

#include "ros/private_parameters.h"

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue nested(int depth) {
  XmlRpcValue value(1);
  for (int i = 0; i < depth; ++i) {
    XmlRpcValue list;
    list.setSize(1);
    list[0] = value;
    value = list;
  }
  return value;
}

XmlRpcValue listOf(int size) {
  XmlRpcValue list;
  list.setSize(size);
  for (int i = 0; i < size; ++i) list[i] = i;
  return list;
}

std::string refusal(const XmlRpcValue& value) {
  try {
    xmlRpcToYaml(value, "scene");
    return "";
  } catch (const ParameterError& error) {
    return error.what();
  }
}

TEST(XmlRpcToYaml, IsBoundedInDepth) {
  EXPECT_EQ(refusal(nested(64)), "");
  const std::string message = refusal(nested(65));
  EXPECT_EQ(message.rfind("parameter ~scene[0][0]", 0), 0u) << message;
  EXPECT_NE(message.find("is nested more than 64 deep"), std::string::npos) << message;
}

TEST(XmlRpcToYaml, IsBoundedInTheNumberOfValues) {
  EXPECT_EQ(refusal(listOf(999999)), "");
  EXPECT_EQ(refusal(listOf(1000000)),
            "parameter ~scene[999999]: is one of more than 1000000 values, too many for a scene");
}

TEST(XmlRpcToYaml, MapsKeepTheirKeys) {
  XmlRpcValue value;
  for (int i = 0; i < 3; ++i) value["key_" + std::to_string(i)] = i;
  const YAML::Node node = xmlRpcToYaml(value, "scene");
  ASSERT_EQ(node.size(), 3u);
  EXPECT_EQ(node["key_2"].as<int>(), 2);
}

}  // namespace
}  // namespace virtual_work_dynamics
