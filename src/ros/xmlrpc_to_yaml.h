#pragma once

#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include <string>

namespace virtual_work_dynamics {

/// A parameter as the YAML it was loaded from: numbers with all their digits, texts kept as they
/// are. An invalid value (not set) becomes a null node.
/// @param name stands for the value in messages.
/// @throws ParameterError for dates and binary data, which YAML scenes do not have.
YAML::Node xmlRpcToYaml(const XmlRpc::XmlRpcValue& value, const std::string& name);

}  // namespace virtual_work_dynamics
