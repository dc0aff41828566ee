#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "offline/motion_file.h"
#include "virtual_work_dynamics/results.h"

namespace virtual_work_dynamics {

/// Contacts that would have to pull, cables that would have to push, and forces outside their
/// friction cones, row by row.
class HoldRows {
 public:
  /// @param names Dynamics::oneSided()
  explicit HoldRows(std::vector<std::string> names);

  void add(std::size_t row, const Results& results);
  /// A line for each that does not hold in some rows.
  std::string text(const MotionFile& file) const;

 private:
  struct Found {
    std::size_t rows = 0, first = 0;
  };

  std::vector<std::string> names_;
  std::vector<std::array<Found, 6>> found_;  // by Hold
};

}  // namespace virtual_work_dynamics
