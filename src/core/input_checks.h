#pragma once

#include <Eigen/Core>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// @throws MotionError naming the first vector of `motion` whose length is not `coordinates`.
void requireLengths(const Motion& motion, Eigen::Index coordinates);

/// The scene. @throws SceneError when it needs ClosedLoopDynamics, naming why.
const Scene& openChain(const Scene& scene);

/// Index of the link that an applied wrench acts on. @throws SceneError when there is none.
int linkOf(const Mechanism& mechanism, const AppliedWrench& wrench);

}  // namespace virtual_work_dynamics
