#pragma once

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Returns the scene. Where its loops cannot be closed from its assembly, waits for joint states
/// from which they can, and puts their positions in place of the assembly's.
/// @param patience how long it waits, s
/// @throws SceneError naming what is wrong with the scene, and AssemblyError when no such joint
///   states come in time.
Scene assembledScene(const Mechanism& mechanism, const Scene& scene, double patience);

}  // namespace virtual_work_dynamics
