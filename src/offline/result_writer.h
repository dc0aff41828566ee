#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "offline/output_file.h"
#include "virtual_work_dynamics/certificates.h"
#include "virtual_work_dynamics/inverse_dynamics.h"

namespace virtual_work_dynamics {

/// The header line of a result: time, efforts of the coordinates, six columns a reaction, then
/// those of the certificates where there are any.
/// @throws FileError naming a joint whose name cannot stand in a CSV header.
std::string resultHeader(const std::vector<std::string>& coordinates,
                         const std::vector<std::string>& reactions, bool certificates);

/// Writes results as CSV rows, each number with the shortest digits that read back equal; what is
/// not finite becomes an empty cell.
class ResultWriter {
 public:
  ResultWriter(OutputFile& file, const std::string& header) : file_(file), text_(header) {}

  /// @param certificates null: there are none
  void writeRow(double time, const Eigen::VectorXd& effort, const std::vector<Wrench>& reactions,
                const Certificates* certificates);
  /// Hands the rest over to the file and commits it.
  void finish();

 private:
  void appendCell(double value);

  OutputFile& file_;
  std::string text_;  // not yet written
};

}  // namespace virtual_work_dynamics
