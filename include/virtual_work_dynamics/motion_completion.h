#pragma once

#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Fills in the velocities or accelerations that a recorded motion lacks. They are those of the
/// estimator's polynomial (window and order are the defaults of EstimatorSettings) through the rows
/// around each row, evaluated at the row itself, so without lag; at both ends the window stays
/// inside of the table. Derivatives that are given stay as they are; given velocities are fitted
/// together with the positions. Tables shorter than the window are fitted with fewer rows and a
/// lower order. Positions become the unwrapped ones (unwrapPositions()). Allocates.
/// @param motion a table whose columns are generalized coordinates of `mechanism`.
/// @throws MotionError for a joint that is not a generalized coordinate, shapes that disagree, too
///   few rows (accelerations need three, velocities two), or times that do not increase, naming the
///   row counted from 1.
MotionTable completeMotion(const Mechanism& mechanism, MotionTable motion);

/// Index of the first time that is not later than the one before it; times.size() when all times
/// increase.
std::size_t firstTimeThatDoesNotIncrease(const std::vector<double>& times);

}  // namespace virtual_work_dynamics
