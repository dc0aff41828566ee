#pragma once

#include <functional>
#include <vector>

#include "virtual_work_dynamics/motion.h"
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

/// Gives the load at a position of the mechanism, for wrenches that do not move with their links,
/// as those measured in the frame of another link.
/// @param motion whose positions and orientations count
/// @param load has one wrench for each applied wrench of the scene, whose values are replaced
using LoadLaw = std::function<void(const Motion& motion, Load& load)>;

}  // namespace virtual_work_dynamics
