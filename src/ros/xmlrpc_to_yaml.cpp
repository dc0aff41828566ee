#include "ros/xmlrpc_to_yaml.h"

#include <cmath>

#include "base/number_text.h"
#include "ros/private_parameters.h"
#include "scene/yaml_document.h"

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

class Converter {
 public:
  YAML::Node convert(const XmlRpcValue& value, const std::string& name, std::size_t depth) {
    if (depth > kDeepestYaml) {
      throw parameterError(name, "is nested more than " + std::to_string(kDeepestYaml) + " deep");
    }
    if (++values_ > kMostYamlValues) {
      throw parameterError(name, "is one of more than " + std::to_string(kMostYamlValues) +
                                     " values, too many for a scene");
    }
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
          list.push_back(convert(value[i], name + "[" + std::to_string(i) + "]", depth + 1));
        }
        return list;
      }
      case XmlRpcValue::TypeStruct: {
        YAML::Node map(YAML::NodeType::Map);
        for (const auto& member : value) {
          map.force_insert(member.first,
                           convert(member.second, name + "/" + member.first, depth + 1));
        }
        return map;
      }
      default:
        throw parameterError(name, "is a date or binary data");
    }
  }

 private:
  std::size_t values_ = 0;
};

}  // namespace

YAML::Node xmlRpcToYaml(const XmlRpcValue& value, const std::string& name) {
  return Converter().convert(value, name, 0);
}

}  // namespace virtual_work_dynamics
