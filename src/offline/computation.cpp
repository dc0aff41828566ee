#include "offline/computation.h"

#include <algorithm>
#include <future>

#include "motion/table_row.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Rows that a thread computes between two hand-overs; fewer where each has many results, so that a
// robot of a hundred thousand links does not take gigabytes.
constexpr std::size_t kRowsAtOnce = 512;
constexpr std::size_t kClosedRowsAtOnce = 64;
constexpr std::size_t kFewestRowsAtOnce = 8;
constexpr std::size_t kResultsAtOnce = 1000000;

// Limits threads to the number of rows.
int usefulThreads(int threads, std::size_t rows) {
  const std::size_t most = std::max<std::size_t>(1, rows);
  return static_cast<int>(std::min(static_cast<std::size_t>(threads), most));
}

SampleRows samplesOf(const Dynamics& dynamics, std::size_t rows, int wanted) {
  const int threads = usefulThreads(wanted, rows);
  const Request& request = dynamics.request();
  const std::size_t results = static_cast<std::size_t>(dynamics.coordinates()) +
                              6 * (request.child_axes.size() + request.root_axes.size());
  const std::size_t most = dynamics.closed() ? kClosedRowsAtOnce : kRowsAtOnce;
  const std::size_t at_once =
      std::clamp(kResultsAtOnce / std::max<std::size_t>(1, results), kFewestRowsAtOnce, most);
  return SampleRows(dynamics,
                    std::clamp<std::size_t>(rows, 1, at_once * static_cast<std::size_t>(threads)),
                    threads);
}

}  // namespace

Computation::Computation(const Dynamics& dynamics, CompletedMotion& motion, const RowLoads& loads,
                         int threads)
    : dynamics_(dynamics),
      motion_(motion),
      loads_(loads),
      ahead_(threads > 1 && motion.completes()),
      samples_(samplesOf(dynamics, rows(), ahead_ ? threads - 1 : threads)),
      block_loads_(loads.vary() ? samples_.capacity() : 0, loads.own()),
      workspace_(dynamics.makeWorkspace()) {}

void Computation::run(const Take& take) {
  Motion row(dynamics_.coordinates(), dynamics_.orientations());
  Block now = complete(0);
  while (now.count > 0 || now.open) {
    std::future<Block> next;
    if (!now.open) {
      next = std::async(ahead_ ? std::launch::async : std::launch::deferred,
                        [&] { return complete(now.start + now.count); });
    }
    compute(now);
    for (std::size_t i = 0; i < now.count; ++i) {
      const Results& results = samples_.read(i);
      motion_.check(now.start + i, results);
      takeRow(motion_.file().table, now.start + i, row);
      take(now.start + i, row, loads_.vary() ? block_loads_[i] : loads_.own(), results);
    }
    if (now.open) std::rethrow_exception(now.open);
    now = next.get();
  }
}

void Computation::compute(const Block& block) {
  const MotionTable& table = motion_.file().table;
  const Load* const loads = loads_.vary() ? block_loads_.data() : nullptr;
  for (std::size_t i = 0; loads && i < block.count; ++i) {
    loads_.get(block.start + i, block_loads_[i]);
  }
  samples_.compute(table, block.start, block.count, loads);
}

Computation::Block Computation::complete(std::size_t start) {
  Block block{start, 0, nullptr};
  const std::size_t wanted = std::min(samples_.capacity(), rows() - start);
  try {
    for (; block.count < wanted; ++block.count) {
      motion_.complete(start + block.count, dynamics_, workspace_);
    }
  } catch (const FileError&) {
    block.open = std::current_exception();  // rethrown when the rows before it were checked
  }
  return block;
}

}  // namespace virtual_work_dynamics
