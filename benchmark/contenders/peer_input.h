#pragma once

#include <vector>

#include "contenders/contender.h"
#include "contenders/robots.h"

namespace virtual_work_dynamics {

// Input for other libraries, which do not know mimic joints, and number joints rather than
// generalized coordinates.

/// Indices of the joints that move, mimic joints among them.
std::vector<int> movableJoints(const Mechanism& mechanism);

/// Motions with one entry for each of the given joints.
std::vector<Motion> jointMotions(const Mechanism& mechanism, const std::vector<Motion>& motions,
                                 const std::vector<int>& joints);

/// Efforts of the generalized coordinates from those of the given joints.
std::vector<long double> coordinateEfforts(const Mechanism& mechanism,
                                           const std::vector<int>& joints,
                                           const Eigen::VectorXd& joint_efforts);

/// The mechanism without fixed joints: their links become part of the links that carry them.
/// Movable joints, and so coordinates, keep their order.
Mechanism withoutFixedJoints(const Mechanism& mechanism);

/// Joints from the root to the tip when the mechanism is one serial chain, fixed joints included;
/// links beside it are allowed when they have no mass and carry nothing. Otherwise empty.
std::vector<int> serialPath(const Mechanism& mechanism);

}  // namespace virtual_work_dynamics
