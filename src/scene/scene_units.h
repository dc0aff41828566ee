#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Numbers of a scene that look as if they were in another unit: gravity in mm/s^2, angles of
/// closures in degrees, payloads in grams. One text each, without the scene's name.
std::vector<std::string> sceneUnitDoubts(const Mechanism& mechanism, const Scene& scene);

}  // namespace virtual_work_dynamics
