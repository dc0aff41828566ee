#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// @throws MotionError naming the first vector of `motion` whose length is not `coordinates`.
void requireLengths(const Motion& motion, Eigen::Index coordinates);

/// @throws SceneError when `load` has not one wrench for each of the `applied` ones of the scene.
void requireLoad(const Load& load, std::size_t applied);

/// The scene. @throws SceneError when it needs ClosedLoopDynamics, naming why.
const Scene& openChain(const Scene& scene);

/// @throws SceneError when the scene is strict about inertias and the mechanism has doubtful ones.
void requireSoundInertias(const Mechanism& mechanism, const Scene& scene);

/// Child links of the joints whose reactions are named, in the same order; that of "ground" is the
/// root link. @throws SceneError when one is no joint, or is named twice.
std::vector<int> linksOf(const Mechanism& mechanism, const std::vector<std::string>& reactions);

/// Index of the link that an applied wrench acts on. @throws SceneError when there is none.
int linkOf(const Mechanism& mechanism, const AppliedWrench& wrench);

}  // namespace virtual_work_dynamics
