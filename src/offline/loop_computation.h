#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <vector>

#include "base/worker_threads.h"
#include "offline/loop_motion.h"
#include "offline/loop_sample.h"
#include "virtual_work_dynamics/closed_loop_dynamics.h"

namespace virtual_work_dynamics {

/// Computes the rows of a motion with closed loops, a block at a time. Rows are completed in their
/// order, as each starts from the one before: by a thread that is a block ahead of those that
/// compute.
class LoopComputation {
 public:
  /// @param first of the instances, the one that completes; outlives this. Others are made like it.
  /// @param threads in all; rows that need no completion are computed by all of them
  LoopComputation(const Mechanism& mechanism, const Scene& scene, ClosedLoopDynamics& first,
                  LoopMotion& motion, int threads);

  using Take = std::function<void(std::size_t row, const LoopSample& sample)>;

  /// Hands all rows over, in their order and in the caller's thread.
  /// @throws FileError at the first row whose loops are not closed, as LoopMotion does, when all
  ///   rows before it have been handed over.
  void run(const Take& take);

 private:
  struct Block {
    std::vector<LoopSample> samples;
    std::size_t start = 0;    // row
    std::size_t count = 0;    // of rows that were completed
    std::exception_ptr open;  // why not the next one, too
  };

  std::size_t rows() const { return motion_.file().lines.size(); }
  void complete(std::size_t start, Block& block);
  void compute(Block& block);

  ClosedLoopDynamics& first_;
  LoopMotion& motion_;
  const bool ahead_;  // completes while others compute
  WorkerThreads workers_;
  std::vector<ClosedLoopDynamics> others_;
};

}  // namespace virtual_work_dynamics
