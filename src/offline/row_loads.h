#pragma once

#include <cstddef>
#include <vector>

#include "offline/motion_file.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/scene.h"

namespace virtual_work_dynamics {

/// The loads of the rows of a file: the scene's, with the wrenches that have columns in the file as
/// these say, at their points of action and in their axes.
class RowLoads {
 public:
  /// @param file must outlive it
  /// @throws FileError naming a wrench of the file that the scene does not have, and a live one of
  ///   the scene that has no columns.
  RowLoads(const Scene& scene, const MotionFile& file);

  /// Whether rows have loads of their own.
  bool vary() const { return !wrenches_.empty(); }
  /// The load of the scene.
  const Load& own() const { return own_; }
  /// Writes the load of a row. Does not allocate when `load` has as many wrenches as own().
  void get(std::size_t row, Load& load) const;

 private:
  struct Varying {
    std::size_t wrench;  // of the scene
    double sign;
  };

  const Eigen::MatrixXd& values_;
  Load own_;
  std::vector<Varying> wrenches_;  // in the order of the file
};

}  // namespace virtual_work_dynamics
