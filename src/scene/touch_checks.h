#pragma once

#include <string>

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Checks the numbers of what touches a plane; `place` is how messages begin. @throws SceneError
void requireSoundTouch(const Closure& closure, const std::string& place);

}  // namespace virtual_work_dynamics
