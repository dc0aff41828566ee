#pragma once

#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include <string>

namespace virtual_work_dynamics {

/// Converts a parameter back to the YAML that it was loaded from: numbers keep all their digits,
/// texts stay as they are. An invalid value (not set) becomes a null node.
/// @param name stands for the value in messages.
/// @throws ParameterError for dates and binary data, which YAML scenes do not have, and beyond the
///   bounds of readYamlDocument().
YAML::Node xmlRpcToYaml(const XmlRpc::XmlRpcValue& value, const std::string& name);

}  // namespace virtual_work_dynamics
