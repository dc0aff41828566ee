#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/effort_doubts.h"
#include "offline/result_writer.h"
#include "virtual_work_dynamics/deviations.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Standard deviations of rows: columns of what the motion's covariance makes, if it is known, and
/// of what the scene's tolerances make, if it has any.
class DeviationRows {
 public:
  /// @param request of what is written, in child axes or in root axes
  /// @param mechanism must outlive it   @param table whose rows are computed, which must, too
  /// @throws Error, one line, when neither a covariance nor a tolerance nor a wrench's deviation is
  ///   known.
  DeviationRows(const Mechanism& mechanism, const Scene& scene, const Request& request,
                const MotionTable& table, const std::string& path);

  /// Names of its columns.
  std::vector<std::string> columns(const Columns& results) const;
  /// Computes a row and adds its cells. @param load with which `results` were computed
  void add(std::size_t row, const Motion& motion, const Load& load, const Results& results,
           std::vector<double>& cells);

  /// Standard deviation of an effort of the row that was added last, by all that is known of.
  double ofEffort(Eigen::Index effort) const;

  /// A line for each effort whose deviation, as rms of all rows, is more than `threshold` times its
  /// own rms, and one for what counts as exact because its deviation is not known, or for loops
  /// that the motion does not close.
  std::string notes(double threshold) const;

 private:
  const Mechanism& mechanism_;
  const MotionTable& table_;
  std::string path_;
  bool of_motion_;
  Deviations deviations_;
  Deviations::Workspace workspace_;
  MotionCovariance covariance_;
  std::vector<std::string> exact_;
  double violation_ = 0;                // of loops, relative: the largest of all rows
  std::optional<EffortDoubts> doubts_;  // none without efforts
};

}  // namespace virtual_work_dynamics
