#include "ros/xmlrpc_to_yaml.h"

#include <cmath>

#include "base/number_text.h"
#include "ros/private_parameters.h"

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

std::string yamlNumber(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  std::string text;
  appendNumber(text, value);
  return text;
}

}  // namespace

YAML::Node xmlRpcToYaml(const XmlRpcValue& value, const std::string& name) {
  switch (value.getType()) {
    case XmlRpcValue::TypeInvalid:
      return YAML::Node(YAML::NodeType::Null);
    case XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<const bool&>(value) ? "true" : "false");
    case XmlRpcValue::TypeInt:
      return YAML::Node(std::to_string(static_cast<const int&>(value)));
    case XmlRpcValue::TypeDouble:
      return YAML::Node(yamlNumber(static_cast<const double&>(value)));
    case XmlRpcValue::TypeString:
      return YAML::Node(static_cast<const std::string&>(value));
    case XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) {
        list.push_back(xmlRpcToYaml(value[i], name + "[" + std::to_string(i) + "]"));
      }
      return list;
    }
    case XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (const auto& member : value) {
        map[member.first] = xmlRpcToYaml(member.second, name + "/" + member.first);
      }
      return map;
    }
    default:
      throw parameterError(name, "is a date or binary data");
  }
}

}  // namespace virtual_work_dynamics
