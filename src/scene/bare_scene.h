#pragma once

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The scene without what does not come from masses and inertias of the description: gravity, the
/// root, closures and what is actuated stay.
Scene bareScene(Scene scene);

}  // namespace virtual_work_dynamics
