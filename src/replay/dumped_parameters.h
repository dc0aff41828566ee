#pragma once

#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

namespace virtual_work_dynamics {

/// Parameters of a dump as the parameter server has them once they are loaded. What is null is
/// left out. A null node becomes an invalid value.
XmlRpc::XmlRpcValue parametersFrom(const YAML::Node& node);

}  // namespace virtual_work_dynamics
