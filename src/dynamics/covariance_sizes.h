#pragma once

#include <cstddef>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_covariance.h"

namespace virtual_work_dynamics {

/// @param wrenches number of the scene's applied wrenches
/// @throws MotionError when a covariance does not have as many parts as what it is of.
void requireSizes(const Mechanism& mechanism, std::size_t wrenches,
                  const MotionCovariance& covariance);

}  // namespace virtual_work_dynamics
