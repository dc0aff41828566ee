#pragma once

#include <cstddef>
#include <memory>

#include "virtual_work_dynamics/closed_loop_dynamics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Computes rows of a MotionTable with closed loops: several samples in each vector instruction
/// where the same is computed for all of them, and the others as ClosedLoopDynamics::compute()
/// does. Results of the former stay arrays until they are read. Serves one thread. Allocates in its
/// constructor only.
class LoopRows {
 public:
  /// @param dynamics must outlive it
  /// @param capacity most rows of compute()
  LoopRows(const ClosedLoopDynamics& dynamics, std::size_t capacity);
  ~LoopRows();
  LoopRows(LoopRows&&) noexcept;

  /// Computes rows [first, first + count) of a table of all coordinates, with velocities and
  /// accelerations.
  /// @param loads one for each of these rows; null: the scene's own
  void compute(const MotionTable& table, std::size_t first, std::size_t count, const Load* loads);
  /// Results of row `index` of those computed last; valid until another one is read or computed.
  const Results& read(std::size_t index);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
