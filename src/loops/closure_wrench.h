#pragma once

#include <Eigen/Core>

#include "virtual_work_dynamics/mechanism.h"

namespace virtual_work_dynamics {

/// The wrench that the parent of a closure exerts on its child, in root axes; the moment is about
/// the child frame's origin.
struct ClosureWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< N m
};

/// The part of a wrench whose component along an axis does work on a motion along or about it: the
/// force where that motion slides, the moment where it turns.
inline Eigen::Vector3d& activePart(Unit motion, ClosureWrench& wrench) {
  return motion == Unit::kMetre ? wrench.force : wrench.moment;
}

}  // namespace virtual_work_dynamics
