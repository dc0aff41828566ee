#pragma once

#include <Eigen/Core>

#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// The velocities with which a recording starts and ends, by column, rad/s or m/s.
struct EndSlopes {
  Eigen::VectorXd start;
  Eigen::VectorXd end;
};

/// Estimates from the positions alone how a recording moves in its first and in its last row: by
/// the slope of the polynomial through up to five rows at that end. Where that slope is not larger
/// than three times its own uncertainty, the difference from the slope of the polynomial through a
/// row less, the joint is at rest; so it is in a table of one or two rows.
/// @param table times increase, and positions are finite; other parts are not used.
EndSlopes endSlopes(const MotionTable& table);

}  // namespace virtual_work_dynamics
