#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <vector>

#include "dynamics/sample_rows.h"
#include "offline/completed_motion.h"
#include "offline/row_loads.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Computes the rows of a motion, a block at a time. Rows whose passive joints follow from the
/// closures are completed in their order, as each starts from the one before. A thread of its own
/// does that, one block ahead of those that compute.
class Computation {
 public:
  /// @param dynamics must outlive it
  /// @param motion must outlive it
  /// @param loads of the rows of `motion`; must outlive it
  /// @param threads total number; all of them compute when no row needs completion
  Computation(const Dynamics& dynamics, CompletedMotion& motion, const RowLoads& loads,
              int threads);

  /// Receives a row.
  using Take = std::function<void(std::size_t row, const Motion& motion, const Load& load,
                                  const Results& results)>;

  /// Hands all rows over in their order, in the caller's thread.
  /// @throws FileError at the first row whose loops are not closed, like CompletedMotion, when all
  ///   rows before it have been handed over.
  void run(const Take& take);

 private:
  struct Block {
    std::size_t start = 0;    // row
    std::size_t count = 0;    // of rows that were completed
    std::exception_ptr open;  // why the next row was not completed
  };

  std::size_t rows() const { return motion_.file().lines.size(); }
  Block complete(std::size_t start);
  void compute(const Block& block);

  const Dynamics& dynamics_;
  CompletedMotion& motion_;
  const RowLoads& loads_;
  const bool ahead_;  // whether a thread completes while others compute
  SampleRows samples_;
  std::vector<Load> block_loads_;  // of the rows of a block; none unless they vary
  Dynamics::Workspace workspace_;  // for completing rows
};

}  // namespace virtual_work_dynamics
