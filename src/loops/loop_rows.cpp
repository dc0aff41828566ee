#include "loops/loop_rows.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "loops/compiled_loops.h"
#include "loops/packed_rows.h"
#include "loops/sample_pack.h"
#include "motion/table_row.h"
#include "tree/sample_block.h"

namespace virtual_work_dynamics {

struct LoopRows::Impl {
  Impl(const ClosedLoopDynamics& of, std::size_t capacity)
      : dynamics(of),
        plan(*of.impl_),
        workspace(of.makeWorkspace()),
        samples(*workspace.impl_),
        motion(dynamics.coordinates(), dynamics.orientations()),
        alone(capacity, samples.results),
        in_pack(capacity, false),
        takes_whole(plan.reacts || plan.request.determinacy ||
                    !plan.kinematics.touching().empty() || !plan.holds.items().empty()) {
    if (!SamplePack::serves(plan) || choosesAmongSeveral()) return;
    pack.emplace(plan, samples.solvers);
    const Request& request = plan.request;
    if (request.determinacy || request.poses || request.twists) {
      tree.emplace(*plan.tree_pass, pack->width());
      tree_row.emplace(plan.tree_pass->makeWorkspace());
    } else {
      packed.emplace(commonOfRows(), *pack, capacity);
    }
  }

  // Whether, in the assembly, several changes are open that efforts are chosen among, which packs
  // do not do.
  bool choosesAmongSeveral() {
    samples.solvers.kinematics.setPosition(plan.assembly);
    for (LoopForces& group : samples.solvers.forces) {
      if (group.effortsFollow() || group.factorization().nullity() < 2) continue;
      group.setPosition();
      for (const LoopUnknowns::Effort& effort : group.efforts()) {
        if (!group.isDetermined(effort.unknown)) return true;
      }
    }
    return false;
  }

  PackedRows::Common commonOfRows() const {
    PackedRows::Common common{*plan.tree_pass, plan.own_load, samples.results, {}};
    Determinacy& usual = common.usual.loops.determinacy;
    usual = {};
    usual.rank = static_cast<int>(plan.assembly.size());
    usual.gap = std::numeric_limits<double>::infinity();
    common.group_of.resize(plan.closures);
    for (std::size_t g = 0; g < samples.solvers.forces.size(); ++g) {
      const LoopForces& group = samples.solvers.forces[g];
      usual.redundancy += static_cast<int>(group.unknowns() - group.coordinates());
      usual.redundant_constraints += static_cast<int>(group.factorization().nullity());
      for (const std::size_t c : group.group().closures) common.group_of[c] = g;
    }
    return common;
  }

  void computeOne(const MotionTable& table, std::size_t first, std::size_t row, const Load* loads) {
    takeRow(table, first + row, motion);
    dynamics.compute(motion, loads ? loads[row] : plan.own_load, workspace);
    in_pack[row] = false;
    samples.exchange(alone[row]);
  }

  // Computes a pack whose results the solvers of one sample finish, as they find flags, and poses
  // and twists of closures.
  void finishPack(const MotionTable& table, std::size_t first, std::size_t at, const Load* loads) {
    tree->compute(table, first + at, pack->width(), loads ? loads + at : nullptr);
    const auto column = [&](const Eigen::MatrixXd& values) {
      return values.size() > 0 ? values.data() + first + at : nullptr;
    };
    pack->setMotion(column(table.positions), column(table.velocities), column(table.accelerations),
                    static_cast<std::size_t>(table.positions.rows()));
    for (std::size_t i = 0; i < pack->width(); ++i) {
      tree->read(i, *tree_row);
      pack->setEfforts(i, tree_row->effort());
    }
    pack->compute();
    for (std::size_t i = 0; i < pack->width(); ++i) {
      if (!pack->computed(i)) {
        computeOne(table, first, at + i, loads);
        continue;
      }
      tree->read(i, *tree_row);
      pack->take(i, takes_whole, samples.solvers, samples.results.loops);
      samples.finish(loads ? loads[at + i] : plan.own_load, *tree_row);
      in_pack[at + i] = false;
      samples.exchange(alone[at + i]);
    }
  }

  // Returns how many rows were computed, the first ones.
  std::size_t computePacks(const MotionTable& table, std::size_t first, std::size_t count,
                           const Load* loads) {
    if (!pack) return 0;
    const std::size_t whole = count / pack->width() * pack->width();
    if (!packed) {
      for (std::size_t at = 0; at < whole; at += pack->width()) finishPack(table, first, at, loads);
      return whole;
    }
    packed->compute(table, first, whole, loads, *pack, in_pack);
    for (std::size_t row = 0; row < whole; ++row) {
      if (!in_pack[row]) computeOne(table, first, row, loads);
    }
    return whole;
  }

  const ClosedLoopDynamics& dynamics;
  const ClosedLoopDynamics::Impl& plan;
  ClosedLoopDynamics::Workspace workspace;
  ClosedLoopDynamics::Workspace::Impl& samples;
  Motion motion;                     // of one row
  std::vector<Results> alone;        // by row: of those that are not in a pack
  std::vector<bool> in_pack;         // by row
  const bool takes_whole;            // whether results need more of a pack than its forces
  std::optional<SamplePack> pack;    // where it serves
  std::optional<PackedRows> packed;  // where it reports everything
  std::optional<SampleBlock> tree;   // else, of a pack
  std::optional<Workspace> tree_row;
};

LoopRows::LoopRows(const ClosedLoopDynamics& dynamics, std::size_t capacity)
    : impl_(new Impl(dynamics, capacity)) {}
LoopRows::~LoopRows() = default;
LoopRows::LoopRows(LoopRows&&) noexcept = default;

void LoopRows::compute(const MotionTable& table, std::size_t first, std::size_t count,
                       const Load* loads) {
  std::size_t done = impl_->computePacks(table, first, count, loads);
  for (; done < count; ++done) impl_->computeOne(table, first, done, loads);
}

const Results& LoopRows::read(std::size_t index) {
  return impl_->in_pack[index] ? impl_->packed->read(index) : impl_->alone[index];
}

}  // namespace virtual_work_dynamics
