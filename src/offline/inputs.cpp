#include "offline/inputs.h"

#include <filesystem>
#include <system_error>

#include "virtual_work_dynamics/scene_reader.h"

namespace virtual_work_dynamics {

Scene askedScene(const Arguments& arguments) {
  Scene scene = arguments.scene.empty() ? Scene() : readSceneFile(arguments.scene);
  if (arguments.gravity) scene.gravity = *arguments.gravity;
  if (arguments.reactions) {
    scene.reactions = *arguments.reactions;
    scene.reaction_names = arguments.reaction_names;
  }
  return scene;
}

void refuseToOverwriteInput(const Arguments& arguments) {
  if (arguments.output.empty()) return;
  std::vector<std::string> inputs = arguments.motion.files;
  inputs.insert(inputs.end(), {arguments.urdf, arguments.scene});
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
