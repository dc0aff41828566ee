#include "offline/rows.h"

#include <algorithm>

#include "offline/loop_rows.h"

namespace virtual_work_dynamics {

Rows::Rows(const MotionFile& file, const Columns& columns, bool child_axes,
           CertifiedRows* certified, ResultWriter& writer)
    : file_(file),
      columns_(columns),
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

void Rows::takeLoops(std::size_t row, const LoopSample& loops) {
  if (loops.singular()) {
    if (++singular_ == 1) first_singular_line_ = file_.lines[row];
    leaveOutUndetermined(loops, child_axes_, effort_, reactions_);
  }
  conditions_.note(row, loops);
  more_.clear();
  appendLoopCells(loops, columns_, child_axes_, more_);
}

std::string Rows::warning() const {
  const auto rows = [](std::size_t count) {
    return std::to_string(count) + (count == 1 ? " row" : " rows");
  };
  std::string text;
  if (overflowed_ > 0) {
    text = "warning: " + file_.path + ": results of " + rows(overflowed_) +
           " overflow, first of line " + std::to_string(first_line_) + "; their cells are empty\n";
  }
  if (singular_ > 0) {
    text += "warning: " + file_.path + ": " + rows(singular_) +
            " in singular positions, first in line " + std::to_string(first_singular_line_) +
            "; cells of what is not determined there are empty\n";
  }
  if (conditions_.close() > 0) {
    text += "warning: " + file_.path + ": " + rows(conditions_.close()) +
            " close to singular positions, " + conditions_.worst(file_) +
            ": forces may be as many times the load\n";
  }
  return text;
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
