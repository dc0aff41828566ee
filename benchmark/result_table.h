#pragma once

#include <string>
#include <vector>

#include "measurement.h"

namespace virtual_work_dynamics {

/// One row of the result.
struct ResultRow {
  std::string scene;
  Label label;
  double ns = 0, ns_min = 0, ns_max = 0;  ///< ns per sample: median, least, largest of the rounds
  double max_relative_error = 0;
};

ResultRow resultRow(const std::string& scene, const Candidate& candidate);

/// The CSV of rows, with a header.
std::string resultCsv(const std::vector<ResultRow>& rows);

/// A table of the rows of one scene for a reader: run times, and how many times faster each is than
/// KDL's chain solver, or than its tree solver where the robot is not a chain.
std::string resultTable(const std::string& scene, const std::vector<ResultRow>& rows);

}  // namespace virtual_work_dynamics
