#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_table.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Checks a motion. @throws MotionError naming the first vector whose length is not `coordinates`.
void requireLengths(const Motion& motion, Eigen::Index coordinates);

/// Checks the orientations of a motion. @throws MotionError unless they are `count` of unit length,
/// to 1e-6, or none.
void requireOrientations(const Motion& motion, std::size_t count);

/// Checks a table of a robot whose root moves. @throws MotionError unless its first `rows` have
/// motions of the root.
void requireRoots(const MotionTable& table, std::size_t rows);

/// Checks the orientations of a table. @throws MotionError unless its first `rows` have `count`, or
/// it has none at all.
void requireOrientations(const MotionTable& table, std::size_t rows, std::size_t count);

/// Checks a load. @throws SceneError when it has not one wrench for each of the `applied` ones of
/// the scene.
void requireLoad(const Load& load, std::size_t applied);

/// Returns the scene itself. @throws SceneError saying why it is not an open chain.
const Scene& openChain(const Scene& scene);

/// Checks the mechanism that a scene is for. @throws SceneError when it lacks joint types of the
/// scene, or has doubtful inertias and the scene is strict about them.
void requireSoundDescription(const Mechanism& mechanism, const Scene& scene);

/// Child links of the joints whose reactions are named, in the same order; that of "ground" is the
/// root link. @throws SceneError when a name is not a joint's, or is given twice.
std::vector<int> linksOf(const Mechanism& mechanism, const std::vector<std::string>& reactions);

/// Checks the names of the applied wrenches. @throws SceneError for a name given twice, and for a
/// live wrench without a name.
void requireWrenchNames(const Scene& scene);

/// Index of the link that an applied wrench of the scene acts on. @throws SceneError when the
/// mechanism has no such link.
int linkOf(const Mechanism& mechanism, const Scene& scene, std::size_t index);

}  // namespace virtual_work_dynamics
