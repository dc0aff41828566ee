#include "offline/inputs.h"

#include <filesystem>
#include <system_error>

#include "offline/task_inputs.h"
#include "virtual_work_dynamics/scene_reader.h"
#include "virtual_work_dynamics/urdf_reader.h"

namespace virtual_work_dynamics {

Mechanism askedRobot(const Arguments& arguments) {
  try {
    return readUrdf(arguments.inputs->description);
  } catch (const UrdfError& error) {
    throw UrdfError(arguments.inputs->description_name + ": " + error.what());
  }
}

std::string scenePrefix(const Arguments& arguments) {
  const std::string& name = arguments.inputs->scene_name;
  return name.empty() ? "" : name + ": ";
}

Scene askedScene(const Arguments& arguments) {
  Scene scene;
  try {
    scene = readScene(arguments.inputs->scene);
  } catch (const SceneError& error) {
    throw SceneError(scenePrefix(arguments) + error.what());
  }
  replaceInScene(arguments, scene);
  return scene;
}

void replaceInScene(const Arguments& arguments, Scene& scene) {
  if (arguments.gravity) scene.gravity = *arguments.gravity;
  if (arguments.reactions) {
    scene.reactions = *arguments.reactions;
    scene.reaction_names = arguments.reaction_names;
  }
}

void refuseToOverwriteInput(const Arguments& arguments) {
  if (arguments.output.empty()) return;
  std::vector<std::string> inputs = arguments.motion.files;
  inputs.insert(inputs.end(), {arguments.urdf, arguments.scene, arguments.rosparam});
  inputs.insert(inputs.end(), arguments.measured.files.begin(), arguments.measured.files.end());
  for (const std::string& input : inputs) {
    if (input.empty()) continue;
    std::error_code missing;  // a missing file cannot be overwritten
    if (std::filesystem::equivalent(input, arguments.output, missing)) {
      throw UsageError("--output: '" + arguments.output + "' would overwrite the input '" + input +
                       "'");
    }
  }
}

}  // namespace virtual_work_dynamics
