#pragma once

#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include "ros/private_parameters.h"

namespace virtual_work_dynamics {

/// The document that readScene() reads, from the parameter ~scene; null when it is not set. What
/// comes from a command line is text, and is read as YAML: the whole (`_scene:="{gravity: [0, 0,
/// 0]}"`), or a list or map below one of its keys (`_scene/gravity:="[0, 0, 0]"`).
/// @throws ParameterError naming the parameter when it is no map, or a text is not valid YAML.
YAML::Node sceneDocument(const XmlRpc::XmlRpcValue& parameter);

/// What is wrong with the scene, with the name of the parameter in front.
ParameterError sceneParameterError(const SceneError& error);

}  // namespace virtual_work_dynamics
