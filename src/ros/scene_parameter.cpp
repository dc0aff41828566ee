#include "ros/scene_parameter.h"

#include <string>

#include "base/printable.h"
#include "ros/private_name.h"
#include "ros/xmlrpc_to_yaml.h"
#include "scene/yaml_document.h"

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

constexpr char kScene[] = "scene";

YAML::Node parsed(const std::string& text, const std::string& name) {
  try {
    return readYamlDocument(text);
  } catch (const YAML::Exception& error) {
    throw parameterError(name, "is not valid YAML: " + printable(error.what()));
  } catch (const SceneError& error) {
    throw parameterError(name, error.what());
  }
}

bool beginsListOrMap(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\n");
  return first != std::string::npos && (text[first] == '[' || text[first] == '{');
}

// No key whose value is a word or a name has one that begins like a list or a map. Elements of
// lists cannot be set on a command line; a name among them stays as it is.
YAML::Node withTextsParsed(const XmlRpcValue& value, const std::string& name) {
  if (value.getType() == XmlRpcValue::TypeString) {
    const auto& text = static_cast<const std::string&>(value);
    if (beginsListOrMap(text)) return parsed(text, name);
  }
  if (value.getType() != XmlRpcValue::TypeStruct) return xmlRpcToYaml(value, name);
  YAML::Node map(YAML::NodeType::Map);
  for (const auto& member : value) {
    map[member.first] = withTextsParsed(member.second, name + "/" + member.first);
  }
  return map;
}

}  // namespace

YAML::Node sceneDocument(const XmlRpcValue& parameter) {
  const bool is_text = parameter.getType() == XmlRpcValue::TypeString;
  YAML::Node document = is_text ? parsed(static_cast<const std::string&>(parameter), kScene)
                                : withTextsParsed(parameter, kScene);
  if (document.IsMap() || document.IsNull()) return document;
  std::string problem = "expected a map of keys";
  if (is_text && document.IsScalar()) {
    problem += ", got the text '" + document.Scalar() + "'; rosparam load FILE " +
               privateName(kScene) + " sets those of a file";
  }
  throw parameterError(kScene, problem);
}

ParameterError sceneParameterError(const SceneError& error) {
  // By which the reader says that a scene is meant.
  const std::string what = error.what(), word = "scene: ";
  const bool repeats = what.compare(0, word.size(), word) == 0;
  return parameterError(kScene, repeats ? what.substr(word.size()) : what);
}

}  // namespace virtual_work_dynamics
