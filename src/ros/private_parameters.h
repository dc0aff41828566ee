#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <set>
#include <string>
#include <vector>

#include "virtual_work_dynamics/error.h"

namespace ros {
class NodeHandle;
}

namespace virtual_work_dynamics {

/// A parameter of the node is unknown, or has the wrong type or value.
class ParameterError : public Error {
 public:
  using Error::Error;
};

/// The private parameters of a node, read once and type-checked; remembers what was asked for, so
/// that keys nobody knows can be refused. Names may be nested: "estimator/window". Integers and
/// numeric strings are numbers (rosparam turns `1e9` into a string). Getters return the fallback
/// for a parameter that is not set, and throw ParameterError naming one of the wrong type.
class PrivateParameters {
 public:
  /// Takes all parameters in the namespace of `private_node`, NodeHandle("~").
  /// @throws ParameterError when the parameter server does not answer.
  explicit PrivateParameters(const ros::NodeHandle& private_node);
  /// The same from a struct (or an invalid value: nothing is set).
  explicit PrivateParameters(XmlRpc::XmlRpcValue tree);

  /// True when the parameter is set. Does not count as reading it.
  bool has(const std::string& name) const;

  double number(const std::string& name, double fallback);
  int integer(const std::string& name, int fallback);
  bool boolean(const std::string& name, bool fallback);
  std::string text(const std::string& name, const std::string& fallback);
  std::vector<double> numbers(const std::string& name, const std::vector<double>& fallback = {});
  std::vector<std::string> texts(const std::string& name,
                                 const std::vector<std::string>& fallback = {});
  /// The value as it is, with everything below it; an invalid value when it is not set.
  XmlRpc::XmlRpcValue raw(const std::string& name);

  /// Marks a parameter as known that another library of this node reads by itself.
  void expect(const std::string& name) { known_.insert(name); }

  /// @throws ParameterError naming every parameter that was set but never read.
  void refuseUnknown() const;

 private:
  const XmlRpc::XmlRpcValue* find(const std::string& name) const;
  const XmlRpc::XmlRpcValue* read(const std::string& name);

  XmlRpc::XmlRpcValue tree_;
  std::set<std::string> known_;
};

/// A value inside a raw parameter as a finite number; `name` stands for it in the message.
/// @throws ParameterError when it is none.
double numberOf(const XmlRpc::XmlRpcValue& value, const std::string& name);

/// The same for a list of numbers.
std::vector<double> numbersOf(const XmlRpc::XmlRpcValue& value, const std::string& name);

/// "parameter ~name: problem", for errors about a parameter's value.
ParameterError parameterError(const std::string& name, const std::string& problem);

}  // namespace virtual_work_dynamics
