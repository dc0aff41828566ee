#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "npz/npz_writer.h"
#include "offline/result_table.h"
#include "offline/result_writer.h"

namespace virtual_work_dynamics {

/// Writes results as .npz, an array for each column of the CSV; a number that is not finite becomes
/// NaN, and stamps are times of numpy.
class NpzResultWriter : public ResultTable {
 public:
  /// @param file must outlive it. @param rows that will be written
  /// @param mechanism what mechanismJson() says, which is kept in the file as kMechanismFile
  NpzResultWriter(OutputFile& file, const Columns& columns, std::size_t rows,
                  const std::string& mechanism);

  void beginRow(double time) override;
  void writeStamp(std::int64_t stamp_ns) override;
  void writeResults(const Eigen::VectorXd& effort, const std::vector<Wrench>& reactions,
                    const std::vector<double>& more, const std::vector<double>& bounds) override;
  void finish() override;

 private:
  void add(double value);

  NpzWriter writer_;
};

}  // namespace virtual_work_dynamics
