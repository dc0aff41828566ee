#include "ros/private_parameters.h"

#include <ros/node_handle.h>
#include <ros/param.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/printable.h"
#include "ros/private_name.h"

namespace virtual_work_dynamics {
namespace {

using XmlRpc::XmlRpcValue;

std::string describe(const XmlRpcValue& value) {
  std::string text;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<const bool&>(value) ? "the boolean true" : "the boolean false";
    case XmlRpcValue::TypeInt:
      return "the number " + std::to_string(static_cast<const int&>(value));
    case XmlRpcValue::TypeDouble: {
      const double number = static_cast<const double&>(value);
      if (!std::isfinite(number)) return "the number " + std::to_string(number);
      text = "the number ";
      appendNumber(text, number);
      return text;
    }
    case XmlRpcValue::TypeString:
      return "the text " + inQuotes(static_cast<const std::string&>(value));
    case XmlRpcValue::TypeArray:
      return "a list of " + std::to_string(value.size());
    case XmlRpcValue::TypeStruct:
      return "a map";
    default:
      return "a value of another type";
  }
}

ParameterError wrongType(const std::string& name, const std::string& expected,
                         const XmlRpcValue& value) {
  return parameterError(name, "expected " + expected + ", got " + describe(value));
}

const std::string& textOf(const XmlRpcValue& value, const std::string& name) {
  if (value.getType() != XmlRpcValue::TypeString) throw wrongType(name, "text", value);
  return static_cast<const std::string&>(value);
}

std::string element(const std::string& name, int index) {
  return name + "[" + std::to_string(index) + "]";
}

void collectUnknown(const XmlRpcValue& tree, const std::string& prefix,
                    const std::set<std::string>& known, std::vector<std::string>& unknown) {
  for (const auto& member : tree) {
    const std::string name = prefix + member.first;
    if (known.count(name) > 0) continue;
    const bool is_map = member.second.getType() == XmlRpcValue::TypeStruct;
    // Keys with this prefix, if any, follow it in the set's order.
    const auto next = known.lower_bound(name + "/");
    const bool is_group = next != known.end() && next->compare(0, name.size() + 1, name + "/") == 0;
    if (is_map && is_group) {
      collectUnknown(member.second, name + "/", known, unknown);
    } else {
      unknown.push_back(name);
    }
  }
}

}  // namespace

ParameterError parameterError(const std::string& name, const std::string& problem) {
  return ParameterError("parameter " + privateName(name) + ": " + problem);
}

double numberOf(const XmlRpcValue& value, const std::string& name) {
  double number = std::numeric_limits<double>::quiet_NaN();
  if (value.getType() == XmlRpcValue::TypeInt) {
    number = static_cast<const int&>(value);
  } else if (value.getType() == XmlRpcValue::TypeDouble) {
    number = static_cast<const double&>(value);
  } else if (value.getType() == XmlRpcValue::TypeString) {
    if (!parseNumber(static_cast<const std::string&>(value), number)) {
      throw wrongType(name, "a number", value);
    }
  }
  if (!std::isfinite(number)) throw wrongType(name, "a finite number", value);
  return number;
}

std::vector<double> numbersOf(const XmlRpcValue& value, const std::string& name) {
  if (value.getType() != XmlRpcValue::TypeArray) throw wrongType(name, "a list of numbers", value);
  std::vector<double> numbers;
  for (int i = 0; i < value.size(); ++i) numbers.push_back(numberOf(value[i], element(name, i)));
  return numbers;
}

PrivateParameters::PrivateParameters(const ros::NodeHandle& private_node) {
  // A failed read looks like an unset parameter, so that the first question is whether there is
  // anything to read.
  std::vector<std::string> names;
  if (!ros::param::getParamNames(names)) {
    throw ParameterError("the parameter server does not answer");
  }
  const std::string& space = private_node.getNamespace();
  const bool any = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return name == space || name.compare(0, space.size() + 1, space + "/") == 0;
  });
  if (any && !ros::param::get(space, tree_)) {
    throw ParameterError("the parameters of " + space + " cannot be read");
  }
  if (tree_.valid() && tree_.getType() != XmlRpcValue::TypeStruct) {
    throw ParameterError("parameter " + space + ": expected a map, got " + describe(tree_));
  }
}

