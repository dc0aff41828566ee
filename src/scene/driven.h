#pragma once

#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What a drive drives.
struct Driven {
  int coordinate = -1;      ///< -1: a closure
  std::size_t closure = 0;  ///< by index in the scene
};

/// What the drives of a scene drive, one after the other.
/// @throws SceneError for a name that is given twice, or that is neither that of a joint which
/// moves
///   by itself nor that of a closure with one free axis.
std::vector<Driven> drivenBy(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
