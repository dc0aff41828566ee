#include "loops/loop_rows.h"

#include <optional>

#include "loops/compiled_loops.h"
#include "loops/sample_pack.h"
#include "tree/sample_block.h"

namespace virtual_work_dynamics {

struct LoopRows::Impl {
  explicit Impl(const ClosedLoopDynamics& of)
      : dynamics(of), plan(*of.impl_), workspace(of.makeWorkspace()), samples(*workspace.impl_) {
    motions.assign(1, Motion(dynamics.coordinates()));
    if (!SamplePack::serves(plan)) return;
    pack.emplace(plan, samples.solvers);
    tree.emplace(*plan.tree_pass, pack->width());
    motions.assign(pack->width(), motions.front());
    for (std::size_t i = 0; i < pack->width(); ++i) {
      trees.push_back(plan.tree_pass->makeWorkspace());
    }
  }

  void computeOne(const Motion& motion, const Load* load) {
    dynamics.compute(motion, load ? *load : plan.own_load, workspace);
  }

  void computePack(const MotionTable& table, std::size_t first, const Load* loads,
                   Results* results) {
    const std::size_t width = pack->width();
    tree->compute(table, first, width, loads);
    for (std::size_t i = 0; i < width; ++i) {
      takeRow(table, first + i, motions[i]);
      tree->read(i, trees[i]);
      pack->setMotion(i, motions[i]);
      pack->setEfforts(i, trees[i].effort());
    }
    pack->compute();
    const bool whole = plan.reacts || plan.request.determinacy;
    for (std::size_t i = 0; i < width; ++i) {
      const Load* const load = loads ? loads + i : nullptr;
      if (pack->computed(i)) {
        pack->take(i, plan.static_motion ? rest : motions[i], whole, samples.solvers);
        samples.finish(load ? *load : plan.own_load, trees[i]);
      } else {
        computeOne(motions[i], load);
      }
      samples.exchange(results[i]);
    }
  }

  const ClosedLoopDynamics& dynamics;
  const ClosedLoopDynamics::Impl& plan;
  ClosedLoopDynamics::Workspace workspace;
  ClosedLoopDynamics::Workspace::Impl& samples;
  std::vector<Motion> motions;
  Motion rest{dynamics.coordinates()};
  std::optional<SamplePack> pack;  // where it serves
  std::optional<SampleBlock> tree;
  std::vector<Workspace> trees;  // by sample
};

LoopRows::LoopRows(const ClosedLoopDynamics& dynamics) : impl_(new Impl(dynamics)) {}
LoopRows::~LoopRows() = default;
LoopRows::LoopRows(LoopRows&&) noexcept = default;

const Results& LoopRows::results() const {
  return impl_->workspace.results();
}

void LoopRows::compute(const MotionTable& table, std::size_t first, std::size_t count,
                       const Load* loads, Results* results) {
  std::size_t done = 0;
  if (impl_->pack) {
    const std::size_t width = impl_->pack->width();
    for (; done + width <= count; done += width) {
      impl_->computePack(table, first + done, loads ? loads + done : nullptr, results + done);
    }
  }
  for (; done < count; ++done) {
    takeRow(table, first + done, impl_->motions.front());
    impl_->computeOne(impl_->motions.front(), loads ? loads + done : nullptr);
    impl_->samples.exchange(results[done]);
  }
}

void takeRow(const MotionTable& table, std::size_t row, Motion& motion) {
  if (!table.roots.empty()) motion.root = table.roots[row];
  if (motion.q.size() == 0) return;  // a table without columns has no rows
  const auto index = static_cast<Eigen::Index>(row);
  motion.q = table.positions.row(index);
  motion.qd = table.velocities.row(index);
  motion.qdd = table.accelerations.row(index);
}

}  // namespace virtual_work_dynamics
