#include "dynamics/sample_rows.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/worker_threads.h"
#include "dynamics/compiled_dynamics.h"
#include "loops/loop_rows.h"
#include "scene/input_checks.h"
#include "tree/sample_block.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {

struct SampleRows::Chain {
  Chain(const InverseDynamics& dynamics, std::size_t capacity, int threads)
      : block(dynamics, capacity, threads), row(dynamics.makeWorkspace()) {}

  SampleBlock block;
  Workspace row;
};

struct SampleRows::Loops {
  Loops(const ClosedLoopDynamics& of, std::size_t applied, std::size_t most, int threads)
      : dynamics(of), wrenches(applied), capacity(most), workers(threads) {
    const std::size_t share =
        (capacity + static_cast<std::size_t>(threads) - 1) / static_cast<std::size_t>(threads);
    for (int i = 0; i < threads; ++i) rows.emplace_back(dynamics, share);
  }

  void compute(const MotionTable& table, std::size_t first, std::size_t count, const Load* loads) {
    if (count > capacity) {
      throw MotionError("block: " + std::to_string(count) + " rows are more than its capacity, " +
                        std::to_string(capacity));
    }
    for (const Eigen::MatrixXd* columns :
         {&table.positions, &table.velocities, &table.accelerations}) {
      if (dynamics.coordinates() > 0 &&  // a table without columns has no rows
          (columns->cols() != dynamics.coordinates() ||
           static_cast<std::size_t>(columns->rows()) < first + count)) {
        throw MotionError("motion: a table of " + std::to_string(first + count) + " rows and " +
                          std::to_string(dynamics.coordinates()) + " coordinates is needed");
      }
    }
    requireOrientations(table, first + count, dynamics.orientations());
    if (dynamics.tree().root_moves) requireRoots(table, first + count);
    for (std::size_t i = 0; loads && i < count; ++i) requireLoad(loads[i], wrenches);
    struct Job {
      Loops& all;
      const MotionTable& table;
      std::size_t first, count;
      const Load* loads;
    } job{*this, table, first, count, loads};
    workers.run(
        [](void* context, int index) {
          const Job& of = *static_cast<Job*>(context);
          of.all.computeShare(of.table, of.first, of.count, of.loads,
                              static_cast<std::size_t>(index));
        },
        &job);
    computed = count;
  }

  // Where the rows of a thread begin.
  std::size_t beginOf(std::size_t count, std::size_t thread) const {
    return count * thread / rows.size();
  }

  void computeShare(const MotionTable& table, std::size_t first, std::size_t count,
                    const Load* loads, std::size_t thread) {
    const std::size_t begin = beginOf(count, thread), end = beginOf(count, thread + 1);
    rows[thread].compute(table, first + begin, end - begin, loads ? loads + begin : nullptr);
  }

  const Results& read(std::size_t index) {
    std::size_t thread = 0;
    while (index >= beginOf(computed, thread + 1)) ++thread;
    return rows[thread].read(index - beginOf(computed, thread));
  }

  const ClosedLoopDynamics& dynamics;
  const std::size_t wrenches;  // of a load
  const std::size_t capacity;
  WorkerThreads workers;
  std::vector<LoopRows> rows;  // by thread
  std::size_t computed = 0;
};

SampleRows::SampleRows(const Dynamics& dynamics, std::size_t capacity, int threads) {
  if (threads < 1) {
    throw Error("blocks: " + std::to_string(threads) + " threads; at least 1 is needed");
  }
  const Dynamics::Impl& plan = *dynamics.impl_;
  if (plan.chain) chain_ = std::make_unique<Chain>(*plan.chain, capacity, threads);
  if (plan.loops) {
    loops_ = std::make_unique<Loops>(*plan.loops, plan.own_load.wrenches.size(), capacity, threads);
  }
}

SampleRows::~SampleRows() = default;
SampleRows::SampleRows(SampleRows&&) noexcept = default;
SampleRows& SampleRows::operator=(SampleRows&&) noexcept = default;

std::size_t SampleRows::capacity() const {
  return chain_ ? chain_->block.capacity() : loops_->capacity;
}

void SampleRows::compute(const MotionTable& table, std::size_t first, std::size_t count,
                         const Load* loads) {
  if (chain_) chain_->block.compute(table, first, count, loads);
  if (loops_) loops_->compute(table, first, count, loads);
}

const Results& SampleRows::read(std::size_t index) {
  if (chain_) {
    chain_->block.read(index, chain_->row);
    return chain_->row.results();
  }
  if (index >= loops_->computed) {
    throw MotionError("block: there is no sample " + std::to_string(index) + ", it has " +
                      std::to_string(loops_->computed));
  }
  return loops_->read(index);
}

void takeCovariance(const Mechanism& mechanism, const MotionTable& table, std::size_t row,
                    MotionCovariance& covariance) {
  const std::size_t joints = covariance.coordinates.size();
  if (table.hasCovariances()) {
    std::copy_n(table.covariances.begin() + static_cast<std::ptrdiff_t>(row * joints), joints,
                covariance.coordinates.begin());
  } else {
    std::fill_n(covariance.coordinates.begin(), joints, Eigen::Matrix3d::Zero());
  }
  if (!table.root_covariances.empty()) covariance.root = table.root_covariances[row];
  const bool any = std::any_of(table.turns.begin(), table.turns.end(),
                               [](const FreeTurns& turns) { return !turns.covariances.empty(); });
  if (!any) return;
  covariance.turns.assign(mechanism.orientations(), TurnCovariance::Zero());
  for (std::size_t i = 0; i < mechanism.orientations(); ++i) {
    for (const FreeTurns& turns : table.turns) {
      if (turns.joint == mechanism.freeJoint(i).name && !turns.covariances.empty())
        covariance.turns[i] = turns.covariances[row];
    }
  }
}

}  // namespace virtual_work_dynamics
