#pragma once

#include <string>
#include <vector>

#include "offline/result_writer.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Names like "lower.effort.elbow" and "upper.foot.fz": the intervals that results can be in.
std::vector<std::string> intervalColumns(const Columns& results);

/// Adds the cells of a row, which may be infinite.
void addIntervals(const Results& results, const Columns& columns, bool child_axes,
                  std::vector<double>& cells);

}  // namespace virtual_work_dynamics
