#pragma once

#include <string>
#include <vector>

#include "measurement.h"

namespace virtual_work_dynamics {

/// One line of the result.
struct ResultRow {
  std::string scene;
  Label label;
  double ns = 0, ns_min = 0, ns_max = 0;  ///< a sample: median, least, largest of the rounds
  double max_relative_error = 0;
};

ResultRow resultRow(const std::string& scene, const Candidate& candidate);

/// Head line and rows of the CSV.
std::string resultCsv(const std::vector<ResultRow>& rows);

/// The rows of one scene for a reader: run times and how many times faster each is than KDL's chain
/// solver, or its tree solver where the robot is no chain.
std::string resultTable(const std::string& scene, const std::vector<ResultRow>& rows);

}  // namespace virtual_work_dynamics
