#pragma once

#include <cstddef>

#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Copies row `row` of a table of all coordinates, with velocities and accelerations, into
/// `motion`. Does not allocate when `motion` has the lengths already.
void takeRow(const MotionTable& table, std::size_t row, Motion& motion);

}  // namespace virtual_work_dynamics
