#include "offline/loop_computation.h"

#include <algorithm>
#include <future>
#include <utility>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// Rows of a thread between two hand-overs.
constexpr std::size_t kRowsAtOnce = 64;

// No more than have a row each.
int usefulThreads(int threads, std::size_t rows) {
  const std::size_t most = std::max<std::size_t>(1, rows);
  return static_cast<int>(std::min(static_cast<std::size_t>(threads), most));
}

}  // namespace

LoopComputation::LoopComputation(const Mechanism& mechanism, const Scene& scene,
                                 ClosedLoopDynamics& first, LoopMotion& motion, int threads)
    : first_(first),
      motion_(motion),
      ahead_(threads > 1 && motion.completes()),
      workers_(usefulThreads(ahead_ ? threads - 1 : threads, rows())) {
  const int others = workers_.count() - (ahead_ ? 0 : 1);
  for (int i = 0; i < others; ++i) others_.emplace_back(mechanism, scene, first.request());
}

void LoopComputation::run(const Take& take) {
  const std::size_t size = kRowsAtOnce * static_cast<std::size_t>(workers_.count());
  Block now, next;
  for (Block* block : {&now, &next}) {
    block->samples.assign(std::min(size, rows()), LoopSample(first_.coordinates()));
  }
  complete(0, now);
  while (now.count > 0 || now.open) {
    std::future<void> completed;
    if (!now.open) {
      completed = std::async(ahead_ ? std::launch::async : std::launch::deferred,
                             [&] { complete(now.start + now.count, next); });
    }
    compute(now);
    for (std::size_t i = 0; i < now.count; ++i) {
      motion_.check(now.start + i, now.samples[i]);
      take(now.start + i, now.samples[i]);
    }
    if (now.open) std::rethrow_exception(now.open);
    completed.get();
    std::swap(now, next);
  }
}

void LoopComputation::complete(std::size_t start, Block& block) {
  block.start = start;
  block.count = 0;
  block.open = nullptr;
  const std::size_t wanted = std::min(block.samples.size(), rows() - start);
  try {
    for (; block.count < wanted; ++block.count) {
      motion_.complete(start + block.count, first_, block.samples[block.count].motion());
    }
  } catch (const FileError&) {
    block.open = std::current_exception();  // rows before it may be wrong as well
  }
}

void LoopComputation::compute(Block& block) {
  struct Shares {
    LoopComputation& all;
    Block& block;
  } shares{*this, block};
  workers_.run(
      [](void* context, int thread) {
        const Shares& of = *static_cast<Shares*>(context);
        const auto index = static_cast<std::size_t>(thread);
        const auto threads = static_cast<std::size_t>(of.all.workers_.count());
        const bool own = index < of.all.others_.size();
        ClosedLoopDynamics& dynamics = own ? of.all.others_[index] : of.all.first_;
        const std::size_t end = of.block.count * (index + 1) / threads;
        for (std::size_t i = of.block.count * index / threads; i < end; ++i) {
          of.block.samples[i].compute(dynamics);
        }
      },
      &shares);
}

}  // namespace virtual_work_dynamics
