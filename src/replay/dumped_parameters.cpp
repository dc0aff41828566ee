#include "replay/dumped_parameters.h"

#include <cmath>
#include <limits>
#include <string>

#include "base/number_text.h"

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

// A scalar without quotes is what it looks like. Numbers that rosparam would take for texts, such
// as 1e9, are read as numbers in the end either way.
XmlRpcValue scalarFrom(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return XmlRpcValue(text);
  bool truth = false;
  if (YAML::convert<bool>::decode(node, truth)) return XmlRpcValue(truth);
  double number = 0;
  if (!parseNumber(text, number)) {
    if (!YAML::convert<double>::decode(node, number)) return XmlRpcValue(text);
    return XmlRpcValue(number);  // .inf or .nan
  }
  const bool whole = text.find_first_not_of("+-0123456789") == std::string::npos;
  if (whole && std::abs(number) <= std::numeric_limits<int>::max()) {
    return XmlRpcValue(static_cast<int>(number));
  }
  return XmlRpcValue(number);
}

}  // namespace

XmlRpcValue parametersFrom(const YAML::Node& node) {
  XmlRpcValue value;
  if (node.IsScalar()) return scalarFrom(node);
  if (node.IsSequence()) {
    value.setSize(static_cast<int>(node.size()));
    int i = 0;
    for (const YAML::Node& element : node) value[i++] = parametersFrom(element);
  } else if (node.IsMap()) {
    value.begin();  // an empty map is one, too
    for (const auto& entry : node) {
      if (!entry.first.IsScalar() || entry.second.IsNull()) continue;
      value[entry.first.Scalar()] = parametersFrom(entry.second);
    }
  }
  return value;
}

}  // namespace virtual_work_dynamics
