#pragma once

#include <vector>

#include "virtual_work_dynamics/results.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Force and torque of every applied wrench of a scene at one instant, in the scene's order: an
/// argument of computations that replaces the values in the scene. Links, points of action and axes
/// stay those of the scene.
struct Load {
  /// The load of a scene without applied wrenches.
  Load() = default;
  /// The load with the values in the scene. Allocates.
  explicit Load(const Scene& scene);

  std::vector<Wrench> wrenches;
};

}  // namespace virtual_work_dynamics
