#pragma once

#include <unistd.h>

#include <Eigen/Core>
#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

#include "offline/certified_rows.h"
#include "offline/loop_rows.h"
#include "offline/loop_sample.h"
#include "offline/motion_file.h"
#include "offline/progress.h"
#include "offline/result_writer.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// Writes rows in their order, and tells of those that overflowed. Shows progress until its end.
class Rows {
 public:
  /// @param child_axes reactions in child link axes rather than root axes
  /// @param certified null when no certificates are asked for
  Rows(const MotionFile& file, const Columns& columns, bool child_axes, CertifiedRows* certified,
       ResultWriter& writer);

  std::size_t count() const { return file_.table.times.size(); }

  /// Of a motion of all coordinates.
  const Motion& motion(std::size_t row);

  /// Of a Workspace, or of LagrangeDynamics.
  template <typename Results>
  void write(std::size_t row, const Results& results) {
    take(row, results.effort(), child_axes_ ? results.childAxes() : results.rootAxes());
    more_.clear();
    if (certified_) certified_->check(motion(row), results, file_.lines[row], more_);
    put(row);
  }

  /// Of a mechanism with closed loops: its own results, or those of another formalism.
  template <typename Results>
  void write(std::size_t row, const LoopSample& loops, const Results& results) {
    take(row, results.effort(), child_axes_ ? results.childAxes() : results.rootAxes());
    takeLoops(row, loops);
    if (certified_) certified_->check(loops, results, file_.lines[row], more_);
    put(row);
  }

  /// Lines on what is missing in the rows; may be none.
  std::string warning() const;

 private:
  // Those that are written; certificates' own come behind them.
  void take(std::size_t row, const Eigen::VectorXd& effort, const std::vector<Wrench>& reactions);
  void takeLoops(std::size_t row, const LoopSample& loops);
  void put(std::size_t row);

  const MotionFile& file_;
  const Columns& columns_;
  bool child_axes_;
  CertifiedRows* certified_;
  ResultWriter& writer_;
  Motion motion_;
  Eigen::VectorXd effort_;
  std::vector<Wrench> reactions_;
  std::vector<double> more_;
  Progress progress_{std::cerr, isatty(STDERR_FILENO) == 1};
  std::size_t overflowed_ = 0;
  std::size_t first_line_ = 0;
  std::size_t singular_ = 0;
  std::size_t first_singular_line_ = 0;
  Conditions conditions_;
};

}  // namespace virtual_work_dynamics
