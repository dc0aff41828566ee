#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "offline/arguments.h"

namespace virtual_work_dynamics {

/// The description and the scene that a command line names, and where they stand.
struct TaskInputs {
  std::string description;       ///< text of a URDF
  std::string description_name;  ///< for messages
  std::string description_file;
  YAML::Node scene;        ///< null: the default one
  std::string scene_name;  ///< for messages; empty: the default one
  std::string scene_file;
  YAML::Node parameters;  ///< of the node, where a dump of parameters has them; or null
};

/// Reads the description from --urdf, from --rosparam, or from the bag that has the motion; and the
/// scene from --scene, or from where the description is. In a dump and in a bag, the names are
/// those by which the node of --node would find them.
/// @throws UsageError when nothing names a description, FileError or SceneError, one line, when
///   there is none where it is said to be, or it cannot be read.
TaskInputs readTaskInputs(const Arguments& arguments);

}  // namespace virtual_work_dynamics
