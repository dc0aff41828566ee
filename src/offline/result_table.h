#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Where the rows of a result go.
class ResultTable {
 public:
  virtual ~ResultTable() = default;
  /// Writes the time that a row begins with.
  virtual void beginRow(double time) = 0;
  /// Writes the recorded stamp of a row.
  virtual void writeStamp(std::int64_t stamp_ns) = 0;
  /// Writes efforts and reactions in the order of the columns, then the cells of Columns::more, and
  /// those of Columns::bounds, and ends the row. A number that is not finite is one that does not
  /// exist, except for bounds, which may be infinite.
  virtual void writeResults(const Eigen::VectorXd& effort, const std::vector<Wrench>& reactions,
                            const std::vector<double>& more, const std::vector<double>& bounds) = 0;
  /// Completes the file and commits it.
  virtual void finish() = 0;
};

}  // namespace virtual_work_dynamics
