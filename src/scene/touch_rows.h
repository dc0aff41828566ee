#pragma once

#include <Eigen/Core>
#include <vector>

#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// A condition of what touches a plane: the point that touches does not move along a direction.
struct TouchRow {
  const char* name;
  Eigen::Vector3d direction;  ///< in axes of the contact, see TouchConditions
  bool has_position, adopts_constant;
};

/// The conditions of a closure that touches, in the order of their multipliers.
std::vector<TouchRow> touchRows(const Closure& closure);

/// Whether all conditions of any closure restrict positions.
bool hasPositions(const Closure& closure);
/// Whether that holds for all closures and couplings of a scene.
bool hasPositions(const Scene& scene);

/// How many conditions any closure has.
int conditionCount(const Closure& closure);

}  // namespace virtual_work_dynamics
