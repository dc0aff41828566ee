#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Whether KDL can compute the efforts: of a chain without mimic joints and joint terms, or of such
/// a tree where KDL has a solver for trees. False where the program was built without KDL.
bool kdlComputes(const Mechanism& mechanism, const Scene& scene);

/// KDL's efforts of each state. @throws Error where KDL cannot compute them.
std::vector<std::vector<double>> kdlEfforts(const Mechanism& mechanism, const Scene& scene,
                                            const std::vector<Motion>& motions);

}  // namespace virtual_work_dynamics
