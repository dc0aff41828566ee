#include "replay/dumped_parameters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <string>

#include "base/number_text.h"

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

// The words that PyYAML, with which rosparam reads and writes, takes for true or false; y and n are
// texts to it.
bool isTruth(const std::string& text, bool& truth) {
  static const std::set<std::string> kTrue{"yes",  "Yes", "YES", "true", "True",
                                           "TRUE", "on",  "On",  "ON"};
  static const std::set<std::string> kFalse{"no",    "No",  "NO",  "false", "False",
                                            "FALSE", "off", "Off", "OFF"};
  truth = kTrue.count(text) > 0;
  return truth || kFalse.count(text) > 0;
}

// Whether PyYAML takes a text for a number in decimals: one with a point, whose exponent has a
// sign, or a whole one.
bool isDecimal(const std::string& text) {
  std::size_t at = 0;
  const auto take = [&](const char* any) {
    const std::size_t begin = at;
    at = std::min(text.find_first_not_of(any, at), text.size());
    return at - begin;
  };
  constexpr char kDigits[] = "0123456789";
  const std::size_t signs = take("-+"), before = take(kDigits);
  if (signs > 1) return false;
  if (at == text.size()) return before > 0;
  if (take(".") != 1) return false;
  const std::size_t after = take(kDigits);
  if (before == 0 && (after == 0 || signs > 0)) return false;
  if (at == text.size()) return true;
  return take("eE") == 1 && take("-+") == 1 && take(kDigits) > 0 && at == text.size();
}

// A scalar without quotes is what it looks like to PyYAML.
XmlRpcValue scalarFrom(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return XmlRpcValue(text);
  bool truth = false;
  if (isTruth(text, truth)) return XmlRpcValue(truth);
  double number = 0;
  if (!isDecimal(text) || !parseNumber(text, number)) {
    const bool decoded = YAML::convert<double>::decode(node, number) && !std::isfinite(number);
    return decoded ? XmlRpcValue(number) : XmlRpcValue(text);  // .inf or .nan
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