PrivateParameters::PrivateParameters(XmlRpcValue tree) : tree_(std::move(tree)) {
  if (tree_.valid() && tree_.getType() != XmlRpcValue::TypeStruct) {
    throw ParameterError("expected a map of parameters, got " + describe(tree_));
  }
}

const XmlRpcValue* PrivateParameters::find(const std::string& name) const {
  const XmlRpcValue* value = &tree_;
  for (std::string::size_type begin = 0; begin <= name.size();) {
    const auto end = std::min(name.find('/', begin), name.size());
    const std::string key = name.substr(begin, end - begin);
    if (value->getType() != XmlRpcValue::TypeStruct || !value->hasMember(key)) return nullptr;
    value = &(*value)[key];
    begin = end + 1;
  }
  return value;
}

const XmlRpcValue* PrivateParameters::read(const std::string& name) {
  known_.insert(name);
  return find(name);
}

bool PrivateParameters::has(const std::string& name) const {
  return find(name) != nullptr;
}

double PrivateParameters::number(const std::string& name, double fallback) {
  const XmlRpcValue* value = read(name);
  return value ? numberOf(*value, name) : fallback;
}

int PrivateParameters::integer(const std::string& name, int fallback) {
  const XmlRpcValue* value = read(name);
  if (!value) return fallback;
  const double number = numberOf(*value, name);
  if (number != std::floor(number) || std::abs(number) > std::numeric_limits<int>::max()) {
    throw wrongType(name, "an integer", *value);
  }
  return static_cast<int>(number);
}

bool PrivateParameters::boolean(const std::string& name, bool fallback) {
  const XmlRpcValue* value = read(name);
  if (!value) return fallback;
  if (value->getType() != XmlRpcValue::TypeBoolean) throw wrongType(name, "true or false", *value);
  return static_cast<const bool&>(*value);
}

std::string PrivateParameters::text(const std::string& name, const std::string& fallback) {
  const XmlRpcValue* value = read(name);
  return value ? textOf(*value, name) : fallback;
}

std::vector<double> PrivateParameters::numbers(const std::string& name,
                                               const std::vector<double>& fallback) {
  const XmlRpcValue* value = read(name);
  return value ? numbersOf(*value, name) : fallback;
}

std::vector<std::string> PrivateParameters::texts(const std::string& name,
                                                  const std::vector<std::string>& fallback) {
  const XmlRpcValue* value = read(name);
  if (!value) return fallback;
  if (value->getType() != XmlRpcValue::TypeArray) throw wrongType(name, "a list of texts", *value);
  std::vector<std::string> texts;
  for (int i = 0; i < value->size(); ++i) texts.push_back(textOf((*value)[i], element(name, i)));
  return texts;
}

XmlRpcValue PrivateParameters::raw(const std::string& name) {
  const XmlRpcValue* value = read(name);
  return value ? *value : XmlRpcValue();
}

void PrivateParameters::refuseUnknown() const {
  if (!tree_.valid()) return;
  std::vector<std::string> unknown;
  collectUnknown(tree_, "", known_, unknown);
  if (unknown.empty()) return;
  std::string message = unknown.size() == 1 ? "unknown parameter" : "unknown parameters";
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const std::string& name : unknown) {
    const std::string nearest = nearestName(name, known);
    message += (&name == &unknown[0] ? " " : ", ") + privateName(shortened(name)) +
               (nearest.empty() ? "" : " (did you mean " + privateName(nearest) + "?)");
  }
  message += "; known are";
  for (const std::string& name : known_) message += (name == *known_.begin() ? " " : ", ") + name;
  throw ParameterError(message);
}

}  // namespace virtual_work_dynamics
