#pragma once

#include <unistd.h>

#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

#include "offline/extra_columns.h"
#include "offline/motion_file.h"
#include "offline/progress.h"
#include "offline/result_writer.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Names of the columns that closed loops add: which efforts and reactions are determined, and how
/// far each closure is violated.
std::vector<std::string> loopColumns(const Columns& results,
                                     const std::vector<std::string>& closures);

/// How close rows come to singular positions.
class Conditions {
 public:
  void note(std::size_t row, const Results& results);

  /// Says, for example, "condition 12.3 at worst, line 7, at 0.5 s".
  std::string worst(const MotionFile& file) const;
  /// Number of rows close to a singular position, without the singular ones.
  std::size_t close() const { return close_; }

 private:
  double largest_ = 0;
  std::size_t row_ = 0;
  std::size_t close_ = 0;
};

/// The axes of the reactions that are written.
enum class ReactionAxes { kRoot, kChild, kInertial };

/// Writes rows in their order, and tells of those that overflowed or lack values. Shows progress
/// until it is destroyed.
class Rows {
 public:
  /// @param loops whether the columns include loopColumns()
  /// @param extra columns that stand last; must outlive it, as all other arguments must
  Rows(const MotionFile& file, const Columns& columns, ReactionAxes axes, bool loops,
       ExtraColumns& extra, ResultTable& table);

  /// @param load with which `results` were computed
  void write(std::size_t row, const Motion& motion, const Load& load, const Results& results);

  /// Lines on what is missing in the rows; empty when nothing is.
  std::string warning() const;

 private:
  void take(std::size_t row, const Motion& motion, const Results& results);
  Determined inAxes(const Determined& components) const;
  void leaveOut(const Results& results);
  void addLoopCells(const Results& results);

  const MotionFile& file_;
  const Columns& columns_;
  const bool child_axes_, inertial_axes_, loops_;
  ExtraColumns& extra_;
  ResultTable& table_;
  // The results that are written; those that only certificates need come after them.
  Eigen::VectorXd effort_;
  std::vector<Wrench> reactions_;
  std::vector<double> more_, bounds_;
  Progress progress_{std::cerr, ProgressLine::whereIs(STDERR_FILENO), "computing"};
  std::size_t overflowed_ = 0;
  std::size_t first_row_ = 0;
  std::size_t singular_ = 0;
  std::size_t first_singular_row_ = 0;
  std::size_t undirected_ = 0;
  std::size_t first_undirected_row_ = 0;
  Conditions conditions_;
};

}  // namespace virtual_work_dynamics
