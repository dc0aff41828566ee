#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Efforts beyond the limits of the description, row by row.
class LimitRows {
 public:
  /// @param limits of the first efforts, by name, N m or N; infinite: none
  LimitRows(std::vector<std::string> names, std::vector<double> limits);

  /// Takes a row. @param time s
  void add(double time, const Results& results);
  /// A line for each joint whose effort was beyond its limit: from when to when, in how many rows,
  /// and the peak; or one line that none was.
  std::string text(const std::string& where) const;

 private:
  struct Excess {
    std::size_t rows = 0;
    double first = 0, last = 0;  // s
    double peak = 0, at = 0;     // N m or N, s
  };

  const std::vector<std::string> names_;
  const std::vector<double> limits_;
  std::vector<Excess> found_;
};

}  // namespace virtual_work_dynamics
