#include "offline/inputs.h"

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "offline/generated_files.h"
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
  std::vector<std::pair<std::string, std::string>> outputs;  // by option
  if (!arguments.output.empty()) outputs.emplace_back("--output", arguments.output);
  if (!arguments.generate.empty()) {
    outputs.emplace_back("--generate", arguments.generate);
    outputs.emplace_back("--generate", generatedHeader(arguments));
  }
  std::vector<std::string> inputs = arguments.motion.files;
  inputs.insert(inputs.end(), {arguments.urdf, arguments.scene, arguments.rosparam});
  inputs.insert(inputs.end(), arguments.measured.files.begin(), arguments.measured.files.end());
  for (const std::string& input : inputs) {
    if (input.empty()) continue;
    for (const auto& [option, output] : outputs) {
      std::error_code missing;  // a missing file cannot be overwritten
      if (!std::filesystem::equivalent(input, output, missing)) continue;
      throw UsageError(option + ": '" + output + "' would overwrite the input '" + input + "'");
    }
  }
}

}  // namespace virtual_work_dynamics
