#include "offline/rows.h"

#include <algorithm>

namespace virtual_work_dynamics {

Rows::Rows(const MotionFile& file, const Columns& columns, bool child_axes,
           CertifiedRows* certified, ResultWriter& writer)
    : file_(file),
      child_axes_(child_axes),
      certified_(certified),
      writer_(writer),
      motion_(file.table.positions.cols()),
      effort_(static_cast<Eigen::Index>(columns.efforts.size())),
      reactions_(columns.reactions.size()) {}

const Motion& Rows::motion(std::size_t row) {
  if (motion_.q.size() > 0) {
    const auto index = static_cast<Eigen::Index>(row);
    motion_.q = file_.table.positions.row(index);
    motion_.qd = file_.table.velocities.row(index);
    motion_.qdd = file_.table.accelerations.row(index);
  }
  return motion_;
}

std::string Rows::warning() const {
  if (overflowed_ == 0) return "";
  return "warning: " + file_.path + ": results of " + std::to_string(overflowed_) + " row" +
         (overflowed_ == 1 ? "" : "s") + " overflow, first of line " + std::to_string(first_line_) +
         "; their cells are empty\n";
}

void Rows::take(std::size_t row, const Eigen::VectorXd& effort,
                const std::vector<Wrench>& reactions) {
  effort_ = effort.head(effort_.size());
  std::copy_n(reactions.begin(), reactions_.size(), reactions_.begin());
  const bool finite = effort_.allFinite() &&
                      std::all_of(reactions_.begin(), reactions_.end(), [](const Wrench& wrench) {
                        return wrench.force.allFinite() && wrench.torque.allFinite();
                      });
  if (!finite && ++overflowed_ == 1) first_line_ = file_.lines[row];
}

void Rows::put(std::size_t row) {
  writer_.writeRow(file_.table.times[row], effort_, reactions_, more_);
  progress_.update(row + 1, count());
}

}  // namespace virtual_work_dynamics
