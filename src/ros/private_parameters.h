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

/// The private parameters of a node, read once and type-checked. The object remembers which were
/// asked for, so that unknown ones can be refused. Names may be nested: "estimator/lag".
/// Integers and numeric strings are numbers (rosparam turns `1e9` into a string). Getters return
/// the fallback for a parameter that is not set, and throw ParameterError naming one of a wrong
/// type.
class PrivateParameters {
 public:
  /// Takes all parameters in the namespace of `private_node`, NodeHandle("~").
  /// @throws ParameterError when the parameter server does not answer.
  explicit PrivateParameters(const ros::NodeHandle& private_node);
  /// Takes the parameters from a struct; with an invalid value, none is set.
  explicit PrivateParameters(XmlRpc::XmlRpcValue tree);

  /// Whether the parameter is set. A call does not count as reading it.
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

  /// Marks as known a parameter that another library of this node reads.
  void expect(const std::string& name) { known_.insert(name); }

  /// @throws ParameterError naming every parameter that was set but never read.
  void refuseUnknown() const;

 private:
  const XmlRpc::XmlRpcValue* find(const std::string& name) const;
  const XmlRpc::XmlRpcValue* read(const std::string& name);

  XmlRpc::XmlRpcValue tree_;
  std::set<std::string> known_;
};

/// Reads a value inside a raw parameter as a finite number; `name` stands for it in the message.
/// @throws ParameterError when it is not a finite number.
double numberOf(const XmlRpc::XmlRpcValue& value, const std::string& name);

/// Reads a value inside a raw parameter as a list of finite numbers; `name` stands for it in the
/// message. @throws ParameterError when it is not a list of finite numbers.
std::vector<double> numbersOf(const XmlRpc::XmlRpcValue& value, const std::string& name);

/// Makes the error "parameter <full name>: problem".
ParameterError parameterError(const std::string& name, const std::string& problem);

}  // namespace virtual_work_dynamics
