#pragma once

#include <vector>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The mechanism with more joints, each with a coordinate of its own and a link behind it that has
/// no mass and the joint's name. Joints stay in their order; among those of its link an added one
/// comes where its name does.
/// @param added their parent links are those of `mechanism`; the other indices are set here
/// @param doubts in place of those of the mechanism
/// @param transmissions in place of those of the mechanism
Mechanism withAddedJoints(const Mechanism& mechanism, const std::vector<Joint>& added,
                          std::vector<Doubt> doubts, std::vector<Transmission> transmissions);

}  // namespace virtual_work_dynamics
