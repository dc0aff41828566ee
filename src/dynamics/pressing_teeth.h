#pragma once

#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/request.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// Whether teeth press wheels apart. This force has the amount of what they bear, on whichever
/// flank, so that reactions are not linear in forces, while efforts are.
bool teethPress(const Scene& scene);

/// Which results such forces reach: those of the teeth and of the joints between their wheels, and
/// all reactions where reactions are chosen by a policy. By number of ResultNumbers.
std::vector<bool> reachedByTeeth(const Mechanism& mechanism, const Scene& scene,
                                 const Request& request, std::size_t efforts);

}  // namespace virtual_work_dynamics
