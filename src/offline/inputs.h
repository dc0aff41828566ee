#pragma once

#include "offline/arguments.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The scene of the file on the command line, or the default one, with what options replace.
/// @throws FileError or SceneError naming the file.
Scene askedScene(const Arguments& arguments);

/// @throws UsageError when the output would replace a file that is read.
void refuseToOverwriteInput(const Arguments& arguments);

}  // namespace virtual_work_dynamics
