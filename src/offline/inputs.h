#pragma once

#include <string>

#include "offline/arguments.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

// The following take Arguments::inputs, which must have been read.

/// The robot of the description. @throws UrdfError naming where that stands.
Mechanism askedRobot(const Arguments& arguments);

/// The scene, or the default one, with what options replace.
/// @throws SceneError naming where it stands.
Scene askedScene(const Arguments& arguments);

/// Replaces in a scene what options do.
void replaceInScene(const Arguments& arguments, Scene& scene);

/// What stands before a message about the scene.
std::string scenePrefix(const Arguments& arguments);

/// @throws UsageError when the output would replace a file that is read.
void refuseToOverwriteInput(const Arguments& arguments);

}  // namespace virtual_work_dynamics
