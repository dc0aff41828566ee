#pragma once

#include <cstddef>
#include <vector>

#include "virtual_work_dynamics/motion.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// A table whose rows are these motions, a hundredth of a second apart.
inline MotionTable tableOfMotions(const std::vector<Motion>& motions) {
  MotionTable table;
  const auto rows = static_cast<Eigen::Index>(motions.size());
  for (Eigen::MatrixXd* values : {&table.positions, &table.velocities, &table.accelerations}) {
    values->resize(rows, motions.front().q.size());
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Motion& motion = motions[static_cast<std::size_t>(row)];
    table.times.push_back(0.01 * static_cast<double>(row));
    table.positions.row(row) = motion.q;
    table.velocities.row(row) = motion.qd;
    table.accelerations.row(row) = motion.qdd;
  }
  return table;
}

}  // namespace virtual_work_dynamics
