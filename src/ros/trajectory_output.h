#pragma once

#include <memory>

#include "ros/outputs.h"

namespace virtual_work_dynamics {

/// Makes ~joint_trajectory: the input trajectory with the efforts filled in. Where a residual
/// stands in place of an effort, see Scene::free_motion, nothing delivers one: it is zero.
std::unique_ptr<Output> makeTrajectoryOutput();

}  // namespace virtual_work_dynamics
