#pragma once

namespace virtual_work_dynamics {

/// Positions and velocities beyond this are not those of a robot, rad or m and rad/s or m/s: the
/// squares from which noises are found would overflow.
constexpr double kLargestMotion = 1e100;

}  // namespace virtual_work_dynamics
