#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/number_text.h"
#include "base/output_file.h"
#include "base/wrench_components.h"
#include "offline/result_table.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// What the columns of a result hold, in this order after the time.
struct Columns {
  bool stamps = false;                 ///< whether there is a column of recorded stamps
  std::vector<std::string> efforts;    ///< as Dynamics::effortNames()
  std::vector<bool> residuals;         ///< as Dynamics::residuals(); empty: none is
  std::vector<std::string> reactions;  ///< names of joints, six columns each
  std::vector<std::string> more;       ///< names of columns
  std::vector<std::string> bounds;     ///< names of columns whose numbers may be infinite

  /// The column of an effort, such as "effort.elbow"; a residual of free motions has no more than
  /// its name.
  std::string effortColumn(std::size_t effort) const {
    const bool is_residual = effort < residuals.size() && residuals[effort];
    return (is_residual ? "" : "effort.") + efforts[effort];
  }
};

/// The names of the columns of a result, the time first.
std::vector<std::string> resultColumns(const Columns& columns);

/// The header line of a result.
/// @throws FileError naming a name that cannot stand in a CSV header.
std::string resultHeader(const Columns& columns);

/// Writes results as CSV rows, each number with the fewest digits that read back equal; a number
/// that is not finite becomes an empty cell, and a bound that is infinite "inf" or "-inf".
class ResultWriter : public ResultTable {
 public:
  ResultWriter(OutputFile& file, const std::string& header) : file_(file), text_(header) {}

  void beginRow(double time) override { appendNumber(text_, time); }
  /// In seconds with all nanoseconds.
  void writeStamp(std::int64_t stamp_ns) override;
  void writeResults(const Eigen::VectorXd& effort, const std::vector<Wrench>& reactions,
                    const std::vector<double>& more, const std::vector<double>& bounds) override;
  /// Hands the rest over to the file and commits it.
  void finish() override;

 private:
  void appendCell(double value);

  OutputFile& file_;
  std::string text_;  // not yet written
};

}  // namespace virtual_work_dynamics
