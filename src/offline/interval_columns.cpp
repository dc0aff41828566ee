#include "offline/interval_columns.h"

#include <cstddef>

#include "base/wrench_components.h"

namespace virtual_work_dynamics {

std::vector<std::string> intervalColumns(const Columns& results) {
  std::vector<std::string> columns;
  for (const std::string bound : {"lower.", "upper."}) {
    for (std::size_t i = 0; i < results.efforts.size(); ++i) {
      columns.push_back(bound + results.effortColumn(i));
    }
    for (const std::string& name : results.reactions) {
      for (const char* component : kWrenchComponents) {
        columns.push_back(bound + name + "." + component);
      }
    }
  }
  return columns;
}

void addIntervals(const Results& results, const Columns& columns, bool child_axes,
                  std::vector<double>& cells) {
  for (const ForceBounds* bound : {&results.loops.least, &results.loops.most}) {
    for (std::size_t i = 0; i < columns.efforts.size(); ++i) {
      cells.push_back(bound->effort[static_cast<Eigen::Index>(i)] + 0.0);
    }
    const std::vector<Wrench>& wrenches = child_axes ? bound->child_axes : bound->root_axes;
    for (std::size_t i = 0; i < columns.reactions.size(); ++i) {
      for (int j = 0; j < 3; ++j) cells.push_back(wrenches[i].force[j] + 0.0);
      for (int j = 0; j < 3; ++j) cells.push_back(wrenches[i].torque[j] + 0.0);
    }
  }
}

}  // namespace virtual_work_dynamics
