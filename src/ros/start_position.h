#pragma once

#include "ros/inverse_dynamics_parameters.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Returns the scene of the parameters. Where its loops cannot be closed from its assembly, waits
/// for joint states from which they can, and puts their positions in place of the assembly's.
/// @throws SceneError naming what is wrong with the scene, and AssemblyError when no such joint
///   states come in time.
Scene assembledScene(const Mechanism& mechanism, const InverseDynamicsParameters& parameters);

}  // namespace virtual_work_dynamics
