#pragma once

#include <cstddef>
#include <memory>

#include "virtual_work_dynamics/inverse_dynamics.h"
#include "virtual_work_dynamics/load.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Computes rows of a MotionTable in blocks (see BlockInverseDynamics) and hands the results out
/// sample by sample, as InverseDynamics::compute() would have left them.
class SampleBlock {
 public:
  /// @param capacity most rows of a block; they are divided among `threads`.
  /// Its instructions are those of `inverse_dynamics`, which must outlive it.
  /// @throws Error when `threads` is less than 1.
  SampleBlock(const InverseDynamics& inverse_dynamics, std::size_t capacity, int threads = 1);
  ~SampleBlock();
  SampleBlock(SampleBlock&&) noexcept;
  SampleBlock& operator=(SampleBlock&&) noexcept;

  std::size_t capacity() const;

  /// Computes rows [first, first + count) of `table`, whose joints are the generalized coordinates
  /// in their order and which has velocities and accelerations. Does not allocate.
  /// @param loads one for each of these rows; null: the scene's own
  /// @throws MotionError when the table is not such a one, or has fewer rows, or count is more than
  ///   capacity().
  void compute(const MotionTable& table, std::size_t first, std::size_t count,
               const Load* loads = nullptr);

  /// Results of sample `index` of the last block, into a workspace of the same InverseDynamics.
  /// Does not allocate. @throws MotionError when there is no such sample, or the workspace is
  /// another plan's.
  void read(std::size_t index, Workspace& workspace) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace virtual_work_dynamics
