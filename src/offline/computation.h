#pragma once

#include <cstddef>
#include <exception>
#include <functional>

#include "dynamics/sample_rows.h"
#include "offline/completed_motion.h"
#include "virtual_work_dynamics/dynamics.h"

namespace virtual_work_dynamics {

/// Computes the rows of a motion, a block at a time. Rows whose passive joints follow from the
/// closures are completed in their order, as each starts from the one before. A thread of its own
/// does that, one block ahead of those that compute.
class Computation {
 public:
  /// @param dynamics must outlive it
  /// @param motion must outlive it
  /// @param threads total number; all of them compute when no row needs completion
  Computation(const Dynamics& dynamics, CompletedMotion& motion, int threads);

  /// Receives a row.
  using Take = std::function<void(std::size_t row, const Motion& motion, const Results& results)>;

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

  const Dynamics& dynamics_;
  CompletedMotion& motion_;
  const bool ahead_;  // whether a thread completes while others compute
  SampleRows samples_;
  Dynamics::Workspace workspace_;  // for completing rows
};

}  // namespace virtual_work_dynamics
