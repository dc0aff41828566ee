#pragma once

#include <cstddef>
#include <memory>

#include "virtual_work_dynamics/dynamics.h"
#include "virtual_work_dynamics/mechanism.h"
#include "virtual_work_dynamics/motion_covariance.h"
#include "virtual_work_dynamics/motion_table.h"

namespace virtual_work_dynamics {

/// Computes rows of a MotionTable a block at a time and hands the results out row by row: several
/// samples in each vector instruction, divided among threads. With closed loops, samples whose rank
/// is in doubt are computed one after the other; so are those with springs between points, actuated
/// closures or a policy that weighs reactions.
class SampleRows {
 public:
  /// @param dynamics must outlive it.
  /// @param capacity the most rows of a block.
  /// @throws Error when `threads` is less than 1.
  SampleRows(const Dynamics& dynamics, std::size_t capacity, int threads = 1);
  ~SampleRows();
  SampleRows(SampleRows&&) noexcept;
  SampleRows& operator=(SampleRows&&) noexcept;

  std::size_t capacity() const;

  /// Computes rows [first, first + count) of `table`, whose joints are the generalized coordinates
  /// in their order and which has velocities and accelerations. Does not allocate.
  /// @param loads one for each of these rows; null: the scene's own
  /// @throws MotionError when the table differs from that, has fewer rows, or when count is more
  ///   than capacity(). SceneError when a load has not one wrench for each applied one.
  void compute(const MotionTable& table, std::size_t first, std::size_t count,
               const Load* loads = nullptr);

  /// Results of row `index` of the last block; valid until another one is read or computed. Does
  /// not allocate.
  /// @throws MotionError when there is no such row.
  const Results& read(std::size_t index);

 private:
  struct Chain;
  struct Loops;
  std::unique_ptr<Chain> chain_;  // exactly one of the two is set
  std::unique_ptr<Loops> loops_;
};

/// Copies the covariances of row `row` of a table into `covariance`, which has as many coordinates
/// as the table's columns: zero where they are not known. Those of wrenches stay.
/// @param mechanism whose joints that turn freely the table's turns may be
void takeCovariance(const Mechanism& mechanism, const MotionTable& table, std::size_t row,
                    MotionCovariance& covariance);

}  // namespace virtual_work_dynamics
