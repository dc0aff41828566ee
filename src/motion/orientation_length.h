#pragma once

namespace virtual_work_dynamics {

/// How far the length of a quaternion may be off 1 for an orientation; beyond, it is none.
constexpr double kOrientationOff = 1e-3;
/// From how far on a user is told of it: digits of single precision are no reason.
constexpr double kOrientationDoubt = 1e-6;

}  // namespace virtual_work_dynamics
