#include "motion/table_row.h"

namespace virtual_work_dynamics {

void takeRow(const MotionTable& table, std::size_t row, Motion& motion) {
  if (!table.roots.empty()) motion.root = table.roots[row];
  for (std::size_t i = 0; i < motion.orientations.size(); ++i) {
    if (table.orientations.size() == 0) break;
    const auto at = static_cast<Eigen::Index>(row);
    motion.orientations[i].coeffs() =
        table.orientations.row(at).segment<4>(static_cast<Eigen::Index>(4 * i));
  }
  if (motion.q.size() == 0) return;  // a table without columns has no rows
  const auto index = static_cast<Eigen::Index>(row);
  motion.q = table.positions.row(index);
  motion.qd = table.velocities.row(index);
  motion.qdd = table.accelerations.row(index);
}

}  // namespace virtual_work_dynamics
