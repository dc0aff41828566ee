#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Computes rows of a MotionTable with closed loops: several samples in each vector instruction
/// where the same is computed for all of them, and the others as ClosedLoopDynamics::compute()
/// does. Serves one thread. Allocates in its constructor only.
class LoopRows {
 public:
  /// @param dynamics must outlive it
  explicit LoopRows(const ClosedLoopDynamics& dynamics);
  ~LoopRows();
  LoopRows(LoopRows&&) noexcept;

  /// Results of the sample computed last; before, as large as those of samples.
  const Results& results() const;
  /// Computes rows [first, first + count) of a table of all coordinates, with velocities and
  /// accelerations.
  /// @param loads one for each of these rows; null: the scene's own
  /// @param results receive those of these rows
  void compute(const MotionTable& table, std::size_t first, std::size_t count, const Load* loads,
               Results* results);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Copies row `row` of a table of all coordinates, with velocities and accelerations, into
/// `motion`. Does not allocate when `motion` has the lengths already.
void takeRow(const MotionTable& table, std::size_t row, Motion& motion);

}  // namespace virtual_work_dynamics
