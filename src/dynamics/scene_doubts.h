#pragma once

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Checks what a scene says of how well it is known.
/// @throws SceneError for tolerances that are not from 0 to below 1, and for deviations of wrenches
///   that are not zero or more.
void requireSoundDoubts(const Scene& scene);

}  // namespace virtual_work_dynamics
