#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "offline/loop_sample.h"
#include "offline/motion_file.h"
#include "offline/result_writer.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// Of what has an effort: coordinates, then actuated closures.
std::vector<std::string> namesOfEfforts(const Mechanism& mechanism,
                                        const ClosedLoopDynamics& dynamics);

/// Names of the columns that a mechanism with loops adds: what of efforts and reactions is
/// determined, and how far each closure is violated.
std::vector<std::string> loopColumns(const Columns& results, const std::vector<Closure>& closures);

/// Their cells.
/// @param results flags of these are appended; more than these may have been computed
void appendLoopCells(const LoopSample& sample, const Columns& results, bool child_axes,
                     std::vector<double>& cells);

/// How close rows come to singular positions.
class Conditions {
 public:
  void note(std::size_t row, const LoopSample& sample);

  /// "condition 12.3 at worst, line 7, at 0.5 s"
  std::string worst(const MotionFile& file) const;
  /// Rows that are close, for practical purposes, but none that are singular.
  std::size_t close() const { return close_; }

 private:
  double largest_ = 0;
  std::size_t row_ = 0;
  std::size_t close_ = 0;
};

/// Makes NaN of what is not determined.
void leaveOutUndetermined(const LoopSample& sample, bool child_axes, Eigen::VectorXd& effort,
                          std::vector<Wrench>& reactions);

}  // namespace virtual_work_dynamics
