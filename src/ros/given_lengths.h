#pragma once

#include <string>
#include <vector>

#include "virtual_work_dynamics/given.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// What is given besides coordinates without a drive, by joint states: lengths of cylinders, and of
/// slides that close loops. In messages they have the names of these; in JointSample,
/// MotionEstimator and all that counts joints, their indices go on behind those of coordinates.
std::vector<std::string> givenLengths(const Mechanism& mechanism, const Scene& scene,
                                      const Given& given);

/// What is given, without the lengths: driven numbers are those of drives alone, which come first.
Given withoutLengths(const Mechanism& mechanism, const Scene& scene, const Given& given);

/// Refuses what is given but cannot come by joint states: free axes that turn and poses of links.
/// @throws SceneError naming it
void requireLengths(const Mechanism& mechanism, const Scene& scene, const Given& given);

}  // namespace virtual_work_dynamics
